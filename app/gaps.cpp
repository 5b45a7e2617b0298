#include "app/gaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "surface/closest_points.hpp"

namespace tanktread {

namespace {

constexpr double accuracy = 1e-7;  // over R_C

/// A particle's surface as closest_points takes it.
struct Placed {
  surface::Patches patches;
  surface::ElementBoxes boxes;

  Placed(const surface::BezierMap& map, const Net& x) : patches(map, x), boxes(patches) {}
};

struct Pair {
  double bound;  ///< the gap is at least this
  std::size_t first, second;
  Vec3 beyond;  ///< of the second one
};

/// Lattice vectors to move particle q by so that it may be close to p; of p itself without the one there and back, of unbounded space 0.
std::vector<Vec3> images(const Net& p, const Net& q, bool same, const std::optional<stokes::PeriodicCell>& cell) {
  if (!cell) return same ? std::vector<Vec3>() : std::vector<Vec3>{Vec3::Zero()};
  std::vector<Vec3> all = cell->around({2, 2, 2});
  const Vec3 apart = cell->shift((q.colwise().mean() - p.colwise().mean()).transpose());
  if (same) all.resize(all.size() / 2);  // those after the middle are those before it turned about
  for (Vec3& image : all) image -= apart;
  return all;
}

/// The nearest of all pairs of which `mine` is true, those first that can be nearest.
template <class Mine>
Nearest nearest(const std::vector<Member>& members, const std::vector<Net>& x, const std::optional<stokes::PeriodicCell>& cell, const Mine& mine) {
  std::vector<std::unique_ptr<Placed>> placed;
  std::vector<Pair> pairs;
  double radius = 0;
  for (std::size_t p = 0; p < members.size(); ++p) {
    placed.push_back(std::make_unique<Placed>(surface::BezierMap(members[p].body->space), x[p]));
    radius = std::max(radius, members[p].body->radius);
    for (std::size_t q = 0; q <= p; ++q)
      for (const Vec3& beyond : images(x[q], x[p], q == p, cell)) {
        surface::ElementBoxes::Box moved = placed[p]->boxes.boxes()[0];
        moved.low += beyond.array(), moved.high += beyond.array();
        pairs.push_back({distance(placed[q]->boxes.boxes()[0], moved), q, p, beyond});
      }
  }
  std::ranges::stable_sort(pairs, {}, &Pair::bound);
  Nearest found;
  for (std::size_t k = 0; k < pairs.size() && pairs[k].bound < found.gap; ++k) {
    if (!mine(k)) continue;
    const auto& [bound, p, q, beyond] = pairs[k];
    std::unique_ptr<Placed> moved;
    if (!beyond.isZero(0)) moved = std::make_unique<Placed>(surface::BezierMap(members[q].body->space), x[q].rowwise() + beyond.transpose());
    const surface::ClosestPoints closest =
        surface::closest_points(placed[p]->boxes, moved ? moved->boxes : placed[q]->boxes, accuracy * radius, found.gap);
    if (closest.gap < found.gap) found = {closest.gap, static_cast<int>(p) + 1, static_cast<int>(q) + 1, (closest.first + closest.second) / 2};
  }
  return found;
}

/// Widths of films of which a plane wall is the other side, where they are smaller.
void narrow(const surface::Patches& surface, const stokes::PlaneWall& wall, double reach, std::vector<double>& widths) {
  for (int e = 0; e < surface.size(); ++e)
    for (int k = 0; k < 9; ++k) {
      const double height = wall.height(surface::place(surface[e], k % 3 / 2., k / 3 / 2.));
      if (height <= reach) widths[e] = std::min(widths[e], std::max(height, 0.));
    }
}

/// Whether a point that is not on a surface is inside: its solid angle there is 4 pi, outside 0.
bool encloses(const surface::Patches& patches, const Vec3& point) {
  constexpr int n = 8;
  double angle = 0;
  for (int e = 0; e < patches.size(); ++e)
    for (int k = 0; k < n * n; ++k) {
      const surface::Jet at = surface::jet(patches[e], (k % n + 0.5) / n, (k / n + 0.5) / n);
      const Vec3 r = at.x - point;
      angle += r.dot(at.s.cross(at.t)) / (n * n * std::pow(r.norm(), 3));
    }
  return angle > 2 * std::numbers::pi;
}

/// Throws where one particle is inside of another, which their gap does not tell.
void check_not_nested(const std::vector<Member>& members, const std::vector<Net>& x) {
  for (std::size_t p = 0; p < members.size(); ++p) {
    const surface::Patches outer(surface::BezierMap(members[p].body->space), x[p]);
    const Eigen::RowVector3d low = x[p].colwise().minCoeff(), high = x[p].colwise().maxCoeff();
    for (std::size_t q = 0; q < members.size(); ++q) {
      const Vec3 inner = surface::value(members[q].body->space, x[q], {0, 0.5, 0.5});
      if (p == q || (inner.transpose().array() < low.array()).any() || (inner.transpose().array() > high.array()).any()) continue;
      if (encloses(outer, inner))
        throw UserError("Particles/" + members[q].name + " is inside of Particles/" + members[p].name + " at the start.");
    }
  }
}

}  // namespace

void check_apart(const std::vector<Member>& members, const std::optional<stokes::PeriodicCell>& cell) {
  if (members.size() == 1 && !cell) return;
  std::vector<Net> x;
  for (const Member& member : members) x.push_back(member.body->initial);
  const Nearest found = nearest(members, x, cell, [](std::size_t) { return true; });
  if (found.gap > 10 * accuracy * members.front().body->radius) return check_not_nested(members, x);
  const auto name = [&](int number) { return "Particles/" + members[static_cast<std::size_t>(number) - 1].name; };
  if (found.first == found.second)
    throw UserError("Domain is smaller than " + name(found.first) +
                    formatted(", which overlaps its own image about [%.4g, %.4g, %.4g].", found.place[0], found.place[1], found.place[2]));
  throw UserError(name(found.first) + " and " + name(found.second) +
                  formatted(" overlap at the start, about [%.4g, %.4g, %.4g].", found.place[0], found.place[1], found.place[2]));
}

Nearest smallest_gap(const std::vector<Member>& members, const Net& x, const coupling::Ranks& ranks,
                     const std::optional<stokes::PeriodicCell>& cell) {
  std::vector<Net> own;
  for (const Member& member : members) own.push_back(member.own(x));
  const auto mine = [&](std::size_t k) { return static_cast<int>(k % static_cast<std::size_t>(ranks.size())) == ranks.rank(); };
  const Nearest of_rank = nearest(members, own, cell, mine);
  const std::array<double, 6> here{std::min(of_rank.gap, std::numeric_limits<double>::max()), double(of_rank.first), double(of_rank.second),
                                   of_rank.place[0], of_rank.place[1], of_rank.place[2]};
  Nearest found;
  for (const auto& [gap, first, second, x1, x2, x3] : gathered(ranks, here))
    if (gap < found.gap) found = {gap, static_cast<int>(first), static_cast<int>(second), {x1, x2, x3}};
  return found;
}

std::vector<double> films(const std::vector<Member>& members, std::size_t p, const Net& x) {
  const Body& body = *members[p].body;
  const surface::Patches own(surface::BezierMap(body.nested()), members[p].own(x));
  std::vector<surface::Patches> placed;
  for (std::size_t q = 0; q < members.size(); ++q)
    if (q != p) placed.emplace_back(surface::BezierMap(members[q].body->space), members[q].own(x));
  std::vector<const surface::Patches*> others;
  for (const surface::Patches& other : placed) others.push_back(&other);
  const motion::AdaptationOptions& options = members[p].scene.adaptation;
  double longest = 0;  // the diagonal of the largest element
  for (int e = 0; e < own.size(); ++e)
    longest = std::max(longest, (surface::place(own[e], 0, 0) - surface::place(own[e], 1, 1)).norm());
  const double reach = std::pow(longest / *options.film_resolution, 2) / options.radius;
  std::vector<double> widths = surface::film_widths(own, others, reach);
  if (const auto wall = members[p].scene.wall.plane()) narrow(own, *wall, reach, widths);
  return widths;
}

}  // namespace tanktread
