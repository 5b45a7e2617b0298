#include "system/solids/plates/plates_and_posts.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "surface/geometry.hpp"
#include "system/parallel/stop_together.hpp"
#include "system/targets/collocation.hpp"

namespace tanktread::coupling {

namespace {

surface::SolidSurface all_of(const std::vector<PlatesAndPosts::Solid>& solids) {
  std::vector<surface::SolidSurface> surfaces;
  for (const PlatesAndPosts::Solid& one : solids) surfaces.push_back(one.surface);
  return stacked(surfaces);
}

}  // namespace

PlatesAndPosts::PlatesAndPosts(const std::vector<Solid>& solids, const Parameters& parameters, Phases& phases)
    : surface_(all_of(solids)),
      parameters_(parameters),
      sites_(surface_.n_points(), 3),
      velocities_(surface_.n_points(), 3),
      first_{0},
      normals_(surface_.n_points(), 3) {
  const auto clock = phases.time("wall assembly");
  ranks_.measure(phases);
  own_ = ranks_.divide_in_order(surface::Symmetry(surface_.n_points()));
  for (int i = 0; i < surface_.n_points(); ++i) {
    const surface::Point at = surface::point(surface_.space, surface_.net, surface_.sites[static_cast<std::size_t>(i)].front());
    sites_.row(i) = at.x.transpose(), normals_.row(i) = at.n.transpose();
  }
  for (const Solid& one : solids) {
    velocities_.middleRows(first_.back(), one.surface.n_points()).rowwise() = one.velocity.transpose();
    first_.push_back(first_.back() + one.surface.n_points());
    if (one.outside) outside_.emplace_back(one.outside, one.name);
  }
  areas_ = moments([](const Vec3&) { return 1.; });
  flux_ = surface_.open_from_periodic.transpose() * surface::Geometry(surface_.space).volume_gradient(surface_.net);
  range_ = cell().range(surface_.net);
  if (solids.size() == 1 && cell().n() == 2) {  // widens the range of coordinates across a single plate, which has no thickness
    const double period = cell().vectors().col(0).norm();
    range_[0][2] -= period, range_[1][2] += period;
  }
  reached_ = range_;
  make_layer();
  stokes::Layer on_itself(stokes::Layer::Kernel::single_layer, surface_.space, surface_.sites, parameters.quadrature.for_matrix());
  on_itself.repeat(cell(), {.assembled = true, .target_range = range_});
  on_itself.set_shape(surface_.net);
  const auto& grid = solids.front().surface.grid;
  if (grid[0] > 0 && std::ranges::all_of(solids, [&](const Solid& one) { return one.surface.grid == grid; })) factor_plates(on_itself, grid);
  factor(on_itself);
  evaluations_ += on_itself.evaluations();
}

bool PlatesAndPosts::is_for(const std::vector<Solid>& solids, const Parameters& parameters) const {
  const surface::SolidSurface all = all_of(solids);
  if (!(parameters == parameters_) || !same(all.net, surface_.net) || solids.size() + 1 != first_.size()) return false;
  for (std::size_t s = 0; s < solids.size(); ++s)
    if (solids[s].surface.n_points() != first_[s + 1] - first_[s] || velocities_.row(first_[s]) != solids[s].velocity.transpose()) return false;
  return true;
}

/// Computes the inverse of the operator by Fourier series. All solids must be plates with the same grid of points.
void PlatesAndPosts::factor_plates(stokes::Layer& on_itself, const std::array<int, 2>& grid) {
  const auto [n1, n2] = grid;
  std::vector<int> middle;  // one point of each plate, far from the plate's edges
  for (std::size_t s = 0; s + 1 < first_.size(); ++s) middle.push_back(first_[s] + n1 / 2 * n2 + n2 / 2);
  Eigen::MatrixXd regular = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(middle.size()), 3 * static_cast<Eigen::Index>(middle.size()));
  for (std::size_t s = 0; s < middle.size(); ++s) {
    const Vec3 n = normals_.row(middle[s]).transpose();
    const auto at = 3 * static_cast<Eigen::Index>(s);
    regular.block<3, 3>(at, at) = std::sqrt(area(s)) * n * n.transpose();
  }
  plates_.emplace(rows(on_itself, middle), grid, std::array{n1 / 2, n2 / 2}, regular);
}

void PlatesAndPosts::make_layer() {
  if (layer_) evaluations_ += layer_->evaluations();
  layer_ = std::make_unique<stokes::Layer>(stokes::Layer::Kernel::single_layer, surface_.space, stokes::Sites(),
                                           parameters_.quadrature.for_response());
  layer_->repeat(cell(), {.target_range = reached_});
  layer_->set_shape(surface_.net);
}

/// Sets the range of coordinates for which the layer is accurate, so that it includes x. The range depends only on the current x, so that a resumed
/// run computes the same velocities. The range grows in steps, so that a moving particle seldom needs a new layer.
void PlatesAndPosts::reach(const Net& x) {
  if (cell().n() == 3) return;
  const auto [low, high] = cell().range(x);
  const double step = (range_[1][2] - range_[0][2]) / 4;
  const auto rounded = [&](double length) { return step * std::ceil(std::max(0., length) / step); };
  std::array<Vec3, 2> range = range_;
  range[0][2] -= rounded(range_[0][2] - low[2]), range[1][2] += rounded(high[2] - range_[1][2]);
  if (range == reached_) return;
  reached_ = range;
  make_layer();
}

bool PlatesAndPosts::reaches(const Net& at) const {
  if (cell().n() == 3 || at.rows() == 0 || !at.allFinite()) return true;
  const auto [low, high] = cell().range(at);
  const double slack = 1e-6 * (reached_[1][2] - reached_[0][2]);  // points of a surface may be outside of the range of its control points
  return low[2] >= reached_[0][2] - slack && high[2] <= reached_[1][2] + slack;
}

PlatesAndPosts::Crossing PlatesAndPosts::crossing(const Net& at) const {
  for (const auto& [outside, name] : outside_)
    for (Eigen::Index i = 0; i < at.rows(); ++i)
      if (!outside(at.row(i).transpose())) return {i, name};
  return {};
}

/// Returns the rows of the single-layer matrix for control values of f (2.46) at `sites`, three rows per site.
Eigen::MatrixXd PlatesAndPosts::rows(stokes::Layer& on_itself, std::span<const int> sites) const {
  stokes::Rows<double> all;
  on_itself.assemble(sites, all);
  return columns_of(surface_.open_from_periodic, all);
}

/// Factors the matrix of the equations (2.46) for the force density and the uniform velocity, for unit viscosity, on every rank. If all solids are
/// plates, factors only the block for densities that are uniform on each plate.
void PlatesAndPosts::factor(stokes::Layer& on_itself) {
  constexpr std::size_t at_a_time = 240;
  const auto m = static_cast<Eigen::Index>(parameters_.free.size()), solids = static_cast<Eigen::Index>(first_.size()) - 1;
  const Eigen::Index n = plates_ ? 3 * solids : sites_.size();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + m, n + m);
  if (plates_) {
    all.topLeftCorner(n, n) = plates_->uniform();
  } else {
    all = ranks_.assembled<Eigen::MatrixXd>(n + m, n + m, [&](Eigen::MatrixXd& a) {
      stop_together([&] {
        for (std::size_t first = 0; first < own_.size(); first += at_a_time) {
          const auto some = std::span(own_).subspan(first, std::min(at_a_time, own_.size() - first));
          const Eigen::MatrixXd part = rows(on_itself, some);
          for (std::size_t k = 0; k < some.size(); ++k) a.block(3 * some[k], 0, 3, n) = part.middleRows<3>(3 * static_cast<Eigen::Index>(k));
        }
      });
    });
    for (std::size_t s = 0; s + 1 < first_.size(); ++s) {
      const Eigen::Index first = 3 * first_[s], length = 3 * first_[s + 1] - first;
      const Eigen::Map<const Eigen::VectorXd> w(normals_.data() + first, length), b(flux_.data() + first, length);
      all.block(first, first, length, length) += std::sqrt(area(s)) / b.dot(w) * w * b.transpose();
    }
  }
  for (Eigen::Index k = 0; k < m; ++k)
    for (Eigen::Index i = 0; i < n / 3; ++i) {
      const Vec3& free = parameters_.free[static_cast<std::size_t>(k)];
      all.col(n + k).segment<3>(3 * i) = free;
      all.row(n + k).segment<3>(3 * i) = (plates_ ? area(static_cast<std::size_t>(i)) : areas_[i]) * free.transpose();
    }
  stop_together([&] { factors_ = DenseFactors(std::move(all)); });
}

PlatesAndPosts::Flow PlatesAndPosts::solve(const Net& u, const Vec3& force) const {
  const auto m = static_cast<Eigen::Index>(parameters_.free.size());
  Net given = u, f;
  if (plates_) f = plates_->solve(u, given);
  const Eigen::Index n = given.size();
  Eigen::VectorXd right(n + m);
  right.head(n) = flat(given);
  for (Eigen::Index k = 0; k < m; ++k) right[n + k] = parameters_.free[static_cast<std::size_t>(k)].dot(force) / viscosity();
  const Eigen::VectorXd solution = factors_.solve(right);
  const Eigen::Map<const Net> found(solution.data(), n / 3, 3);
  if (plates_)
    for (std::size_t s = 0; s + 1 < first_.size(); ++s)
      f.middleRows(first_[s], first_[s + 1] - first_[s]).rowwise() += found.row(static_cast<Eigen::Index>(s));
  else
    f = found;
  Flow flow{viscosity() * f};
  for (Eigen::Index k = 0; k < m; ++k) flow.drift += solution[n + k] * parameters_.free[static_cast<std::size_t>(k)];
  return flow;
}

PointsOff PlatesAndPosts::prepared(Net at, std::vector<int> own) {
  PointsOff points{.at = std::move(at), .own = std::move(own)};
  points.near = layer_->near(points.at, points.own);
  return points;
}

void PlatesAndPosts::velocity_at(const PointsOff& points, const Flow& flow, Net& u) {
  assert(reaches(points.at(points.own, Eigen::all)));
  layer_->apply(on_space(flow.force), points.at, points.own, u, points.near ? &*points.near : nullptr);
  for (const int i : points.own) u.row(i) = u.row(i) / viscosity() + flow.drift.transpose();
}

Eigen::VectorXd PlatesAndPosts::moments(const std::function<double(const Vec3& x)>& function) const {
  const BetweenSites between = between_sites(surface_.space, surface_.net);
  const Net at = between.values * surface_.net;
  Eigen::VectorXd values(at.rows());
  for (Eigen::Index i = 0; i < at.rows(); ++i) values[i] = function(at.row(i).transpose());
  return surface_.open_from_periodic.transpose() * (between.weights * values);
}

std::vector<Vec3> PlatesAndPosts::forces(const Net& f) const {
  std::vector<Vec3> all;
  for (std::size_t s = 0; s + 1 < first_.size(); ++s) {
    const auto rows = [&](const auto& of) { return of.middleRows(first_[s], first_[s + 1] - first_[s]); };
    all.push_back((rows(f).transpose() * rows(areas_)).eval());
  }
  return all;
}

}  // namespace tanktread::coupling
