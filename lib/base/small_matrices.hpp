#pragma once
// Decompositions of three by three matrices, compiled once.

#include "base/types.hpp"

namespace tanktread {

/// exp(A).
Mat3 exponential(const Mat3& a);

/// The largest real part of the eigenvalues.
double largest_growth_rate(const Mat3& a);

/// The largest singular value.
double largest_stretch(const Mat3& a);

/// The rotation nearest to a matrix; to the sum of y r^T, the one that takes places r nearest to places y (Kabsch 1976).
Mat3 nearest_rotation(const Mat3& a);

}  // namespace tanktread
