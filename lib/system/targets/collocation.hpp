#pragma once
// Values of splines at collocation sites and between them.

#include <span>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "spline/basis.hpp"
#include "spline/space.hpp"
#include "stokes/sums/self_field.hpp"

namespace tanktread::coupling {

/// Returns the matrix of the basis functions N_A at the sites, shape (sites, N). `which` selects their values or derivatives.
Eigen::SparseMatrix<double> value_matrix(const spline::Space& space, const stokes::Sites& sites,
                                         Eigen::VectorXd spline::Basis::* which = &spline::Basis::value);

/// Gauss points q on a surface, to integrate the residual of collocation. The residual is zero only at the collocation sites. On an element of size h
/// it is about h^4 times a quartic polynomial. The number of Gauss points per direction is the spline degree, which is enough to integrate this
/// polynomial exactly.
struct BetweenSites {
  stokes::Sites sites;                  ///< parametric points q
  Eigen::SparseMatrix<double> values;   ///< N_A at the points, shape (points, N)
  Eigen::SparseMatrix<double> weights;  ///< N_A at point q times the quadrature weight and area element of q, shape (N, points)
};
BetweenSites between_sites(const spline::Space& space, const Net& surface);
BetweenSites between_sites(const spline::Space& space, const Net& surface, std::span<const spline::Block> blocks);  ///< points on `blocks` only

/// Returns the product of a matrix of three columns per control point and the matrix `map` of control values, for example from a periodic spline to
/// one that is not periodic.
template <class Rows>
Rows columns_of(const Eigen::SparseMatrix<double>& map, const Rows& rows) {
  using Real = typename Rows::Scalar;
  using RealNet = Eigen::Matrix<Real, Eigen::Dynamic, 3, Eigen::RowMajor>;
  Rows product(rows.rows(), 3 * map.cols());
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    const Net of_row = Eigen::Map<const RealNet>(rows.row(r).data(), map.rows(), 3).template cast<double>();
    Eigen::Map<RealNet>(product.row(r).data(), map.cols(), 3) = Net(map.transpose() * of_row).template cast<Real>();
  }
  return product;
}

/// Returns R_iA = N_A(xi_i) at the collocation sites, shape (N, N): maps control values to values at the sites (4.2).
Eigen::SparseMatrix<double> collocation_matrix(const spline::Space& space);

}  // namespace tanktread::coupling
