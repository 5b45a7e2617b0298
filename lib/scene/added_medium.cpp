// Media that a program adds: `Domain/kind` and the keys in `Domain/<kind>`.

#include <algorithm>
#include <iterator>

#include "base/errors.hpp"
#include "deck/section.hpp"
#include "scene/scene.hpp"
#include "stokes/flow/ambient_flow.hpp"

namespace tanktread {

/// Reads the kind of the domain and the section of the chosen medium. Throws UserError if the deck has keys of another kind.
void DomainOptions::declare_medium(deck::Section& section) {
  deck::Choice kinds{"lattice"};
  std::ranges::copy(registered->names(), std::back_inserter(kinds));
  section.key("kind", kind, kinds,
              "`lattice`: fluid and particles are periodic. Other kinds: boundaries of the fluid that this program adds");
  const auto make = registered->read(section, kind, "kind");
  medium = make ? make() : nullptr;
  for (const char* key : {"periodic", "side lengths", "lattice vectors"})
    if (medium && section.given(key))
      throw UserError(section.path(key) + " belongs to Domain/kind `lattice`, but Domain/kind is `" + kind + "`.");
}

void DomainOptions::reject_medium(const ParticleScene& scene, Rejections& to) const {
  const Chosen added("Domain/kind `" + kind + "`", "Domain/kind of an added medium");
  to.pair(scene.tube.present, added, scene.duct_choice(), "a duct encloses all of its fluid");
  to.pair(scene.wall.present, added, "Wall", "a plane wall is a medium itself");
  to.pair(scene.quadrature.rule == quadrature::LayerRule::desingularised, added, "Quadrature/rule `desingularised`",
          "its identities hold in unbounded fluid only; give `adaptive` or `fixed`");
  to.pair(!scene.runs_in_time(), scene.sought(), added,
          "a deformable particle next to a boundary moves away from it or towards it, so that no shape is steady");
  to.pair(scene.particle.drift == "held", added, "Particle/drift `held`", "the distance from the boundaries must be free to change");
}

void check_flow(const stokes::FlowOptions& flow, const stokes::Medium& medium, const std::string& name) {
  for (const stokes::AmbientFlow& ambient : stokes::AmbientFlow(flow).rotated_copies())
    if (const std::string reason = medium.refusal(ambient); !reason.empty())
      throw UserError(name + " and Flow/type `" + flow.type + "` contradict each other: " + reason);
}

}  // namespace tanktread
