#pragma once
// Functions of 3 x 3 matrices. They are not inline, so that the matrix decompositions are compiled only once.

#include "base/types.hpp"

namespace tanktread {

/// Returns exp(A).
Mat3 exponential(const Mat3& a);

/// Returns the largest real part of the eigenvalues of a: the largest growth rate of x in dx/dt = a x.
double largest_growth_rate(const Mat3& a);

/// Returns the largest singular value.
double largest_stretch(const Mat3& a);

/// Returns the rotation nearest to a matrix. If the matrix is the sum over all points of y r^T, this is the rotation that best maps the positions r
/// to the positions y in the least-squares sense (Kabsch 1976).
Mat3 nearest_rotation(const Mat3& a);

/// Returns the rotation that best maps the points `from`, relative to their mean, to the points `to`, relative to their mean.
Mat3 rotation_between(const Net& from, const Net& to);

}  // namespace tanktread
