#pragma once
// Conversion of control points to Bezier points and to values at the far nodes, for one panel at a time, on plain arrays.

namespace tanktread::stokes {

/// Computes bezier[n_b c + b] = sum_A extraction[n_b A + b] net[3 points[A] + c], A = 0 .. functions - 1.
void extract(int n_b, int functions, const int* points, const double* extraction, const double* net, double* bezier);

/// Computes value[k] = sum_b table[n b + k] coefficient[b], k = 0 .. n - 1.
void combine(int n_b, int n, const double* table, const double* coefficient, double* value);

/// Computes the weighted normals gauss[k] a1 x a2 at n nodes k. Component c of the tangent a1 is tangents[n c + k], and of a2 tangents[n (3 + c) +
/// k].
void weigh_normals(int n, const double* tangents, const double* gauss, double* nx, double* ny, double* nz);

/// Sets within[k] to 1 if the squared distance of the point (x[k], y[k], z[k]) from the target is below reach[k], and to 0 otherwise, k = 0 .. n - 1.
void mark_within(int n, const double* x, const double* y, const double* z, const double* reach, const double* target, char* within);

}  // namespace tanktread::stokes
