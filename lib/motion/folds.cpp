#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "motion/continuation.hpp"

namespace tanktread::motion {

/// Returns the fold near three consecutive points of the branch, or nothing if no fold is found.
std::optional<Branch::Fold> Branch::fold(std::array<Solved, 3> three) {
  constexpr int most = 10;
  for (int k = 0; k < most; ++k) {
    Eigen::Matrix3d powers;
    Eigen::Vector3d q;
    for (int i = 0; i < 3; ++i) {
      const double s = three[i].s - three[1].s;
      powers.row(i) << 1, s, s * s;
      q[i] = three[i].place.q;
    }
    const Eigen::Matrix3d inverse = powers.inverse();
    const Eigen::Vector3d parabola = inverse * q;
    const double s = -parabola[1] / (2 * parabola[2]);
    const Eigen::RowVector3d weights = Eigen::RowVector3d(1, s, s * s) * inverse;
    Place predicted{Net::Zero(x_.rows(), 3), 0};
    for (int i = 0; i < 3; ++i) predicted = predicted.along(three[i].place, weights[i]);
    Place normal = three[2].place - three[0].place;
    const double size = length(normal);
    normal = {normal.x / size, normal.q / size};
    auto solved = on_plane(predicted, normal);
    if (!solved) return {};
    solved->s = three[1].s + s;
    const double nearest = std::min({std::abs(solved->place.q - three[0].place.q), std::abs(solved->place.q - three[1].place.q),
                                     std::abs(solved->place.q - three[2].place.q)});
    if (nearest < options_.fold_tolerance * std::abs(solved->place.q)) return Fold{std::move(*solved), std::move(normal)};
    const std::size_t farthest = std::abs(three[0].s - solved->s) > std::abs(three[2].s - solved->s) ? 0 : 2;
    three[farthest] = std::move(*solved);
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
    auto solved = on_plane(from.along(along, s), along);
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
