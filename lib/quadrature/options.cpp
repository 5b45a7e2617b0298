#include "quadrature/options.hpp"

#include "base/errors.hpp"
#include "deck/section.hpp"
#include "deck/words.hpp"

namespace tanktread::quadrature {

void Options::declare(deck::Section& section) {
  section.key("tolerance", tolerance, deck::between(1e-13, 0.1), "1",
              "relative accuracy asked of every layer integral (rule `adaptive`); the velocity mostly errs by less than a fifth of it, from 1e-3 on "
              "by less than a hundredth");
  section.key(
      "rule", rule, deck::Choice{"adaptive", "fixed", "desingularised"},
      "`adaptive`: self, near and far parts by tolerance; `fixed`: tensor Gauss of `points` a direction with Lachat-Watson, the paper's; "
      "`desingularised`: the same Gauss points alone, the singularity subtracted by identities of a closed surface");
  section.key("points", points, deck::between(1, 64), "1", "Gauss points a direction of the rules `fixed` and `desingularised`");
  section.key("far sum", far_sum, deck::Choice{"auto", "dense", "tree"},
              "`dense`: every target meets every far node; `tree`: far apart they meet as clusters, to the same `tolerance`, in a time "
              "proportional to the number of elements; `auto`: the faster one");
  section.key("far precision", far_precision, deck::Choice{"auto", "single", "double"},
              "of the terms of far sums: `single` is 1.5 times as fast, and off by some 1e-7 of the sum of their magnitudes, which makes 1e-8 of the "
              "shape: what is promised to 1e-10 (symmetry, order, place) then holds to that; `auto`: `double` up to a `tolerance` of 1e-3");
}

void Options::check() const {
  if (far_precision == "single" && tolerance < 1e-6)
    throw UserError("Quadrature/far precision `single`, which is off by some 1e-7, cannot keep a Quadrature/tolerance of " +
                    deck::number_text(tolerance) + ": ask for 1e-6 or more, or for `double`.");
}

}  // namespace tanktread::quadrature
