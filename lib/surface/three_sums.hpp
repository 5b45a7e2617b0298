#pragma once
// Innermost loop of the evaluation of Bezier points and positions on an element from control points.

namespace tanktread::surface {

/// Computes three weighted sums of rows of n numbers: out[c n + k] = sum_r factors[c n_rows + r] rows[r n + k] for c = 0, 1, 2 and k = 0 .. n - 1.
/// The terms are always added in the order r = 0, 1, ....
void three_sums(int n, int n_rows, const double* rows, const double* factors, double* out);

}  // namespace tanktread::surface
