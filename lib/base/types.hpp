#pragma once
// Small vectors and control nets. Lengths are in the unit of length of the deck unless stated otherwise.

#include <Eigen/Core>

namespace tanktread {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Control net, or a vector field on it: one contiguous row (x1, x2, x3) per control point. Shape (N, 3).
using Net = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Returns the inner product sum_ij a_ij b_ij. Returns 0 if a or b is empty: fields that a scene does not have are empty nets.
inline double dot(const Net& a, const Net& b) { return a.size() == 0 || b.size() == 0 ? 0 : a.cwiseProduct(b).sum(); }

}  // namespace tanktread
