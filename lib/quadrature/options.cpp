#include "quadrature/options.hpp"

#include "deck/section.hpp"

namespace tanktread::quadrature {

void Options::declare(deck::Section& section) {
  section.key("tolerance", tolerance, deck::between(1e-13, 0.1), "1", "relative accuracy asked of every layer integral (rule `adaptive`)");
  section.key(
      "rule", rule, deck::Choice{"adaptive", "fixed"},
      "`adaptive`: self, near and far parts by tolerance; `fixed`: tensor Gauss of `points` a direction with Lachat-Watson, the paper's");
  section.key("points", points, deck::between(1, 64), "1", "Gauss points a direction of the rule `fixed`");
}

}  // namespace tanktread::quadrature
