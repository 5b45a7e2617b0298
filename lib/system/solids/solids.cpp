#include "system/solids/solids.hpp"

#include <algorithm>
#include <utility>

#include "surface/geometry.hpp"
#include "system/collocation.hpp"

namespace tanktread::coupling {

namespace {

/// Returns options with a smaller tolerance, for the matrix of the solids on themselves. This matrix is assembled only once.
quadrature::Options sharper(quadrature::Options options) {
  options.tolerance = std::max(1e-12, std::min(1e-7, options.tolerance / 10));
  return options;
}

surface::SolidSurface all_of(const std::vector<Solids::Solid>& solids) {
  std::vector<surface::SolidSurface> surfaces;
  for (const Solids::Solid& one : solids) surfaces.push_back(one.surface);
  return stacked(surfaces);
}

}  // namespace

Solids::Solids(const std::vector<Solid>& solids, const stokes::PeriodicCell& cell, const std::vector<Vec3>& free, double viscosity,
               const quadrature::Options& quadrature, Phases& phases)
    : surface_(all_of(solids)),
      cell_(cell),
      free_(free),
      viscosity_(viscosity),
      layer_(stokes::Layer::Kernel::single_layer, surface_.space, {}, quadrature),
      sites_(surface_.n_points(), 3),
      velocities_(surface_.n_points(), 3) {
  const auto clock = phases.time("wall assembly");
  ranks_.measure(phases);
  own_ = ranks_.share(surface_.n_points());
  ranks_.own(own_, surface_.n_points());
  for (int i = 0; i < surface_.n_points(); ++i)
    sites_.row(i) = surface::value(surface_.space, surface_.net, surface_.sites[static_cast<std::size_t>(i)].front()).transpose();
  for (const Solid& one : solids) {
    velocities_.middleRows(first_.empty() ? 0 : first_.back(), one.surface.n_points()).rowwise() = one.velocity.transpose();
    if (first_.empty()) first_.push_back(0);
    first_.push_back(first_.back() + one.surface.n_points());
  }
  layer_.repeat(cell_);
  layer_.place(surface_.net);
  areas_ = moments([](const Vec3&) { return 1.; });
  factors_ = DenseFactors(assembled(sharper(quadrature)));
}

/// Returns the matrix of (2.46) for the viscosity 1, on every rank.
Eigen::MatrixXd Solids::assembled(const quadrature::Options& quadrature) {
  constexpr std::size_t at_a_time = 240;
  const Eigen::Index n = 3 * sites_.rows(), m = static_cast<Eigen::Index>(free_.size());
  stokes::Layer on_itself(stokes::Layer::Kernel::single_layer, surface_.space, surface_.sites, quadrature);
  on_itself.repeat(cell_, {.assembled = true});
  on_itself.place(surface_.net);
  Eigen::MatrixXd all = ranks_.assembled<Eigen::MatrixXd>(n + m, n + m, [&](Eigen::MatrixXd& a) {
    stokes::Rows<double> rows;
    for (std::size_t first = 0; first < own_.size(); first += at_a_time) {
      const auto some = std::span(own_).subspan(first, std::min(at_a_time, own_.size() - first));
      on_itself.assemble(some, rows);
      on_itself.assemble_rest(some, rows);
      for (std::size_t k = 0; k < some.size(); ++k)
        for (int c = 0; c < 3; ++c) {
          const auto row = rows.row(static_cast<Eigen::Index>(3 * k) + c);
          const Net periodic = surface_.open_from_periodic.transpose() * Eigen::Map<const Net>(row.data(), surface_.space.n_points, 3);
          a.row(3 * some[k] + c).head(n) = Eigen::Map<const Eigen::RowVectorXd>(periodic.data(), n);
        }
    }
  });
  on_itself_evaluations_ = on_itself.evaluations();
  const Net flux = surface_.open_from_periodic.transpose() * surface::Geometry(surface_.space).volume_gradient(surface_.net);
  Net normal(sites_.rows(), 3);
  for (int i = 0; i < surface_.n_points(); ++i)
    normal.row(i) = surface::point(surface_.space, surface_.net, surface_.sites[static_cast<std::size_t>(i)].front()).n.transpose();
  for (std::size_t s = 0; s + 1 < first_.size(); ++s) {
    const Eigen::Index first = 3 * first_[s], length = 3 * first_[s + 1] - first;
    const Eigen::Map<const Eigen::VectorXd> w(normal.data() + first, length), b(flux.data() + first, length);
    const double scale = areas_.middleRows(first_[s], first_[s + 1] - first_[s]).sum();
    all.block(first, first, length, length) += std::sqrt(scale) / b.dot(w) * w * b.transpose();
  }
  for (Eigen::Index k = 0; k < m; ++k)
    for (Eigen::Index i = 0; i < sites_.rows(); ++i) {
      all.col(n + k).segment<3>(3 * i) = free_[static_cast<std::size_t>(k)];
      all.row(n + k).segment<3>(3 * i) = areas_(i) * free_[static_cast<std::size_t>(k)].transpose();
    }
  return all;
}

Solids::Flow Solids::solve(const Net& u, const Vec3& force) const {
  const Eigen::Index n = u.size(), m = static_cast<Eigen::Index>(free_.size());
  Eigen::VectorXd right(n + m);
  right.head(n) = Eigen::Map<const Eigen::VectorXd>(u.data(), n);
  for (Eigen::Index k = 0; k < m; ++k) right[n + k] = free_[static_cast<std::size_t>(k)].dot(force) / viscosity_;
  const Eigen::VectorXd solution = factors_.solve(right);
  Flow flow{viscosity_ * Eigen::Map<const Net>(solution.data(), u.rows(), 3)};
  for (Eigen::Index k = 0; k < m; ++k) flow.drift += solution[n + k] * free_[static_cast<std::size_t>(k)];
  return flow;
}

void Solids::velocity_at(const Net& at, std::span<const int> rows, const Flow& flow, Net& u, const stokes::Layer::Near* kept) {
  layer_.apply(on_space(flow.force), at, rows, u, kept);
  for (const int i : rows) u.row(i) = u.row(i) / viscosity_ + flow.drift.transpose();
}

Eigen::VectorXd Solids::moments(const std::function<double(const Vec3& x)>& function) const {
  const BetweenSites between = between_sites(surface_.space, surface_.net);
  const Net at = between.values * surface_.net;
  Eigen::VectorXd values(at.rows());
  for (Eigen::Index i = 0; i < at.rows(); ++i) values[i] = function(at.row(i).transpose());
  return surface_.open_from_periodic.transpose() * (between.weights * values);
}

std::vector<Vec3> Solids::forces(const Net& f) const {
  std::vector<Vec3> all;
  for (std::size_t s = 0; s + 1 < first_.size(); ++s) {
    const auto rows = [&](const auto& of) { return of.middleRows(first_[s], first_[s + 1] - first_[s]); };
    all.push_back((rows(f).transpose() * rows(areas_)).eval());
  }
  return all;
}

std::array<Vec3, 2> Solids::across() const {
  std::array<Vec3, 2> extent{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
  for (Eigen::Index i = 0; i < surface_.net.rows(); ++i) {
    const Vec3 s = cell_.coordinates(surface_.net.row(i).transpose());
    extent[0] = extent[0].cwiseMin(s), extent[1] = extent[1].cwiseMax(s);
  }
  return extent;
}

}  // namespace tanktread::coupling
