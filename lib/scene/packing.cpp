#include "scene/packing.hpp"

#include <algorithm>
#include <array>

#include "system/parallel/stop_together.hpp"

namespace tanktread {

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

double least_distance(const PackedSphere& a, const PackedSphere& b, double gap) {
  return a.radius + b.radius + gap * std::max(a.radius, b.radius);
}

std::vector<Vec3> images_within(const stokes::PeriodicCell& cell, double reach) {
  std::array<int, 3> most{};
  for (int d = 0; d < cell.n(); ++d) most[static_cast<std::size_t>(d)] = static_cast<int>(reach / cell.spacing(d) + 0.5);
  return cell.around(most);
}

namespace {

constexpr int most_sweeps = 20000, thermal_sweeps = 200;
constexpr double clear = 1.01;  // overlapping spheres are pushed apart to this multiple of least_distance()

class Packing {
 public:
  Packing(std::vector<PackedSphere>& spheres, const stokes::PeriodicCell& cell, std::uint64_t seed) : spheres_(spheres), cell_(cell), random_(seed) {
    for (const PackedSphere& one : spheres) longest_ = std::max(longest_, least_distance(one, one));
    skin_ = longest_ / 4;
    images_ = images_within(cell, clear * longest_ + 2 * skin_);
  }

  bool push_apart() {
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      coupling::stop_together();
      find_neighbours();
      bool apart = true;
      for (std::size_t i = 0; i < spheres_.size(); ++i)
        for (const Neighbour& other : neighbours_[i])
          if (other.number > i) apart = push(i, other) && apart;
      if (apart) return true;
    }
    return false;
  }

  void shake() {
    double step = skin_ / 2;
    for (int sweep = 0; sweep < thermal_sweeps; ++sweep) {
      coupling::stop_together();
      find_neighbours();
      int taken = 0;
      for (std::size_t i = 0; i < spheres_.size(); ++i) taken += stepped(i, step);
      step = std::min(skin_ / 2, step * (2 * taken > static_cast<int>(spheres_.size()) ? 1.1 : 0.9));
    }
  }

 private:
  struct Neighbour {
    std::size_t number;
    Vec3 image;  // lattice vector from the neighbour's centre to the centre of its image that is close to the sphere
  };

  /// Lists, for each sphere, all spheres that it can overlap as long as no sphere moves by more than `skin_`. If no sphere has moved by half of
  /// `skin_` since the lists were built, keeps the lists.
  void find_neighbours() {
    double farthest = found_at_.empty() ? 2 * skin_ : 0;
    for (std::size_t i = 0; i < found_at_.size(); ++i) farthest = std::max(farthest, (spheres_[i].centre - found_at_[i]).norm());
    if (farthest < skin_ / 2) return;
    neighbours_.assign(spheres_.size(), {});
    found_at_.clear();
    for (const PackedSphere& one : spheres_) found_at_.push_back(one.centre);
    for (std::size_t i = 0; i < spheres_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Vec3 apart = spheres_[j].centre - spheres_[i].centre, nearest = -cell_.shift(apart);
        const double reach = clear * least_distance(spheres_[i], spheres_[j]) + 2 * skin_;
        for (const Vec3& image : images_) {
          if ((apart + nearest + image).squaredNorm() > reach * reach) continue;
          neighbours_[i].push_back({j, nearest + image});
          neighbours_[j].push_back({i, -nearest - image});
        }
      }
  }

  Vec3 apart(std::size_t i, const Neighbour& other) const { return spheres_[other.number].centre + other.image - spheres_[i].centre; }

  /// Returns true if the two spheres do not overlap. Otherwise moves them apart, in a random direction if their centres coincide.
  bool push(std::size_t i, const Neighbour& other) {
    PackedSphere &a = spheres_[i], &b = spheres_[other.number];
    const Vec3 between = apart(i, other);
    const double distance = between.norm(), least = least_distance(a, b);
    if (distance >= least || (a.fixed && b.fixed)) return true;  // two fixed spheres may overlap; check_apart tests their surfaces
    const Vec3 direction = distance > 1e-12 * least ? Vec3(between / distance) : direction_at_random();
    const double all = clear * least - distance, of_a = a.fixed ? 0 : b.fixed ? 1 : 0.5;
    a.centre -= of_a * all * direction;
    b.centre += (1 - of_a) * all * direction;
    return false;
  }

  /// Moves sphere i by a random step of at most the length `longest`. Undoes the step and returns false if the sphere then overlaps another sphere.
  /// The same applies if the sphere has moved by more than `skin_` since find_neighbours() built the neighbour lists.
  bool stepped(std::size_t i, double longest) {
    if (spheres_[i].fixed) return false;
    const Vec3 before = spheres_[i].centre;
    spheres_[i].centre += longest * uniform(random_) * direction_at_random();
    const auto overlaps = [&](const Neighbour& other) {
      return apart(i, other).norm() < least_distance(spheres_[i], spheres_[other.number]);
    };
    const bool far = (spheres_[i].centre - found_at_[i]).norm() > skin_;
    if (!far && std::ranges::none_of(neighbours_[i], overlaps)) return true;
    spheres_[i].centre = before;
    return false;
  }

  Vec3 direction_at_random() {
    for (;;) {
      Vec3 place;
      for (int c = 0; c < 3; ++c) place[c] = 2 * uniform(random_) - 1;
      if (const double length = place.norm(); length > 0.1 && length < 1) return place / length;
    }
  }

  std::vector<PackedSphere>& spheres_;
  const stokes::PeriodicCell& cell_;
  std::mt19937_64 random_;
  double longest_ = 0, skin_ = 0;
  std::vector<Vec3> images_, found_at_;
  std::vector<std::vector<Neighbour>> neighbours_;
};

}  // namespace

bool pack(std::vector<PackedSphere>& spheres, const stokes::PeriodicCell& cell, std::uint64_t seed) {
  Packing packing(spheres, cell, seed);
  if (!packing.push_apart()) return false;
  packing.shake();
  return true;
}

}  // namespace tanktread
