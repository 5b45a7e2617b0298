#pragma once
// Options of the conservation of volume.

#include <string>
#include <vector>

#include "deck/forward.hpp"

namespace tanktread::coupling {

/// Volume constraint. `flux`: zero net flux in every evaluation (2.8). `exact`: in addition, the volume is restored after every step. `none`: no
/// constraint.
enum class VolumeConservation { exact, flux, none };

inline const std::vector<std::string> volume_constraints{"exact", "flux", "none"};  ///< words for VolumeConservation in decks

/// Options `Volume/*` of the deck: how the volume of the particle is conserved.
struct VolumeOptions {
  VolumeConservation constraint = VolumeConservation::exact;

  void declare(deck::Section& section);
};

}  // namespace tanktread::coupling
