#include "coupling/own_load.hpp"

#include <algorithm>
#include <numeric>

#include <Eigen/SparseCholesky>

#include "coupling/collocation.hpp"
#include "membrane/direct_solver.hpp"
#include "stokes/single_layer.hpp"
#include "coupling/rigid_motion.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {

namespace {

/// A f at places, of each f. The layer has as many targets as control points: the places take their turns.
std::array<Net, 6> single_layer_at(const spline::Space& space, const Net& surface, const std::array<Net, 6>& f, std::span<const spline::Site> places,
                                   const quadrature::Options& quadrature) {
  const auto n = static_cast<std::size_t>(space.n_points);
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  std::array<Net, 6> u;
  u.fill(Net(places.size(), 3));
  stokes::Rows<double> rows;
  spline::Space turn = space;
  for (std::size_t first = 0; first < places.size(); first += n) {
    const std::size_t count = std::min(n, places.size() - first);
    for (std::size_t i = 0; i < n; ++i) turn.collocation[i] = {places[first + std::min(i, count - 1)]};
    stokes::SingleLayer layer(turn, quadrature);
    layer.set_reference(surface);
    layer.assemble(surface, stokes::Measure::reference, std::span(all).first(count), rows);
    for (std::size_t k = 0; k < f.size(); ++k) {
      const Eigen::VectorXd v = rows * Eigen::Map<const Eigen::VectorXd>(f[k].data(), f[k].size());
      u[k].middleRows(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count)) =
          Eigen::Map<const Net>(v.data(), static_cast<Eigen::Index>(count), 3);
    }
  }
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
  const std::array<Net, 6> at_sites = single_layer_at(space, surface, loads, first_sites(space), quadrature);
  const std::array<Net, 6> everywhere = single_layer_at(space, surface, loads, places, quadrature);
  for (std::size_t k = 0; k < 6; ++k) lacking[k] = mass.solve(weighted * (everywhere[k] - at_places * interpolation.solve(at_sites[k])));
  return lacking;
}

}  // namespace tanktread::coupling
