#pragma once

#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::coupling {

/// The first of the sites of each control point, which all have the same value there.
std::vector<spline::Site> first_sites(const spline::Space& space);

/// N_A at places, shape (places, N).
Eigen::SparseMatrix<double> value_matrix(const spline::Space& space, std::span<const spline::Site> places);

/// Gauss points on a surface, and the share of its area that each stands for. What collocation leaves over on an element is like h^4 times a quartic:
/// as many points a direction as the degree integrate it.
struct BetweenSites {
  std::vector<spline::Site> places;
  std::vector<double> areas;
};
BetweenSites between_sites(const spline::Space& space, const Net& surface);

/// R_iA = N_A(xi_i) at the collocation sites, shape (N, N): from control values to values at the sites (4.2).
Eigen::SparseMatrix<double> collocation_matrix(const spline::Space& space);

}  // namespace tanktread::coupling
