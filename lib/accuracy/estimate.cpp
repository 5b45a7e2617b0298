#include "accuracy/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "accuracy/levels.hpp"
#include "base/formatted.hpp"
#include "deck/expectation.hpp"

namespace tanktread::accuracy {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

constexpr double second_order = 6 / mesh_order;    // q of (9.2): errors of the orders 4.25 and 6 in the length of the elements
constexpr double of_mean = 0.7;                    // factor of (9.2), fitted with q to 205 errors of requested series in 30 scenes
constexpr double least_part = 0.1, most_part = 3;  // limits of e'_l/e_l in (9.2)

/// Returns the value of a curve at an abscissa, interpolated by cubics between its points; NaN outside of their range.
double value_at(const Curve& curve, double at) {
  if (curve.at.empty()) return unknown;
  const double slack = 1e-9 * std::max(std::abs(curve.at.front()), std::abs(curve.at.back()));
  if (at < curve.at.front() - slack || at > curve.at.back() + slack) return unknown;
  return deck::interpolated(curve.at, curve.values, std::clamp(at, curve.at.front(), curve.at.back()));
}

}  // namespace

double two_order_error(const Curve& before, const Curve& last, const std::array<double, 3>& expected) {
  const auto second = [](double error) { return std::pow(error, second_order); };
  const auto [coarsest, coarse, fine] = expected;
  const double a1 = coarsest - coarse, b1 = second(coarsest) - second(coarse), a2 = coarse - fine, b2 = second(coarse) - second(fine);
  const double determinant = a1 * b2 - b1 * a2;
  const double of_before = (fine * b2 - second(fine) * a2) / determinant, of_last = (second(fine) * a1 - fine * b1) / determinant;
  std::vector<double> errors;
  for (std::size_t i = 0; i < last.at.size(); ++i) errors.push_back(of_last * last.values[i] + of_before * value_at(before, last.at[i]));
  return largest(errors);
}

Estimate estimated(const std::vector<Curve>& changes, double scale, const std::vector<double>& expected) {
  Estimate found = estimated(norms(changes), scale, expected);
  const std::size_t n = changes.size();
  if (n < 2 || std::isnan(found.ratio)) return found;
  const double two = two_order_error(changes[n - 2], changes[n - 1], {expected[n - 2], expected[n - 1], expected[n]});
  if (!std::isnan(two)) found.error = of_mean * std::sqrt(found.error * std::clamp(two, least_part * found.error, most_part * found.error));
  return found;
}

Estimate estimated(const std::vector<double>& differences, double scale, const std::vector<double>& expected) {
  const std::size_t n = differences.size();
  if (n == 0 || !std::isfinite(differences.back())) return {unknown, unknown, "fewer than two levels have a value of it"};
  const double last = differences.back(), finest = expected[n];
  if (n == 1 || !std::isfinite(differences[n - 2])) return {last, unknown, "it needs the results of three levels"};
  if (std::max(last, differences[n - 2]) <= round_off * scale) return {std::max(last, differences[n - 2]), unknown, ""};
  const auto factor = [&](std::size_t level) { return differences[level - 1] / (expected[level - 1] - expected[level]); };
  const double error = predicted_error(last, expected[n - 1], finest, finest);
  const double ratio = expected[n - 1] / finest * factor(n - 1) / factor(n);
  if (ratio >= least_ratio && ratio <= most_ratio) return {error, ratio, ""};
  if (n > 2 && std::isfinite(differences[n - 3])) {
    const double of_two = std::sqrt(expected[n - 2] / finest * factor(n - 2) / factor(n));
    if (ratio >= 1 && of_two >= least_ratio && of_two <= most_ratio) return {error, of_two, ""};
  }
  return {error, ratio, formatted("from level to level its error falls by the factor %.2g, not by %g to %g", ratio, least_ratio, most_ratio)};
}

namespace {

/// Returns the largest minus the smallest of the values that are not NaN; -1 if there are none.
double range_of(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values)
    if (!std::isnan(value)) low = std::min(low, value), high = std::max(high, value);
  return high >= low ? high - low : -1;
}

double change(double a, double b, double period) { return period > 0 ? std::remainder(a - b, period) : a - b; }

}  // namespace

Curve difference(const Curve& a, const Curve& b, double period) {
  Curve found;
  if (a.at.empty() || b.at.empty()) return found;
  const double slack = 1e-9 * std::max({std::abs(a.at.front()), std::abs(a.at.back()), std::abs(b.at.back()), 1e-300});
  std::vector<double> common;  // values of a at the common abscissas
  for (std::size_t i = 0, j = 0; i < a.at.size() && j < b.at.size();) {
    if (std::abs(a.at[i] - b.at[j]) <= slack)
      found.at.push_back(a.at[i]), found.values.push_back(change(a.values[i], b.values[j], period)), common.push_back(a.values[i]), ++i, ++j;
    else
      a.at[i] < b.at[j] ? ++i : ++j;
  }
  if (found.at.size() >= std::min<std::size_t>(5, std::min(a.at.size(), b.at.size())) && range_of(common) >= range_of(a.values) / 2) return found;
  found = {};
  for (std::size_t i = 0; i < a.at.size(); ++i)
    if (a.at[i] >= b.at.front() && a.at[i] <= b.at.back())
      found.at.push_back(a.at[i]), found.values.push_back(change(a.values[i], deck::interpolated(b.at, b.values, a.at[i]), period));
  return found;
}

double largest(const std::vector<double>& values) {
  double most = unknown;
  for (const double value : values)
    if (!std::isnan(value) && !(std::abs(value) <= most)) most = std::abs(value);
  return most;
}

std::vector<double> norms(const std::vector<Curve>& curves) {
  std::vector<double> found;
  for (const Curve& one : curves) found.push_back(largest(one.values));
  return found;
}

namespace {

/// Returns the parts of a curve without NaN values in which abscissas increase; a mesh change records an abscissa twice.
std::vector<Curve> pieces(const Curve& curve) {
  std::vector<Curve> all;
  bool joined = false;
  for (std::size_t i = 0; i < curve.at.size(); ++i) {
    const bool known = !std::isnan(curve.values[i]);
    if (known && !(joined && curve.at[i] > all.back().at.back())) all.emplace_back();
    if (known) all.back().at.push_back(curve.at[i]), all.back().values.push_back(curve.values[i]);
    joined = known;
  }
  return all;
}

/// Returns the integral of a piece. `stride`: number of points from one used point to the next; the last point is always used.
double integral(const Curve& piece, std::size_t stride) {
  Curve used;
  const std::size_t last = piece.at.size() - 1;
  for (std::size_t i = 0; i <= last; i += stride) used.at.push_back(piece.at[i]), used.values.push_back(piece.values[i]);
  if (last % stride != 0) used.at.push_back(piece.at[last]), used.values.push_back(piece.values[last]);
  double sum = 0;
  for (std::size_t i = 1; i < used.at.size(); ++i) {
    const double middle = deck::interpolated(used.at, used.values, (used.at[i] + used.at[i - 1]) / 2);
    sum += (used.at[i] - used.at[i - 1]) * (used.values[i] + 4 * middle + used.values[i - 1]) / 6;  // exact for a cubic
  }
  return sum;
}

}  // namespace

Average average(const Curve& curve) {
  if (curve.at.size() == 1) return {curve.values.front(), 0};
  double sum = 0, length = 0, of_half = 0, of_quarter = 0;
  for (const Curve& piece : pieces(curve)) {
    const double all = integral(piece, 1), half = integral(piece, 2);
    sum += all, length += piece.at.back() - piece.at.front();
    of_half += std::abs(all - half), of_quarter += std::abs(half - integral(piece, 4));
  }
  if (!(length > 0)) return {unknown, unknown};
  // limits of the ratio of_quarter/of_half of the errors: about 2 if the curve jumps, and 16 if it is smooth and well resolved; 8 is on the safe side
  constexpr double jump = 2, smooth = 8;
  const double ratio = of_half > 0 ? std::clamp(of_quarter / of_half, jump, smooth) : smooth;
  return {sum / length, of_half / (ratio - 1) / length};
}

double statistical_error(const Curve& curve) {
  constexpr std::size_t batches = 8;
  if (curve.at.size() < 4 * batches) return unknown;
  const double start = curve.at.front(), length = (curve.at.back() - start) / batches;
  std::vector<double> means;
  for (std::size_t k = 0; k < batches; ++k) {
    Curve part;
    for (std::size_t i = 0; i < curve.at.size(); ++i)
      if (curve.at[i] >= start + static_cast<double>(k) * length && curve.at[i] <= start + static_cast<double>(k + 1) * length)
        part.at.push_back(curve.at[i]), part.values.push_back(curve.values[i]);
    if (part.at.size() > 1) means.push_back(average(part).value);
  }
  if (means.size() < batches) return unknown;
  double sum = 0, squares = 0;
  for (const double one : means) sum += one / batches;
  for (const double one : means) squares += (one - sum) * (one - sum);
  return std::sqrt(squares / (batches * (batches - 1.)));
}

std::vector<double> envelope(const Curve& curve, const std::vector<double>& at) {
  std::vector<double> found(at.size(), unknown);
  const auto n = static_cast<std::ptrdiff_t>(curve.at.size());
  for (std::size_t k = 0; k < at.size(); ++k) {
    const std::ptrdiff_t above = std::lower_bound(curve.at.begin(), curve.at.end(), at[k]) - curve.at.begin();
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, std::min(above, n - 1) - 2); i < std::min(n, above + 2); ++i)
      if (const double value = std::abs(curve.values[static_cast<std::size_t>(i)]); !std::isnan(value) && !(value <= found[k])) found[k] = value;
  }
  return found;
}

}  // namespace tanktread::accuracy
