// Keys of a particle.

#include "base/errors.hpp"
#include "scene/scene.hpp"

namespace tanktread {

namespace {

const deck::Choice motion_words{"deforming", "prescribed", "free"};

}  // namespace

std::string text(Motion motion) { return "`" + motion_words[static_cast<std::size_t>(motion)] + "`"; }

void ParticleOptions::declare(deck::Section& section) {
  shape.declare(section);
  section.key("viscosity ratio", viscosity_ratio, deck::positive(), "1",
              "lambda: viscosity inside over viscosity outside; at most 1e14 x Solvers/tolerance, and from 1e5 on the particle hardly deforms: "
              "one that does not at all is rigid, Particle/motion `free`");
  section.key("motion", motion, motion_words,
              "`deforming`: by the velocity of the fluid on its surface; `prescribed`: rigid, with `velocity` and `angular velocity`, of one "
              "particle a steady problem; `free`: rigid, with `force` and `torque`, by themselves zero");
  section.key("velocity", velocity, deck::any(), "length/time", "of the centre, for a `prescribed` motion; zero if not given");
  section.key("angular velocity", angular_velocity, deck::any(), "1/time", "about the centre, for a `prescribed` motion; zero if not given");
  section.key("force", force, deck::any(), "force", "on a `free` body, three numbers; zero if not given");
  section.key("torque", torque, deck::any(), "force x length", "on a `free` body, about the centre of its volume; zero if not given");
  section.key("density difference", density_difference, deck::any(), "force/(length^3 x Flow/gravity)",
              "density inside less that of the fluid: with Flow/gravity, a force on each unit of volume; zero if not given");
  section.key("drift", drift, deck::Choice{"free", "held"},
              "`held`: the centroid is put back after every step, which in an affine flow changes no shape; the default at the point of rest of a "
              "flow that draws away from it, where rounding grows into a drift; otherwise `free`");
  section.key("forces", forces, deck::Choice{"reciprocal", "integral"},
              "force and torque on a `prescribed` body: `integral` of the traction alone, as the paper has it, or with what that lacks by the "
              "`reciprocal` theorem, the default under Quadrature/rule `adaptive`; the other rules are too coarse for it");
}

void ParticleKind::declare(deck::Section& section) {
  section.mention("like");
  copies.present = section.given("copies");
  if (copies.present || section.documenting())
    section.section("copies", copies, "many of it, at the rows of a file, on a lattice, or at random without overlap");
  else
    section.mention("copies");
  if (section.documenting()) return;
  particle.declare(section);
  declare_lists(section);
}

namespace {

/// The list Membrane.
struct MembraneList {
  ParticleKind& kind;

  void declare(deck::Section& section) {
    kind.membrane.declare(section);
    kind.loads = kind.registry->loads.read(section, "loads", "loads that this program adds to those of the library, none without this list");
  }
};

/// The list Interface.
struct InterfaceList {
  ParticleKind& kind;

  void declare(deck::Section& section) {
    kind.interface.declare(section);
    membrane::SurfactantOptions given;
    if (section.optional_section("surfactant", given, "an insoluble surfactant on a drop; a clean interface without this list"))
      kind.surfactant = given;
    kind.fields = kind.registry->fields.read(section, "fields", "fields on the interface or membrane that this program adds, none without this list");
  }
};

}  // namespace

void ParticleKind::declare_lists(deck::Section& section) {
  if (particle.rigid()) section.leave_out("Membrane");  // what particles share is for those that have one
  membrane_given = section.given("Membrane");
  if (MembraneList list{*this}; !particle.rigid() || membrane_given) section.section("Membrane", list, "what its surface is made of");
  if (particle.shape.shape != "file")
    section.section("Surface", surface, "the spline space of its surface");
  else if (section.given("Surface"))
    throw UserError(section.path("Surface") + " and " + (name.empty() ? "Particle/shape" : section.path("shape")) +
                    " `file` contradict each other: the spline space is the file's.");
  InterfaceList list{*this};
  section.section("Interface", list, "the interface of a drop: how its mesh moves along it, and what is on it");
  if (!section.documenting() && particle.shape.sized()) adaptation.radius = particle.shape.equivalent_radius();
  if (!name.empty()) adaptation.film_resolution = 0.7;
  section.section("Adaptation", adaptation, "refinement and coarsening of the mesh");
}

void ContactOptions::declare(deck::Section& section) {
  section.key("limit", limit, deck::between(1e-6, 1), "R_C",
              "smallest gap between two particles, over the R_C of the smallest one, at which the run goes on; below, it ends with a checkpoint");
  section.key("limiter", limiter,
              "whether the gaps between particles are held at the limit instead, by forces along the normals at their nearest points that never pull "
              "(4.23), which are series and 0 as long as the fluid alone holds the gaps; gaps to a wall are not");
  if (limiter && !section.given("limit"))
    throw UserError(section.path("limiter") + " needs " + section.path("limit") + ": the gap, over R_C, that it is to hold.");
}

}  // namespace tanktread
