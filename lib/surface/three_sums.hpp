#pragma once
// Innermost loop of the evaluation of Bezier points and positions on an element from control points.

namespace tanktread::surface {

/// Computes three weighted sums of rows of n numbers, out[c n + k] = sum_r factors[c n_rows + r] rows[r n + k], always in the order of the rows.
void three_sums(int n, int n_rows, const double* rows, const double* factors, double* out);

}  // namespace tanktread::surface
