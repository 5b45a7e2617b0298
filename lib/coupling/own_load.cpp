#include "coupling/own_load.hpp"

#include <numeric>

#include <Eigen/SparseCholesky>

#include "coupling/collocation.hpp"
#include "coupling/rigid_motion.hpp"
#include "membrane/direct_solver.hpp"
#include "stokes/layer.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {

namespace {

/// A f at sites, of each f.
std::array<Net, 6> single_layer_at(const stokes::Sites& sites, const spline::Space& space, const Net& surface, const std::array<Net, 6>& f,
                                   const quadrature::Options& quadrature) {
  std::vector<int> all(sites.size());
  std::iota(all.begin(), all.end(), 0);
  stokes::Layer layer(stokes::Layer::Kernel::single_layer, space, sites, quadrature);
  layer.place(surface);
  std::array<Net, 6> u;
  u.fill(Net(sites.size(), 3));
  for (std::size_t k = 0; k < f.size(); ++k) layer.apply(f[k], all, u[k]);
  return u;
}

}  // namespace

std::array<Net, 6> lacking_of_own_loads(const spline::Space& space, const Net& surface, const quadrature::Options& quadrature) {
  const auto [places, areas] = between_sites(space, surface);
  const Eigen::SparseMatrix<double> at_places = value_matrix(space, places);
  const Eigen::SparseMatrix<double> weighted = at_places.transpose() * Eigen::Map<const Eigen::VectorXd>(areas.data(), at_places.rows()).asDiagonal();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> mass(weighted * at_places);
  membrane::DirectSolver interpolation;
  interpolation.factor(collocation_matrix(space));
  const Vec3 centre = surface::measures(space, surface).centroid;
  std::array<Net, 6> loads, lacking;
  for (std::size_t k = 0; k < 6; ++k) loads[k] = rigid_velocity(surface, unit_motion(static_cast<int>(k)), centre);
  const std::array<Net, 6> at_sites = single_layer_at(space.collocation, space, surface, loads, quadrature);
  const std::array<Net, 6> everywhere = single_layer_at(places, space, surface, loads, quadrature);
  for (std::size_t k = 0; k < 6; ++k) lacking[k] = mass.solve(weighted * (everywhere[k] - at_places * interpolation.solve(at_sites[k])));
  return lacking;
}

}  // namespace tanktread::coupling
