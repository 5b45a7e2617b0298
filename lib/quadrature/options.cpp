#include "quadrature/options.hpp"

#include "base/errors.hpp"
#include "deck/section.hpp"
#include "deck/words.hpp"

namespace tanktread::quadrature {

void Options::declare(deck::Section& section) {
  section.key("tolerance", tolerance, deck::between(1e-13, 0.1), "1",
              "relative accuracy requested of every layer integral with the rule `adaptive`. The error of the velocity is mostly less than a fifth "
              "of the tolerance, and less than a hundredth for tolerances of 1e-3 and above");
  section.key(
      "rule", rule, deck::Choice{"adaptive", "fixed", "desingularised"},
      "quadrature of layer integrals. `adaptive`: singular, near-singular and far panels are integrated to the tolerance. `fixed`: tensor-product "
      "Gauss with `points` per direction and Lachat-Watson, as in the paper. `desingularised`: the same Gauss points without special rules; "
      "identities of a closed surface subtract the singularity");
  section.key("points", points, deck::between(1, 64), "1", "number of Gauss points per direction for the rules `fixed` and `desingularised`");
  section.key("far sum", far_sum, deck::Choice{"auto", "dense", "tree"},
              "evaluation of far-field sums. `dense`: every target sums over every far node. `tree`: distant targets and nodes interact as "
              "clusters, to the same `tolerance`, in a time proportional to the number of elements. `auto`: the faster of the two");
  section.key("far precision", far_precision, deck::Choice{"auto", "single", "double"},
              "floating-point precision of the terms of far-field sums. `single`: 1.5 times as fast, with errors of about 1e-7 of the sum of the "
              "magnitudes of the terms, and of about 1e-8 in the shape; symmetry, order and position-independence then hold to 1e-8 instead of "
              "1e-10. `double`: no such error. `auto`: `single` if `tolerance` is at least 1e-3");
}

void Options::check() const {
  if (far_precision == "single" && tolerance < 1e-6)
    throw UserError("Quadrature/far precision `single`, which is off by some 1e-7, cannot keep a Quadrature/tolerance of " +
                    deck::number_text(tolerance) + ": ask for 1e-6 or more, or for `double`.");
}

}  // namespace tanktread::quadrature
