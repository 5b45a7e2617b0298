#include "quadrature/options.hpp"

#include <algorithm>

#include "deck/section.hpp"

namespace tanktread::quadrature {

void Options::declare(deck::Section& section) {
  section.key("tolerance", tolerance, deck::between(1e-13, 0.1), "1",
              "relative accuracy requested of every boundary integral (single and double layer) with Quadrature/rule `adaptive`. The error "
              "of the velocity is mostly less than a fifth of the tolerance, and less than a hundredth for tolerances of 1e-3 and above");
  section.key("rule", rule, layer_rules,
              "quadrature of the boundary integrals (single and double layer). `adaptive`: integrals over singular, near-singular and far "
              "elements meet Quadrature/tolerance. `fixed`: Gauss rule with Quadrature/points per direction, with the Lachat-Watson "
              "transformation on singular elements, as by Maestre et al. (2017). `desingularised`: the same Gauss points; the singularity "
              "is subtracted by identities for a closed surface");
  section.key("points", points, deck::between(1, 64), "1",
              "number of Gauss points per direction of an element for Quadrature/rule `fixed` and `desingularised`");
  section.key("far sum", far_sum, deck::Choice{"auto", "dense", "tree"},
              "evaluation of boundary integrals over elements far from the target point, as sums over quadrature nodes. `dense`: every "
              "target sums over every far node. `tree`: distant targets and nodes interact as clusters, to the same Quadrature/tolerance, "
              "in a time proportional to the number of elements. `auto`: the faster of the two, but `dense` for Steady and Spectrum, which "
              "need sums that are smooth functions of the shape");
  if (rule == LayerRule::adaptive) section.without_effect({"points"}, "with Quadrature/rule `adaptive`");
}

void Options::choose_smooth_sums() {
  if (far_sum == "auto") far_sum = "dense";
}

Options Options::for_matrix() const {
  Options options = *this;
  options.tolerance = std::max(1e-12, std::min(1e-7, tolerance / 10));
  return options;
}

Options Options::for_response() const {
  Options options = *this;
  options.tolerance = std::max(1e-13, tolerance / 3);
  return options;
}

}  // namespace tanktread::quadrature
