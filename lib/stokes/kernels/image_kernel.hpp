#pragma once
// Contribution of a plane no-slip wall to the kernels, on plain arrays. Positions are in the wall's axes: the wall is the plane z = 0 with the fluid
// above it. Targets are given by their mirror images below the wall.

#include "stokes/kernels/far_kernel.hpp"
#include "stokes/kernels/point_table.hpp"

namespace tanktread::stokes {

/// Compute the sums of G^I f or T^I S over the nodes. The sums G f + G^I f and T S + T^I S vanish on the wall (2.35), (2.36). The target is at the
/// height z above the wall and has the mirror image x0'. The node x is at the height h. r = x - x0' (so that r_3 = h + z), and R = I - 2 e3 e3:
///
///   G^I f = -R G(r) f + z R grad p - e3 p,    p = 2 (f_3/r + h r.f/r^3)
///   T^I S = -R T(r) S + z R grad p - e3 p,    p = -12 (h r.S r/r^5 + tr S z/(3 r^3)),    S = (f n + n f)/2
///
/// where grad p is the gradient with respect to x0' after z in p has been replaced by r_3 - h. The arguments have the layout of stokeslet_sum() and
/// stresslet_sum(): forces f, or S in the order 11, 22, 33, 12, 13, 23, and far_block targets.
void image_stokeslet_sum(const Charges& points, const double* target, double* value);
void image_stresslet_sum(const Charges& points, const double* target, double* value);
struct ImageStokesletKernel {
  static constexpr int in = 3, out = 3;
  static constexpr auto* sum = image_stokeslet_sum;
};
struct ImageStressletKernel {
  static constexpr int in = 6, out = 3;
  static constexpr auto* sum = image_stresslet_sum;
};

/// Compute the velocity u at a target due to the image of one panel in the wall (single or double layer), or the moments of this image, by a
/// quadrature rule specific to the panel. moment[9 b + 3 i + j] is the integral over the panel of entry i, j of the image kernel times Bernstein
/// polynomial b. The arguments are those of pair_kernel.hpp, except that x0 is the mirror image of the target. `scratch`: 9 packs per pack of points.
void image_single_sum(const PointTable& table, const double* x, const double* f, const Pack* weight, const double* x0, double* u);
void image_double_sum(const PointTable& table, const double* x, const double* v, const double* x0, const double* v0, double* u);
void image_single_moments(const PointTable& table, const double* x, const Pack* weight, const double* x0, Pack* scratch, double* moment);
void image_double_moments(const PointTable& table, const double* x, const double* x0, Pack* scratch, double* moment);

}  // namespace tanktread::stokes
