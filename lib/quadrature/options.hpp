#pragma once

#include <string>

#include "deck/forward.hpp"

namespace tanktread::quadrature {

/// How the layer integrals are taken: `Quadrature/*` of the deck.
struct Options {
  double tolerance = 1e-4;        ///< relative accuracy of every layer integral, self, near and far
  std::string rule = "adaptive";  ///< `adaptive`: by tolerance; `fixed`: `points` x `points` Gauss with Lachat-Watson, the paper's;
                                  ///< `desingularised`: the same Gauss points alone, with the singularity subtracted by identities
  int points = 8;                 ///< Gauss points a direction of the last two
  std::string far_sum = "auto";   ///< `dense`: every target meets every far node; `tree`: clusters of them; `auto`: whichever is faster

  std::string far_precision = "auto";  ///< of the terms of far sums: `single`, `double`; `auto`: single from `tolerance` 1e-3 on

  bool far_in_single() const { return far_precision == "single" || (far_precision == "auto" && tolerance >= 1e-3); }

  void declare(deck::Section& section);
  void check() const;
};

}  // namespace tanktread::quadrature
