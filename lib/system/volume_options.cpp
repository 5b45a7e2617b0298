#include "system/volume_options.hpp"

#include "deck/section.hpp"

namespace tanktread::coupling {

namespace {
const deck::Choice constraints{"exact", "flux", "none"};  // words for VolumeConservation, in the order of its enumerators
}  // namespace

std::string word(VolumeConservation constraint) { return constraints[static_cast<std::size_t>(constraint)]; }

void VolumeOptions::declare(deck::Section& section) {
  section.key("constraint", constraint, constraints,
              "conservation of the particle's volume. `flux`: every computed velocity has zero net flux through the surface (2.8). "
              "`exact`: zero net flux, and the volume is also restored after every step. `none`: no constraint");
}

}  // namespace tanktread::coupling
