#include "scene/particles/gaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "scene/room.hpp"
#include "scene/solids.hpp"
#include "surface/closest_points.hpp"

namespace tanktread {

namespace {

constexpr double gap_accuracy = 1e-7;  // allowed absolute error of gaps, divided by the particle radius R_C

/// Returns the patches of a particle in the shape x. If the particle has a geometry, uses its Bezier map, which equal particles share.
surface::Patches patches_of(const Member& member, const Net& x) {
  if (member.geometry) return {member.geometry->bezier(), x};
  return {surface::BezierMap(member.body->space), x};
}

/// Surface of a particle in the form that closest_points needs.
struct Placed {
  surface::Patches patches;
  surface::ElementBoxes boxes;

  Placed(const Member& member, const Net& x) : patches(patches_of(member, x)), boxes(patches) {}
};

struct Pair {
  double bound;  ///< lower bound of the gap
  std::size_t first, second;
  Vec3 beyond;  ///< lattice vector by which the second particle is shifted
};

/// Returns the lattice vectors that move the net q to images that may be close to the net p. If p and q belong to the same particle, only one of each
/// pair of opposite vectors is returned. In unbounded space the only vector is 0.
std::vector<Vec3> images(const Net& p, const Net& q, bool same, const std::optional<stokes::PeriodicCell>& cell) {
  if (!cell) return same ? std::vector<Vec3>() : std::vector<Vec3>{Vec3::Zero()};
  std::vector<Vec3> all = cell->around({2, 2, 2});
  const Vec3 apart = cell->shift((q.colwise().mean() - p.colwise().mean()).transpose());
  if (same) all.resize(all.size() / 2);  // the second half holds the negatives of the vectors of the first half
  for (Vec3& image : all) image -= apart;
  return all;
}

/// Pairs of particles, sorted by a lower bound of their gap. Leaves out pairs whose gap exceeds `reach` or cannot be the smallest gap of all.
class Pairs {
 public:
  Pairs(const std::vector<Member>& members, const std::vector<Net>& x, const std::optional<stokes::PeriodicCell>& cell,
        double reach = std::numeric_limits<double>::infinity())
      : members_(members), x_(x) {
    for (std::size_t p = 0; p < members.size(); ++p) {
      placed_.push_back(std::make_unique<Placed>(members[p], x[p]));
      radius_ = std::max(radius_, members[p].body->radius);
    }
    each(cell, [&](const Pair& pair) { reach = std::min(reach, pair.bound + size(pair.first) + size(pair.second)); });
    each(cell, [&](const Pair& pair) {
      if (pair.bound <= reach) all_.push_back(pair);
    });
    std::ranges::stable_sort(all_, {}, &Pair::bound);
  }

  const std::vector<Pair>& all() const { return all_; }

  /// Returns the error of the gap that is allowed in the search for the closest points.
  double tolerance() const { return gap_accuracy * radius_; }

  /// Returns the closest points of one pair if its gap is smaller than `reach`. A final Newton iteration makes the points independent of the order in
  /// which the search visits the elements.
  surface::ClosestPoints closest(const Pair& pair, double reach) const {
    const auto& [bound, p, q, beyond] = pair;
    std::unique_ptr<Placed> moved;
    if (!beyond.isZero(0)) moved = std::make_unique<Placed>(members_[q], x_[q].rowwise() + beyond.transpose());
    const Placed &first = *placed_[p], &second = moved ? *moved : *placed_[q];
    const surface::ClosestPoints found = surface::closest_points(first.boxes, second.boxes, tolerance(), reach);
    if (!(found.gap < reach)) return found;
    const auto& [a, b] = found.sites;
    const surface::ClosestPoints refined = surface::nearest_points(first.patches[a.element], second.patches[b.element], found);
    constexpr double slack = 1e-2;  // tolerance in local coordinates; farther outside of an element, its polynomials do not represent the surface
    const auto inside = [](const spline::Site& at) { return std::max(std::abs(at.s - 0.5), std::abs(at.t - 0.5)) <= 0.5 + slack; };
    return inside(refined.sites[0]) && inside(refined.sites[1]) ? refined : found;
  }

 private:
  const Eigen::AlignedBox3d& box(std::size_t p) const { return placed_[p]->boxes.whole(); }
  double size(std::size_t p) const { return box(p).diagonal().norm(); }

  template <class Act>
  void each(const std::optional<stokes::PeriodicCell>& cell, const Act& act) const {
    for (std::size_t p = 0; p < members_.size(); ++p)
      for (std::size_t q = 0; q <= p; ++q)
        for (const Vec3& beyond : images(x_[q], x_[p], q == p, cell))
          act(Pair{box(q).exteriorDistance(box(p).translated(beyond)), q, p, beyond});
  }

  const std::vector<Member>& members_;
  const std::vector<Net>& x_;
  std::vector<std::unique_ptr<Placed>> placed_;
  std::vector<Pair> all_;
  double radius_ = 0;  // largest R_C
};

/// Search for the smallest gap among the pairs of particles that are assigned to this rank.
class NearestPair {
 public:
  /// Computes the gaps of the pairs k for which mine(k) is true. Omits pairs whose lower bound shows that another gap is smaller.
  template <class Mine>
  NearestPair(const Pairs& pairs, const Mine& mine) : pairs_(pairs) {
    const double tolerance = pairs.tolerance();
    for (std::size_t k = 0; k < pairs.all().size() && pairs.all()[k].bound < gap_ + tolerance; ++k) {
      if (!mine(k)) continue;
      const double reach = gap_ + 2 * tolerance, gap = pairs.closest(pairs.all()[k], reach).gap;
      if (gap >= reach) continue;
      found_.emplace_back(gap, k);
      gap_ = std::min(gap_, gap);
    }
  }

  double gap() const { return gap_; }  ///< smallest gap of the searched pairs; infinite if there are none

  /// Returns the index of the pair to be reported, where `least` is the smallest gap of all ranks. If several pairs have this gap, for example in a
  /// symmetric scene, selects the pair whose particles come first in the deck, so that rounding does not decide. The result is the number of pairs if
  /// no pair has this gap.
  std::size_t with_gap(double least) const {
    std::size_t first = pairs_.all().size();
    for (const auto& [gap, k] : found_)
      if (gap <= least + pairs_.tolerance() && precedes(k, first)) first = k;
    return first;
  }

  /// Returns true if pair a is reported instead of pair b if both have the smallest gap.
  bool precedes(std::size_t a, std::size_t b) const {
    const std::size_t n = pairs_.all().size();
    if (a == n || b == n) return a < b;
    const Pair &one = pairs_.all()[a], &other = pairs_.all()[b];
    if (std::pair(one.first, one.second) != std::pair(other.first, other.second))
      return std::pair(one.first, one.second) < std::pair(other.first, other.second);
    for (int c = 0; c < 3; ++c)
      if (std::abs(one.beyond[c] - other.beyond[c]) > pairs_.tolerance()) return one.beyond[c] < other.beyond[c];
    return false;
  }

  /// Returns the gap of pair k, the numbers of its two particles (from 1), and the midpoint of its closest points. Returns an empty result if k is
  /// the number of pairs.
  Nearest of(std::size_t k) const {
    if (k == pairs_.all().size()) return {};
    const Pair& pair = pairs_.all()[k];
    const surface::ClosestPoints closest = pairs_.closest(pair, std::numeric_limits<double>::infinity());
    return {closest.gap, static_cast<int>(pair.first) + 1, static_cast<int>(pair.second) + 1, (closest.first + closest.second) / 2};
  }

 private:
  const Pairs& pairs_;
  std::vector<std::pair<double, std::size_t>> found_;  // gaps and indices of pairs that may have the smallest gap
  double gap_ = std::numeric_limits<double>::infinity();
};

std::vector<Net> own_nets(const std::vector<Member>& members, const Net& x) {
  std::vector<Net> own;
  for (const Member& member : members) own.push_back(member.own(x));
  return own;
}

/// Reduces the film width of each element to the element's distance from the plane wall, if the distance is smaller and at most `reach`.
void narrow(const surface::Patches& surface, const stokes::PlaneWall& wall, double reach, std::vector<double>& widths) {
  for (int e = 0; e < surface.size(); ++e)
    for (int k = 0; k < 9; ++k) {
      const double height = wall.height(surface::position(surface[e], k % 3 / 2., k / 3 / 2.));
      if (height <= reach) widths[e] = std::min(widths[e], std::max(height, 0.));
    }
}

/// Returns the net q and its lattice images if their bounding boxes are within `reach` of the bounding box of the net p; without a lattice, returns
/// q. `same`: true if q is p itself, which is then not returned.
std::vector<Net> neighbours(const Net& p, const Net& q, bool same, double reach, const std::optional<stokes::PeriodicCell>& cell) {
  std::vector<Net> found;
  const Eigen::Array3d low = p.colwise().minCoeff(), high = p.colwise().maxCoeff();
  for (const Vec3& beyond : images(p, q, false, cell)) {
    if (same && beyond.isZero(0)) continue;
    const Net image = q.rowwise() + beyond.transpose();
    const Eigen::Array3d from = image.colwise().minCoeff(), to = image.colwise().maxCoeff();
    if (!cell || (from - high).max(low - to).max(0).matrix().norm() <= reach) found.push_back(image);
  }
  return found;
}

/// Returns true if a point, which must not be on the surface, is inside. Seen from the point, the solid angle of the surface is then 4 pi, otherwise
/// 0.
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

/// Throws UserError if one particle is inside another one or its image on the lattice. The gap between their surfaces, which is positive, does not
/// show this.
void check_not_nested(const std::vector<Member>& members, const std::vector<Net>& x, const std::optional<stokes::PeriodicCell>& cell) {
  for (std::size_t p = 0; p < members.size(); ++p) {
    const surface::Patches outer(surface::BezierMap(members[p].body->space), x[p]);
    const Eigen::RowVector3d low = x[p].colwise().minCoeff(), high = x[p].colwise().maxCoeff();
    for (std::size_t q = 0; q < members.size(); ++q) {
      if (p == q) continue;
      const Vec3 point = surface::value(members[q].body->space, x[q], {0, 0.5, 0.5});
      for (const Vec3& image : images(x[p], x[q], false, cell)) {
        const Vec3 inner = point + image;
        if ((inner.transpose().array() < low.array()).any() || (inner.transpose().array() > high.array()).any()) continue;
        if (encloses(outer, inner))
          throw UserError("Particles/" + members[q].name + " is inside of Particles/" + members[p].name + " at the start.");
      }
    }
  }
}

/// Returns the two particles with the smallest gap at the start.
Nearest nearest_at_start(const std::vector<Member>& members, const std::optional<stokes::PeriodicCell>& cell) {
  std::vector<Net> x;
  for (const Member& member : members) x.push_back(member.body->initial);
  const Pairs pairs(members, x, cell);
  const NearestPair nearest(pairs, [](std::size_t) { return true; });
  Nearest found = nearest.of(nearest.with_gap(nearest.gap()));
  if (found.gap > 10 * pairs.tolerance()) check_not_nested(members, x, cell);
  else found.gap = 0;
  return found;
}

/// Throws NoRoom if the particles `nearest` overlap, or if their gap is smaller than `least`, a length.
void check_gap(const std::vector<Member>& members, const Nearest& nearest, double least) {
  const double gap = nearest.gap;
  if (gap > 0 && gap >= least) return;
  const auto scene = [&](int number) -> const ParticleScene& { return members[static_cast<std::size_t>(number) - 1].scene; };
  const bool own = nearest.first == nearest.second;
  const std::string first = scene(nearest.first).path(), second = own ? "its own image" : scene(nearest.second).path();
  const std::string where = formatted("near [%.4g, %.4g, %.4g]", nearest.place[0], nearest.place[1], nearest.place[2]);
  if (gap > 0)
    throw NoRoom(first + " and " + second + " start too close to each other: " + where +
                     formatted(" the gap is %.4g, less than %.4g; Contact/limit is %g R_C: move them apart, or set a smaller limit.", gap, least,
                               scene(nearest.first).contact.limit),
                 gap);
  if (own) throw NoRoom("Domain is smaller than " + first + ", which overlaps " + second + " " + where + ".", gap);
  throw NoRoom(first + " and " + second + " overlap at the start, " + where + ".", gap);
}

/// Returns particles of these kinds, with meshes refined by `factor`.
std::vector<Member> refined(Scene scene, std::vector<ParticleKind> kinds, int factor) {
  for (ParticleKind& kind : kinds) refine(kind, factor);
  scene.particles = std::move(kinds);
  return make_members(scene);
}

/// Throws UserError if two particles overlap in their initial shapes, if one is inside another, or if they are closer than a run in time allows.
void check_apart(const Scene& scene, const std::vector<Member>& members) {
  const std::optional<stokes::PeriodicCell> cell = scene.domain.cell();
  if (members.size() == 1 && !cell) return;
  const Nearest nearest = nearest_at_start(members, cell);
  const double least = scene.has_time() && scene.time.final_time > 0 ? scene.contact.start() * scene.least_radius() : 0;
  std::vector<ParticleKind> kinds{scene.particles[static_cast<std::size_t>(nearest.first) - 1]};
  if (nearest.second != nearest.first) kinds.push_back(scene.particles[static_cast<std::size_t>(nearest.second) - 1]);
  const auto fits_its_shape = [](const ParticleKind& kind) { return kind.particle.rigid() && kind.adaptation.enabled; };
  check_room(
      [&](int factor) {
        if (factor == 1) return check_gap(members, nearest, least);
        const std::vector<Member> finer = refined(scene, kinds, factor);
        check_gap(finer, nearest_at_start(finer, cell), least);
      },
      std::ranges::any_of(kinds, fits_its_shape));
}

}  // namespace

std::vector<Member> checked_members(const Scene& scene) {
  std::vector<Member> members = make_members(scene);
  check_apart(scene, members);
  for (std::size_t p = 0; p < members.size(); ++p)
    check_room([&](int factor) {
      if (factor == 1) check_outside_of_posts(scene, members[p]);
      else check_outside_of_posts(scene, refined(scene, {scene.particles[p]}, factor).front());
    });
  return members;
}

void Nearest::add_columns(Columns& to) const {
  to.add(gap, {"smallest_gap", "length", "smallest distance between the surfaces of two particles or of their periodic images"});
  to.add(first, {"first_of_gap", "1", "index of the first of the two particles of `smallest_gap`, from 1 in the order of the deck"});
  to.add(second, {"second_of_gap", "1", "index of the second of the two particles of `smallest_gap`, from 1 in the order of the deck"});
  to.add(place, "x1 x2 x3",
         {"gap_", "length", "component # of the position of the narrowest gap: midpoint between the nearest points of the two particles "
                            "of `smallest_gap`"});
}

Nearest smallest_gap(const std::vector<Member>& members, const Net& x, const coupling::Ranks& ranks,
                     const std::optional<stokes::PeriodicCell>& cell) {
  const std::vector<Net> own = own_nets(members, x);
  const Pairs pairs(members, own, cell);
  const auto mine = [&](std::size_t k) { return static_cast<int>(k % static_cast<std::size_t>(ranks.size())) == ranks.rank(); };
  const NearestPair nearest(pairs, mine);
  double least = std::numeric_limits<double>::max();
  for (const auto& [gap] : ranks.gathered(std::array{std::min(nearest.gap(), least)})) least = std::min(least, gap);
  std::size_t first = pairs.all().size();
  for (const auto& [pair] : ranks.gathered(std::array{static_cast<double>(nearest.with_gap(least))}))
    if (const auto k = static_cast<std::size_t>(pair); nearest.precedes(k, first)) first = k;
  return nearest.of(first);
}

Approach approach(const std::vector<Member>& members, const Net& x, coupling::Contact contact) {
  const auto element = [&](std::size_t k, const Vec3& beyond) {
    const Member& member = members[contact.particle[k]];
    return surface::ElementPoints(member.body->space, member.own(x).rowwise() + beyond.transpose(), contact.site[k].element);
  };
  const surface::ElementPoints first = element(0, Vec3::Zero()), second = element(1, contact.beyond);
  const surface::ClosestPoints found = surface::nearest_points(first.patch(), second.patch(), {Vec3::Zero(), Vec3::Zero(), 0, contact.site});
  contact.site = found.sites;
  const auto normal = [](const surface::ElementPoints& of, const spline::Site& at) {
    const surface::Jet jet = surface::jet(of.patch(), at.s, at.t);
    return Vec3(jet.s.cross(jet.t).normalized());
  };
  contact.normal = (normal(first, contact.site[0]) - normal(second, contact.site[1])).normalized();
  return {contact, found.gap};
}

std::vector<Approach> approaches(const std::vector<Member>& members, const Net& x, double reach, const coupling::Ranks& ranks,
                                 const std::optional<stokes::PeriodicCell>& cell) {
  constexpr int n = 7;  // count of numbers sent per pair: whether the gap is smaller than `reach`, then element, s and t of each of the two sites
  const std::vector<Net> own = own_nets(members, x);
  const Pairs pairs(members, own, cell, reach);
  const auto close = static_cast<std::size_t>(std::ranges::lower_bound(pairs.all(), reach, {}, &Pair::bound) - pairs.all().begin());
  const auto sites = ranks.divided<Eigen::MatrixXd>(static_cast<int>(close), n, [&](std::span<const int> mine, Eigen::MatrixXd& rows) {
    for (const int k : mine) {
      const surface::ClosestPoints found = pairs.closest(pairs.all()[static_cast<std::size_t>(k)], reach);
      const auto& [a, b] = found.sites;
      if (found.gap < reach) rows.row(k) << 1, a.element, a.s, a.t, b.element, b.s, b.t;
    }
  });
  std::vector<Approach> all;
  for (std::size_t k = 0; k < close; ++k) {
    const Eigen::VectorXd of = sites.row(static_cast<Eigen::Index>(k));
    const Pair& pair = pairs.all()[k];
    if (of[0] == 0) continue;
    all.push_back(approach(members, x, {{pair.first, pair.second}, {spline::Site{int(of[1]), of[2], of[3]}, spline::Site{int(of[4]), of[5], of[6]}},
                                        pair.beyond}));
  }
  return all;
}

std::vector<double> films(const std::vector<Member>& members, std::size_t p, const Net& x, const std::optional<stokes::PeriodicCell>& cell,
                          const surface::TubeWall* wall) {
  const Body& body = *members[p].body;
  const surface::Patches own(surface::BezierMap(body.nested()), members[p].own(x));
  const motion::AdaptationOptions& options = members[p].scene.adaptation;
  double longest = 0;  // longest diagonal of all elements of the surface, length
  for (int e = 0; e < own.size(); ++e)
    longest = std::max(longest, (surface::position(own[e], 0, 0) - surface::position(own[e], 1, 1)).norm());
  const double reach = std::pow(longest / *options.film_resolution, 2) / options.radius;
  std::vector<surface::Patches> placed;
  for (std::size_t q = 0; q < members.size(); ++q)
    for (const Net& other : neighbours(members[p].own(x), members[q].own(x), q == p, reach, cell))
      placed.emplace_back(surface::BezierMap(members[q].body->space), other);
  if (wall)
    for (const Net& net : neighbours(members[p].own(x), wall->net, false, reach, cell))
      placed.emplace_back(surface::BezierMap(wall->space), net);
  std::vector<const surface::Patches*> others;
  for (const surface::Patches& other : placed) others.push_back(&other);
  std::vector<double> widths = surface::film_widths(own, others, reach);
  for (const stokes::PlaneWall& plane : members[p].scene.wall.planes()) narrow(own, plane, reach, widths);
  return widths;
}

std::string touching(const Scene& scene, int first, int second) {
  const auto name = [&](int number) { return scene.particles[static_cast<std::size_t>(number) - 1].path(); };
  return name(first) + (first == second ? " touches its image" : " and " + name(second) + " touch");
}

}  // namespace tanktread
