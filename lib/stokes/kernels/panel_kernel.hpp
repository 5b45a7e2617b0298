#pragma once
// Control points -> Bezier points -> values at the far nodes, one panel at a time, on plain arrays.

namespace tanktread::stokes {

/// bezier[n_b c + b] = sum_A extraction[n_b A + b] net[3 points[A] + c], A = 0 .. functions - 1.
void extract(int n_b, int functions, const int* points, const double* extraction, const double* net, double* bezier);

/// value[k] = sum_b table[n b + k] coefficient[b], k = 0 .. n - 1.
void combine(int n_b, int n, const double* table, const double* coefficient, double* value);

/// n = gauss[k] a1 x a2, where tangents[n c + k] is component c of a1, tangents[n (3 + c) + k] of a2.
void weigh_normals(int n, const double* tangents, const double* gauss, double* nx, double* ny, double* nz);

/// within[k] = 1 where |c_k - target|^2 < reach[k], else 0, k = 0 .. n - 1.
void mark_within(int n, const double* x, const double* y, const double* z, const double* reach, const double* target, char* within);

}  // namespace tanktread::stokes
