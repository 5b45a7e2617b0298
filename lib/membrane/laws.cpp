#include "membrane/laws.hpp"

namespace tanktread::membrane {
namespace {

double first_invariant(double l1, double l2) { return l1 * l1 + l2 * l2 - 2; }
double second_invariant(double l1, double l2) { return l1 * l1 * l2 * l2 - 1; }

}  // namespace

std::optional<SplitLaw> split(const Law& law) {
  if (const auto* skalak = std::get_if<Skalak>(&law))
    return SplitLaw{Skalak{skalak->shear_modulus, 0}, {2 * skalak->area_dilatation * skalak->shear_modulus, true}};
  if (const auto* evans = std::get_if<EvansSkalak>(&law))
    return SplitLaw{EvansSkalak{evans->shear_modulus, -0.5}, {evans->area_modulus(), false}};
  return {};
}

double modulus(const Law& law) {
  return std::visit([](const auto& l) { return l.modulus(); }, law);
}

double area_modulus(const Law& law) {
  return std::visit([](const auto& l) { return l.area_modulus(); }, law);
}

std::array<double, 2> principal_tensions(const Law& law, double stretch1, double stretch2) {
  const auto r =
      std::visit([&](const auto& l) { return l.response(first_invariant(stretch1, stretch2), second_invariant(stretch1, stretch2)); }, law);
  const double area_ratio = stretch1 * stretch2;
  const auto tension = [&](double stretch) { return 2 / area_ratio * r.psi1 * stretch * stretch + 2 * area_ratio * r.psi2; };
  return {tension(stretch1), tension(stretch2)};
}

}  // namespace tanktread::membrane
