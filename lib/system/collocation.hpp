#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "stokes/sums/self_field.hpp"

namespace tanktread::coupling {

/// N_A at sites, shape (sites, N).
Eigen::SparseMatrix<double> value_matrix(const spline::Space& space, const stokes::Sites& sites);

/// Gauss points q on a surface, for what collocation leaves over: on an element like h^4 times a quartic, which as many points a direction as the
/// degree integrate.
struct BetweenSites {
  stokes::Sites places;
  Eigen::SparseMatrix<double> values;   ///< N_A at them, shape (places, N)
  Eigen::SparseMatrix<double> weights;  ///< N_A(q) times the share of the area that q stands for, shape (N, places)
};
BetweenSites between_sites(const spline::Space& space, const Net& surface);

/// R_iA = N_A(xi_i) at the collocation sites, shape (N, N): from control values to values at the sites (4.2).
Eigen::SparseMatrix<double> collocation_matrix(const spline::Space& space);

}  // namespace tanktread::coupling
