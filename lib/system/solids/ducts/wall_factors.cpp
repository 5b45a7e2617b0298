#include "system/solids/ducts/wall_factors.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "spline/point_search.hpp"
#include "system/parallel/stop_together.hpp"
#include "system/solids/ducts/wall_points.hpp"

namespace tanktread::coupling {
namespace {

/// Points of a wall, and reflections that map these points onto each other.
class Images {
 public:
  Images(const Net& points, const Vec3& centre, double close, double period)
      : centre_(centre), period_(period), search_(std::vector<Vec3>(points.rowwise().begin(), points.rowwise().end()), close) {}

  /// Returns, for each point, the index of its image under the reflection with these signs, up to a shift by one period. Returns nothing if the image
  /// of any point is not one of the points.
  std::optional<std::vector<int>> under(const Vec3& signs) const {
    std::vector<int> images;
    for (const Vec3& x : search_.all()) {
      const surface::Reflection reflection{signs, centre_};
      int image = search_.at(reflection(x));
      for (const double shift : {-period_, period_})
        if (image < 0 && period_ > 0) image = search_.at(reflection(x) + shift * Vec3::UnitX());
      if (image < 0) return {};
      images.push_back(image);
    }
    return images;
  }

 private:
  Vec3 centre_;
  double period_;
  spline::PointSearch search_;
};

/// Returns one set of factors of the planes for each parity that differs on the group `wall` and contains fields with the symmetry `fields`.
std::vector<Vec3> parities(const surface::Symmetry& wall, const surface::Symmetry& fields) {
  std::vector<Vec3> found;
  const auto agree = [](const surface::Symmetry& on, const Vec3& a, const Vec3& b) {
    const auto same = [&](const surface::Image& g) { return surface::character(g.signs, a) == surface::character(g.signs, b); };
    return std::ranges::all_of(on.images(), same);
  };
  for (int k = 0; k < 8; ++k) {
    const Vec3 planes(k & 1 ? -1 : 1, k & 2 ? -1 : 1, k & 4 ? -1 : 1);
    if (agree(fields, planes, Vec3::Ones()) && std::ranges::none_of(found, [&](const Vec3& other) { return agree(wall, planes, other); }))
      found.push_back(planes);
  }
  return found;
}

}  // namespace

surface::Symmetry reflections(const surface::TubeWall& wall, const Net& sites) {
  Vec3 centre = (sites.colwise().maxCoeff() + sites.colwise().minCoeff()).transpose() / 2;
  if (wall.period > 0) centre[0] = 0;
  const auto images = [&](const Net& points) { return Images(points, centre, 1e-10 * wall.radius(), wall.period); };
  stokes::Sites middles;
  for (const spline::Site& middle : wall.middles) middles.push_back({middle});
  const Images of_sites = images(sites), of_middles = images(positions(wall, middles));
  const bool open = wall.period == 0;  // the control points of an open wall are numbered like its sites
  std::vector<surface::Image> found;
  for (int k = 1; k < 8; ++k) {
    const Vec3 signs(k & 1 ? -1 : 1, k & 2 ? -1 : 1, k & 4 ? -1 : 1);
    const auto image = of_sites.under(signs);
    if (!image || !of_middles.under(signs)) continue;
    const Net moved = (wall.net.rowwise() - centre.transpose()) * signs.asDiagonal();
    if (open && !((wall.net(*image, Eigen::all).rowwise() - centre.transpose()) - moved).isZero(1e-10 * wall.radius())) continue;
    found.push_back({signs, *image, {}, {}});
  }
  return {found, sites};
}

WallFactors::WallFactors(surface::Symmetry wall, const surface::Symmetry& fields) : wall_(std::move(wall)) {
  std::vector<int> points_in_orbit(wall_.source().size());
  for (const int a : wall_.source()) ++points_in_orbit[static_cast<std::size_t>(a)];
  for (const Vec3& planes : parities(wall_, fields)) {
    Block block{surface::Parity(wall_, planes), std::vector<int>(3 * points_in_orbit.size(), -1), {}, {}, {}};
    std::vector<double> orbit;
    for (const int a : wall_.fundamental())
      for (int c = 0; c < 3; ++c)
        if (block.parity.signs()(a, c) != 0) {
          block.unknown[static_cast<std::size_t>(3 * a + c)] = static_cast<int>(orbit.size());
          orbit.push_back(points_in_orbit[static_cast<std::size_t>(a)]);
        }
    const auto n = static_cast<Eigen::Index>(orbit.size());
    block.orbit = Eigen::Map<const Eigen::VectorXd>(orbit.data(), n);
    block.matrix = Eigen::MatrixXd::Zero(n, n);
    blocks_.push_back(std::move(block));
  }
}

double WallFactors::bytes(const surface::Symmetry& wall, const surface::Symmetry& fields) {
  const double unknowns = 3.0 * static_cast<double>(wall.source().size()) / wall.order();
  return 8 * static_cast<double>(parities(wall, fields).size()) * unknowns * unknowns;
}

void WallFactors::add(int site, int from, const Mat3& block) {
  const int source = wall_.source()[static_cast<std::size_t>(from)];
  for (Block& one : blocks_) {
    const int* const row = &one.unknown[static_cast<std::size_t>(3 * site)];
    const int* const column = &one.unknown[static_cast<std::size_t>(3 * source)];
    for (int d = 0; d < 3; ++d) {
      if (column[d] < 0) continue;
      const double sign = one.parity.signs()(from, d);
      for (int c = 0; c < 3; ++c)
        if (row[c] >= 0) one.matrix(row[c], column[d]) += sign * block(c, d);
    }
  }
}

void WallFactors::add_product(const Net& a, const Net& b) {
  Block& symmetric = blocks_.front();  // parities() begins with (1, 1, 1)
  symmetric.matrix += folded(symmetric, a).cwiseQuotient(symmetric.orbit) * folded(symmetric, b).transpose();
}

void WallFactors::factor(const Ranks& ranks) {
  for (Block& block : blocks_) {
    const Eigen::Index n = block.matrix.rows();
    Eigen::MatrixXd all = ranks.assembled<Eigen::MatrixXd>(n, n, [&](Eigen::MatrixXd& sum) { sum = std::exchange(block.matrix, {}); });
    stop_together([&] { block.factors = DenseFactors(std::move(all)); });
  }
}

/// Returns E_c^T times a field (4.37).
Eigen::VectorXd WallFactors::folded(const Block& block, const Net& field) const {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(block.orbit.size());
  for (Eigen::Index p = 0; p < field.rows(); ++p) {
    const int* const unknown = &block.unknown[static_cast<std::size_t>(3 * wall_.source()[static_cast<std::size_t>(p)])];
    for (int c = 0; c < 3; ++c)
      if (unknown[c] >= 0) sums[unknown[c]] += block.parity.signs()(p, c) * field(p, c);
  }
  return sums;
}

/// Adds E_c x (4.37) to a field.
void WallFactors::spread(const Block& block, const Eigen::VectorXd& x, Net& field) const {
  for (Eigen::Index p = 0; p < field.rows(); ++p) {
    const int* const unknown = &block.unknown[static_cast<std::size_t>(3 * wall_.source()[static_cast<std::size_t>(p)])];
    for (int c = 0; c < 3; ++c)
      if (unknown[c] >= 0) field(p, c) += block.parity.signs()(p, c) * x[unknown[c]];
  }
}

Net WallFactors::solve(const Net& rhs) const {
  Net f = Net::Zero(rhs.rows(), 3);
  for (const Block& block : blocks_) spread(block, block.factors.solve(folded(block, rhs).cwiseQuotient(block.orbit)), f);
  return f;
}

Net WallFactors::solve_transposed(const Net& weights) const {
  Net w = Net::Zero(weights.rows(), 3);
  for (const Block& block : blocks_) spread(block, block.factors.solve_transposed(folded(block, weights)).cwiseQuotient(block.orbit), w);
  return w;
}

}  // namespace tanktread::coupling
