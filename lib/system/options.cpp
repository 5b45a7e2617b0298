#include "system/options.hpp"

#include "deck/section.hpp"

namespace tanktread::coupling {

void VolumeOptions::declare(deck::Section& section) {
  section.key("constraint", constraint, volume_constraints,
              "conservation of the particle's volume. `flux`: every computed velocity has zero net flux through the surface (2.8). "
              "`exact`: zero net flux, and the volume is also restored after every step. `none`: no constraint");
}

void InterfaceOptions::declare(deck::Section& section) {
  section.key("motion", motion, mesh_motions,
              "motion of the control points of a drop's interface. `material`: with the fluid. `normal`: with the fluid in the normal direction, and "
              "tangentially with the rotation of the drop's shape. `relaxed`: in addition tangentially with the uniform stretch of the shape, and "
              "so that elements keep their shape. If not given, `relaxed` for Membrane/law `surface tension`, and `material` for all other laws");
  section.key("relaxation", relaxation, deck::not_negative(), "1",
              "dimensionless speed at which the mesh of a drop slides along the interface to keep its elements well shaped, with "
              "Interface/motion `relaxed`: it slides like an elastic membrane of capillary number 1/relaxation. Increase it if elements "
              "become distorted. With 0.1, drops that an unbounded flow stretches err less (see the manual's page Mesh of a drop)");
  if (motion && *motion != MeshMotion::relaxed)
    section.without_effect({"relaxation"}, "with Interface/motion `" + deck::word(mesh_motions, *motion) + "`");
}

}  // namespace tanktread::coupling
