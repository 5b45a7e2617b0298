#pragma once

#include <string>

namespace tanktread::deck {
class Section;
}

namespace tanktread::quadrature {

/// How the layer integrals are taken: `Quadrature/*` of the deck.
struct Options {
  double tolerance = 1e-5;        ///< relative accuracy of every layer integral, self, near and far
  std::string rule = "adaptive";  ///< `adaptive`: by tolerance; `fixed`: `points` x `points` Gauss with Lachat-Watson, the paper's
  int points = 8;                 ///< Gauss points a direction of the rule `fixed`

  void declare(deck::Section& section);
};

}  // namespace tanktread::quadrature
