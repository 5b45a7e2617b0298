#pragma once
// What DenseFactors does, on plain arrays. Matrices are stored by columns.

namespace tanktread {

/// Puts the factors L (with ones on the diagonal) and U of P A in the place of A of shape (n, n); row i of A is row row_of[i] of P A.
void factor(int n, double* a, int* row_of);

/// x = U^-1 L^-1 x for the columns of x, shape (n, columns).
void solve_triangles(int n, const double* factors, int columns, double* x);

}  // namespace tanktread
