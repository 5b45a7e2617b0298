#pragma once
// Kernels for one target and one panel with a panel-specific quadrature rule. Component c of Bezier point b of a panel is stored at index n_b c + b.

#include "stokes/kernels/point_table.hpp"

namespace tanktread::stokes {

/// Computes weight[k], the weight of the quadrature rule times the area element |x_,s x x_,t|, for every pack k of points. `bezier`: Bezier points of
/// the panel.
void area_weights(const PointTable& table, const double* bezier, Pack* weight);

/// Computes u[3] = sum_q G(x_q, x0) f_q weight_q (2.1) over the points q of the rule. x, f: Bezier points of the panel and of the density.
void single_sum(const PointTable& table, const double* x, const double* f, const Pack* weight, const double* x0, double* u);

/// Computes moment[6 b + c] = sum_q G_c(x_q, x0) B_b(q) weight_q over the points q of the rule, with the Bernstein polynomials B_b and G_c = G_11,
/// G_12, G_13, G_22, G_23, G_33. `scratch`: 6 packs per pack of points.
void single_moments(const PointTable& table, const double* x, const Pack* weight, const double* x0, Pack* scratch, double* moment);

/// Computes u_i = sum_q (v_q - v0)_j T_ijk(x_q, x0) n_k weight_q (2.2) over the points q of the rule, where n weight_q is the weight of the rule
/// times the vector product of the tangents x_,s and x_,t.
void double_sum(const PointTable& table, const double* x, const double* v, const double* x0, const double* v0, double* u);

/// Computes moment[6 b + c] = sum_q (T_ijk n_k)_c B_b(q) weight_q as single_moments(), where c = 0 .. 5 numbers the entries ij = 11, 12, 13, 22, 23,
/// 33.
void double_moments(const PointTable& table, const double* x, const double* x0, Pack* scratch, double* moment);

}  // namespace tanktread::stokes
