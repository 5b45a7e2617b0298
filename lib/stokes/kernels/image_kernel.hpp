#pragma once
// What a plane no-slip wall adds to the kernels, on plain arrays. In the wall's own axes: it is z = 0, the fluid above, and targets are given where
// they are mirrored, below it.

#include "stokes/kernels/far_kernel.hpp"
#include "stokes/kernels/point_table.hpp"

namespace tanktread::stokes {

/// With a target at height z over the wall, mirrored in it to x0', nodes at height h, r = x - x0' (so that r_3 = h + z), R = I - 2 e3 e3, both vanish
/// on the wall together with G f and T S there (2.35), (2.36):
///
///   G^I f = -R G(r) f + z R grad p - e3 p,    p = 2 (f_3/r + h r.f/r^3)
///   T^I S = -R T(r) S + z R grad p - e3 p,    p = -12 (h r.S r/r^5 + tr S z/(3 r^3)),    S = (f n + n f)/2
///
/// where grad p is with respect to x0' and z of p stands for r_3 - h. As far_sum() and kernels for TreeSum otherwise: forces, or S in the order 11,
/// 22, 33, 12, 13, 23, for far_block targets.
void image_stokeslet_sum(const Charges& points, const double* target, double* value);
void image_stresslet_sum(const Charges& points, const double* target, double* value);
struct ImageStokesletKernel {
  static constexpr int in = 3, out = 3;
  static constexpr auto *sum = image_stokeslet_sum, *single = sum;  // in double always
};
struct ImageStressletKernel {
  static constexpr int in = 6, out = 3;
  static constexpr auto *sum = image_stresslet_sum, *single = sum;
};

/// Of one panel under a rule of its own, as in pair_kernel.hpp, x0 mirrored: the two sums, and the moments, moment[9 b + 3 i + j]. `scratch`: 9 packs
/// a pack of points.
void image_single_sum(const PointTable& table, const double* x, const double* f, const Pack* weight, const double* x0, double* u);
void image_double_sum(const PointTable& table, const double* x, const double* v, const double* x0, const double* v0, double* u);
void image_single_moments(const PointTable& table, const double* x, const Pack* weight, const double* x0, Pack* scratch, double* moment);
void image_double_moments(const PointTable& table, const double* x, const double* x0, Pack* scratch, double* moment);

}  // namespace tanktread::stokes
