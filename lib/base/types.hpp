#pragma once
// Small vectors and control nets. All lengths in the deck's unit of length, unless stated.

#include <Eigen/Core>

namespace tanktread {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// A control net, or any field on it: one row (x1, x2, x3) a control point, contiguous. Shape (N, 3).
using Net = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// sum_ij a_ij b_ij; 0 where one is empty, as of a part that the scene does not have.
inline double dot(const Net& a, const Net& b) { return a.size() == 0 || b.size() == 0 ? 0 : a.cwiseProduct(b).sum(); }

}  // namespace tanktread
