#include "quadrature/options.hpp"

#include "deck/section.hpp"

namespace tanktread::quadrature {

void Options::declare(deck::Section& section) {
  section.key("tolerance", tolerance, deck::between(1e-13, 0.1), "1", "relative accuracy asked of every layer integral (rule `adaptive`)");
  section.key(
      "rule", rule, deck::Choice{"adaptive", "fixed", "desingularised"},
      "`adaptive`: self, near and far parts by tolerance; `fixed`: tensor Gauss of `points` a direction with Lachat-Watson, the paper's; "
      "`desingularised`: the same Gauss points alone, the singularity subtracted by identities of a closed surface");
  section.key("points", points, deck::between(1, 64), "1", "Gauss points a direction of the rules `fixed` and `desingularised`");
  section.key("far sum", far_sum, deck::Choice{"auto", "dense", "tree"},
              "`dense`: every target meets every far node; `tree`: far apart they meet as clusters, to the same `tolerance`, in a time "
              "proportional to the number of elements; `auto`: the faster one");
}

}  // namespace tanktread::quadrature
