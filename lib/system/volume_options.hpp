#pragma once
// Options of the conservation of volume.

#include <string>

#include "deck/forward.hpp"

namespace tanktread::coupling {

/// Options `Volume/*` of the deck: how the volume of the particle is conserved.
struct VolumeOptions {
  /// Volume constraint. flux: zero net flux in every evaluation (2.8). exact: in addition, the volume is restored after every step. none: no
  /// constraint.
  std::string constraint = "exact";

  void declare(deck::Section& section);
};

}  // namespace tanktread::coupling
