#include "system/volume_options.hpp"

#include "deck/section.hpp"

namespace tanktread::coupling {

void VolumeOptions::declare(deck::Section& section) {
  section.key("constraint", constraint, volume_constraints,
              "conservation of the particle's volume. `flux`: every computed velocity has zero net flux through the surface (2.8). "
              "`exact`: zero net flux, and the volume is also restored after every step. `none`: no constraint");
}

}  // namespace tanktread::coupling
