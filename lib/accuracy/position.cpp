#include "accuracy/position.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "accuracy/estimate.hpp"
#include "record/files/nodes.hpp"
#include "spline/limits.hpp"
#include "spline/point_search.hpp"

namespace tanktread::accuracy {

namespace {

using output::StoredSurface;

/// Values and derivatives at x in [0, 1] of the Lagrange polynomials of degree p on the equidistant nodes k/p, k = 0 ... p.
struct Lagrange {
  std::array<double, spline::largest_degree + 1> value, slope;

  Lagrange(int p, double x) {
    for (int k = 0; k <= p; ++k) {
      double product = 1, derivative = 0, denominator = 1;
      for (int i = 0; i <= p; ++i) {
        if (i == k) continue;
        const double factor = x * p - i;
        derivative = derivative * factor + product * p;
        product *= factor, denominator *= k - i;
      }
      value[static_cast<std::size_t>(k)] = product / denominator, slope[static_cast<std::size_t>(k)] = derivative / denominator;
    }
  }
};

/// Returns the grid indices (i, j) of the nodes of a cell of degree p, in the order of the stored nodes (output::node_order).
const std::vector<std::array<int, 2>>& order_of(int p) {
  static std::array<std::vector<std::array<int, 2>>, spline::largest_degree + 1> orders;
  auto& order = orders.at(static_cast<std::size_t>(p));
  if (order.empty()) order = output::node_order(p);
  return order;
}

/// Returns the position on a cell at the parameters (s, t) in [0, 1], and its derivatives by s and t.
std::array<Vec3, 3> evaluated(const StoredSurface& surface, const std::vector<int>& cell, double s, double t) {
  const int p = static_cast<int>(std::lround(std::sqrt(static_cast<double>(cell.size())))) - 1;
  const Lagrange a(p, s), b(p, t);
  const auto& order = order_of(p);
  std::array<Vec3, 3> found{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (std::size_t k = 0; k < cell.size(); ++k) {
    const auto i = static_cast<std::size_t>(order[k][0]), j = static_cast<std::size_t>(order[k][1]);
    const Vec3 x = surface.points.row(cell[k]).transpose();
    found[0] += a.value[i] * b.value[j] * x, found[1] += a.slope[i] * b.value[j] * x, found[2] += a.value[i] * b.slope[j] * x;
  }
  return found;
}

/// Distance of a position from a cell. `inside`: true if the nearest point of the cell is not on its edge.
struct FromCell {
  double distance = std::numeric_limits<double>::infinity();
  bool inside = false;
};

/// Returns the distance of x from a cell. The iteration starts at the parameters s and t.
FromCell distance_from_cell(const StoredSurface& surface, const std::vector<int>& cell, const Vec3& x, double s = 0.5, double t = 0.5) {
  FromCell found;
  for (int iteration = 0; iteration < 8; ++iteration) {
    const auto [y, along_s, along_t] = evaluated(surface, cell, s, t);
    const Vec3 off = x - y;
    found.distance = std::min(found.distance, off.norm());
    Eigen::Matrix2d normal;
    normal << along_s.dot(along_s), along_s.dot(along_t), along_s.dot(along_t), along_t.dot(along_t);
    const Eigen::Vector2d step = normal.inverse() * Eigen::Vector2d(along_s.dot(off), along_t.dot(off));
    if (!step.allFinite()) break;
    const double new_s = std::clamp(s + step[0], 0., 1.), new_t = std::clamp(t + step[1], 0., 1.);
    found.inside = new_s == s + step[0] && new_t == t + step[1];
    const double change = std::abs(new_s - s) + std::abs(new_t - t);
    if (change < 1e-6) {  // off minus the tangential displacement of the last step errs by about 1e-12 of the cell's size
      found.distance = std::min(found.distance, (off - (new_s - s) * along_s - (new_t - t) * along_t).norm());
      break;
    }
    s = new_s, t = new_t;
  }
  return found;
}

/// Distances from a surface: its nodes, among which the nearest one is found quickly, and the cells around them.
class Distances {
 public:
  explicit Distances(const StoredSurface& surface) : surface_(surface), cells_of_(static_cast<std::size_t>(surface.points.rows())) {
    for (std::size_t c = 0; c < surface.cells.size(); ++c)
      for (const int node : surface.cells[c]) {
        cells_of_[static_cast<std::size_t>(node)].push_back(c);
        diameter_ = std::max(diameter_, (surface.points.row(node) - surface.points.row(surface.cells[c].front())).norm());
      }
    std::vector<Vec3> points;
    for (const auto& row : surface.points.rowwise()) points.emplace_back(row);
    nodes_.emplace(std::move(points), 0);
  }

  double operator()(const Vec3& x) const {
    const int nearest = nodes_->nearest(x, far * diameter_);
    if (nearest < 0) return std::numeric_limits<double>::quiet_NaN();
    double least = (nodes_->all()[static_cast<std::size_t>(nearest)] - x).norm();
    std::set<std::size_t> around;  // cells that share a node with the cells at the nearest node
    for (const std::size_t c : cells_at(nearest)) {
      const std::vector<int>& cell = surface_.cells[c];
      const auto p = static_cast<int>(std::lround(std::sqrt(static_cast<double>(cell.size())))) - 1;
      const auto& [i, j] = order_of(p)[static_cast<std::size_t>(std::ranges::find(cell, nearest) - cell.begin())];
      const FromCell found = distance_from_cell(surface_, cell, x, static_cast<double>(i) / p, static_cast<double>(j) / p);
      least = std::min(least, found.distance);
      if (found.inside) return least;
      for (const int node : cell) around.insert(cells_at(node).begin(), cells_at(node).end());
    }
    for (const std::size_t c : around) least = std::min(least, distance_from_cell(surface_, surface_.cells[c], x).distance);
    return least;
  }

 private:
  static constexpr double far = 1.2;  // largest distance of the nearest node, divided by `diameter_`
  const std::vector<std::size_t>& cells_at(int node) const { return cells_of_[static_cast<std::size_t>(node)]; }

  const StoredSurface& surface_;
  std::vector<std::vector<std::size_t>> cells_of_;  // for each node, the cells that contain it
  double diameter_ = 0;                             // largest distance of a node from the first node of its cell
  std::optional<spline::PointSearch> nodes_;
};

}  // namespace

std::vector<double> distances(const StoredSurface& fine, const StoredSurface& coarse) {
  const Distances from_coarse(coarse);
  std::vector<double> found;
  for (Eigen::Index k = 0; k < fine.points.rows(); ++k) found.push_back(from_coarse(fine.points.row(k).transpose()));
  return found;
}

void write_position_errors(const std::array<std::filesystem::path, 3>& levels, const std::vector<double>& expected, const std::filesystem::path& to) {
  const auto& [coarsest, coarse, fine] = levels;
  using Snapshots = std::vector<std::pair<std::string, double>>;
  const Snapshots of_coarsest = output::snapshot_times(coarsest), of_coarse = output::snapshot_times(coarse);
  const auto surface_at = [](const std::filesystem::path& level, const Snapshots& snapshots, double time) -> std::optional<StoredSurface> {
    for (const auto& [name, other] : snapshots)
      if (std::abs(other - time) <= 1e-9 * std::max(1., time)) return output::read_surface(level / name);
    return {};
  };
  for (const auto& [name, time] : output::snapshot_times(fine)) {
    const auto before = surface_at(coarse, of_coarse, time), first = surface_at(coarsest, of_coarsest, time);
    if (!before || !first) continue;
    const StoredSurface surface = output::read_surface(fine / name);
    std::vector<double> errors = distances(surface, *before);
    const double size = (surface.points.colwise().maxCoeff() - surface.points.colwise().minCoeff()).norm();
    if (!estimated({largest(distances(*before, *first)), largest(errors)}, size, expected).trusted()) continue;
    for (double& error : errors) error = predicted_error(error, expected[1], expected[2], expected[2]);
    output::add_field(fine / name, to / name, "position error", errors);
  }
}

}  // namespace tanktread::accuracy
