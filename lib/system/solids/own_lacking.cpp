#include "system/solids/own_lacking.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include <Eigen/SparseCholesky>

#include "membrane/direct_solver.hpp"
#include "stokes/layer.hpp"
#include "surface/geometry.hpp"
#include "system/collocation.hpp"
#include "system/solids/rigid_motion.hpp"

namespace tanktread::coupling {

namespace {

std::vector<int> numbers(int first, int last) {
  std::vector<int> all(static_cast<std::size_t>(last - first));
  std::iota(all.begin(), all.end(), first);
  return all;
}

/// A f at sites, of each f.
std::array<Net, 6> single_layer_at(const stokes::Sites& sites, const spline::Space& space, const Net& surface, const std::array<Net, 6>& f,
                                   const quadrature::Options& quadrature) {
  stokes::Layer layer(stokes::Layer::Kernel::single_layer, space, sites, quadrature);
  layer.place(surface);
  const std::vector<int> all = numbers(0, static_cast<int>(sites.size()));
  std::array<Net, 6> u;
  u.fill(Net(sites.size(), 3));
  for (std::size_t k = 0; k < f.size(); ++k) layer.apply(f[k], all, u[k]);
  return u;
}

/// S H of weights S, shape (N, sites), row 3 a + c for component c, from rows of H that are made some at a time.
Eigen::MatrixXd weighted_double_layer(const stokes::Sites& sites, const Eigen::SparseMatrix<double>& weights, const spline::Space& space,
                                      const Net& surface, const quadrature::Options& quadrature) {
  constexpr int at_a_time = 512;
  using Strided = Eigen::Map<const stokes::Rows<double>, 0, Eigen::OuterStride<>>;
  stokes::Layer layer(stokes::Layer::Kernel::double_layer, space, sites, quadrature);
  layer.place(surface);
  const int n_sites = static_cast<int>(sites.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3 * weights.rows(), surface.size());
  stokes::Rows<double> rows;
  for (int first = 0; first < n_sites; first += at_a_time) {
    const int last = std::min(first + at_a_time, n_sites);
    layer.assemble(numbers(first, last), rows);
    for (int c = 0; c < 3; ++c)
      sum(Eigen::seq(c, Eigen::last, 3), Eigen::all) +=
          weights.middleCols(first, last - first) * Strided(rows.row(c).data(), last - first, rows.cols(), Eigen::OuterStride<>(3 * rows.cols()));
  }
  return sum;
}

}  // namespace

OwnLacking::OwnLacking(const spline::Space& space, const Net& surface, const quadrature::Options& quadrature) {
  const auto [places, at_places, weights] = between_sites(space, surface);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> mass(weights * at_places);
  membrane::DirectSolver interpolation;
  interpolation.factor(collocation_matrix(space));
  const Vec3 centre = surface::measures(space, surface).centroid;
  for (std::size_t k = 0; k < 6; ++k) loads[k] = rigid_velocity(surface, unit_motion(static_cast<int>(k)), centre);
  const std::array<Net, 6> at_sites = single_layer_at(space.collocation, space, surface, loads, quadrature);
  const std::array<Net, 6> everywhere = single_layer_at(places, space, surface, loads, quadrature);
  for (std::size_t k = 0; k < 6; ++k) loads[k] = mass.solve(weights * (everywhere[k] - at_places * interpolation.solve(at_sites[k])));

  const int n = space.n_points;
  if (n > most_points) return;
  Eigen::SparseMatrix<double> identity(n, n);
  identity.setIdentity();
  const Eigen::MatrixXd projected = weighted_double_layer(places, weights, space, surface, quadrature);
  const Eigen::MatrixXd collocated = weighted_double_layer(space.collocation, identity, space, surface, quadrature);
  density.resize(3 * n, 3 * n);
  for (int column = 0; column < 3 * n; ++column) {
    const auto field = [&](const Eigen::MatrixXd& of) { return Eigen::Map<const Net>(of.col(column).data(), n, 3); };
    const Net lacks = mass.solve(field(projected)) - interpolation.solve(Net(field(collocated)));
    density.col(column) = Eigen::Map<const Eigen::VectorXd>(lacks.data(), lacks.size());
  }
}

}  // namespace tanktread::coupling
