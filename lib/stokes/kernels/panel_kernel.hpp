#pragma once
// Conversion of control points to Bezier points and to values at the far nodes, for one panel at a time, on plain arrays.

namespace tanktread::stokes {

/// Computes the Bezier points of a panel from the control points `net`: bezier[n_b c + b] = sum_A extraction[n_b A + b] net[3 points[A] + c], with
/// the basis functions A = 0 .. functions - 1 of the panel.
void extract(int n_b, int functions, const int* points, const double* extraction, const double* net, double* bezier);

/// Computes the values of a Bernstein expansion at n points k: value[k] = sum_b table[n b + k] coefficient[b]. `table`: values of the n_b
/// polynomials.
void combine(int n_b, int n, const double* table, const double* coefficient, double* value);

/// Computes the Gauss weight gauss[k] times the vector product of the tangents a1, a2 at n nodes k. Component c of a1 is tangents[n c + k], and
/// component c of a2 is tangents[n (3 + c) + k].
void weigh_normals(int n, const double* tangents, const double* gauss, double* nx, double* ny, double* nz);

/// Sets within[k] to 1 if the squared distance of the point (x[k], y[k], z[k]) from the target is below reach[k], and to 0 otherwise, k = 0 .. n - 1.
void mark_within(int n, const double* x, const double* y, const double* z, const double* reach, const double* target, char* within);

}  // namespace tanktread::stokes
