#pragma once
// Small vectors and control nets. Lengths are in the unit of length of the deck unless stated otherwise.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "base/versions.hpp"

namespace tanktread {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Control net, or a vector field on it: one contiguous row (x1, x2, x3) per control point. Shape (N, 3).
using Net = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Returns the inner product sum_ij a_ij b_ij. Returns 0 if a or b is empty: fields that a scene does not have are empty nets.
inline double dot(const Net& a, const Net& b) { return a.size() == 0 || b.size() == 0 ? 0 : a.cwiseProduct(b).sum(); }

/// Returns the cross product a_1 b_2 - a_2 b_1 of two vectors in a plane.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Returns whether two nets have equal numbers of rows and equal entries.
inline bool same(const Net& a, const Net& b) { return a.rows() == b.rows() && a == b; }

/// Return the components of a net as one vector, row by row, and the net with the components `numbers`. The results are views of the arguments.
inline Eigen::Map<const Eigen::VectorXd> flat(const Net& net) { return {net.data(), net.size()}; }
inline Eigen::Map<const Net> as_net(const Eigen::Ref<const Eigen::VectorXd>& numbers) { return {numbers.data(), numbers.size() / 3, 3}; }

/// Returns the axial vector (m_32 - m_23, m_13 - m_31, m_21 - m_12) of a matrix: the curl of a vector field with the gradient m_ij = dv_i/dx_j, or
/// the torque of a force density f with the first moment m_ij = int f_i r_j dGamma.
inline Vec3 axial_vector(const Mat3& m) { return {m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)}; }

}  // namespace tanktread
