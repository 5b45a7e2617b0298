#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "motion/continuation.hpp"

namespace tanktread::motion {

namespace {

/// Parabola q(s) through three points of a branch, with s = 0 at the point in the middle.
struct Parabola {
  Eigen::Matrix3d inverse;
  Eigen::Vector3d coefficients;

  Parabola(const Eigen::Vector3d& s, const Eigen::Vector3d& q) {
    Eigen::Matrix3d powers;
    powers << Eigen::Vector3d::Ones(), s, s.cwiseAbs2();
    inverse = powers.inverse();
    coefficients = inverse * q;
  }
  double vertex() const { return -coefficients[1] / (2 * coefficients[2]); }
  double value(double s) const { return coefficients.dot(Eigen::Vector3d(1, s, s * s)); }
  /// Returns the weights of the three points in the parabola's value at s.
  Eigen::RowVector3d weights(double s) const { return Eigen::RowVector3d(1, s, s * s) * inverse; }
  /// Returns the weights of the three points in the parabola's slope at s.
  Eigen::RowVector3d slope_weights(double s) const { return Eigen::RowVector3d(0, 1, 2 * s) * inverse; }
};

}  // namespace

/// Returns the fold near three consecutive points of the branch, or nothing if no fold is found. The fold is the vertex of the parabola through three
/// points. One of them is replaced by a new point near the vertex until the parameter at the vertex changes by less than the tolerance. Then the
/// point of the branch at the vertex is computed. New points keep a distance from the others, because errors of points that are close together move
/// the vertex. The search also ends when the distance of the outer points has shrunk by the factor `narrow`, because errors of the quadrature then
/// dominate. Solved::rest of the fold is the estimated error of the parameter, divided by the larger of the parameter and a twentieth of the
/// interval from the start value of the parameter to `Continuation/to`.
std::optional<Branch::Fold> Branch::fold(std::array<Solved, 3> three) {
  constexpr int most = 10;
  // assumed relative error of the parameter at the vertex of the first parabola; it falls with the third power of the distance between the points
  constexpr double relative_misfit = 1e-2;
  const double narrow = std::min(0.25, std::cbrt(options_.fold_tolerance / relative_misfit));
  const double first = three[2].s - three[0].s;
  double before = std::numeric_limits<double>::quiet_NaN();
  const auto combined = [&](const Eigen::RowVector3d& weights) {
    Place sum{State(x_.layout()), 0};
    for (std::size_t i = 0; i < 3; ++i) sum = sum.along(three[i].place, weights[static_cast<Eigen::Index>(i)]);
    return sum;
  };
  const Place normal = unit(three[2].place - three[0].place);
  for (int k = 0; k < most; ++k) {
    const double middle = three[1].s, left = three[0].s - middle, right = three[2].s - middle;
    const Parabola parabola({left, 0, right}, {three[0].place.q, three[1].place.q, three[2].place.q});
    const double vertex = parabola.vertex(), q = parabola.value(vertex);
    if (!std::isfinite(vertex)) return {};
    const double scale = std::max(std::abs(q), std::abs(options_.to - start_) / unit_ / 20), allowed = options_.fold_tolerance * scale;
    const std::array at{left, 0., right};
    const auto nearest = [&at](double s) {
      return static_cast<std::size_t>(std::ranges::min_element(at, {}, [s](double one) { return std::abs(one - s); }) - at.begin());
    };
    const double reach = std::max(std::abs(left - vertex), std::abs(right - vertex)), apart = (right - left) / 8;
    // the parameter is the same, to the tolerance, at all three points and at the vertex of the parabola
    const bool flat = std::abs(parabola.coefficients[2]) * reach * reach < allowed;
    const bool last = right - left < narrow * first || k + 1 == most, found = flat || last || std::abs(q - before) < allowed;
    const double change = flat || std::isnan(before) ? 0 : std::abs(q - before);
    before = q;
    const std::size_t near = nearest(vertex);
    double s = vertex;
    if (!found && std::abs(vertex - at[near]) < apart) {
      const double aside = std::copysign(apart, vertex - at[near]);
      s = at[near] + aside;
      if (std::abs(s - at[nearest(s)]) < apart / 2) s = at[near] - aside;  // s is too close to another point of the parabola
    }
    const Place predicted = combined(parabola.weights(s));
    auto solved = on_plane(predicted, normal, std::clamp(allowed / 4, steady_.tolerance / 10, steady_.tolerance));
    if (!solved) solved = on_plane(predicted, normal, std::max(steady_.tolerance, allowed / 4));  // quadrature errors may prevent a smaller error
    if (!solved) return {};
    solved->s = middle + s;
    const double error = std::max(change, std::abs(solved->place.q - q));
    if (last || (found && error < allowed)) {
      solved->rest = error / scale;
      return Fold{std::move(*solved), unit(combined(parabola.slope_weights(s)))};
    }
    three[found ? near : std::abs(left - vertex) > std::abs(right - vertex) ? 0 : 2] = std::move(*solved);
    std::ranges::sort(three, {}, &Solved::s);
  }
  return {};
}

/// Returns the fold of the branch that passes near the point `expected` in about the direction `along`.
std::optional<Branch::Fold> Branch::fold_near(const Place& expected, const Place& along) {
  std::array<Solved, 3> three;
  Place from = expected;
  for (const int i : {0, 1, -1}) {
    const double s = 0.5 * i * options_.largest_change;
    auto solved = on_plane(from.along(along, s), along, steady_.tolerance);
    if (!solved) return {};
    if (i == 0) from = solved->place;
    solved->s = s;
    three[static_cast<std::size_t>(i + 1)] = std::move(*solved);
  }
  return fold(std::move(three));
}

/// Continues the fold to the next value of the second parameter. Returns false if there is no further value.
bool Branch::next_fold() {
  constexpr double least = 1. / 64;
  if (!options_.second_values || values_ == options_.second_values->size()) return false;
  const std::string& parameter = *options_.second_parameter;
  if (folds_.empty()) throw RunFailure("the branch has no fold that could be continued in " + parameter);
  const double from = second_, to = (*options_.second_values)[values_++];
  for (double gone = 0, share = 1; gone < 1;) {
    second_ = gone + share < 1 ? from + (gone + share) * (to - from) : to;
    const Place& last = folds_.back().at.place;
    const Place expected = folds_.size() < 2 ? last : last.along(last - folds_.front().at.place, share / last_share_);
    if (auto found = fold_near(expected, folds_.back().along)) {
      folds_.push_back(std::move(*found));
      if (folds_.size() > 2) folds_.erase(folds_.begin());
      gone += share, last_share_ = share;
    } else if ((share *= 0.5) < least) {
      throw RunFailure(formatted("the fold of the branch was lost beyond %s = %.8g", parameter.c_str(), from + gone * (to - from)));
    }
  }
  ahead_.emplace_back(folds_.back().at, true);
  return true;
}

}  // namespace tanktread::motion
