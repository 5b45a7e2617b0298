#pragma once
// The innermost loop between control points, Bezier points and places on an element.

namespace tanktread::surface {

/// Three sums of rows of n numbers, out[c n + k] = sum_r factors[c n_rows + r] rows[r n + k], always in the order of the rows.
void three_sums(int n, int n_rows, const double* rows, const double* factors, double* out);

}  // namespace tanktread::surface
