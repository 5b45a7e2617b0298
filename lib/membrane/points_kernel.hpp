#pragma once
// Kernels at the Gauss points of a batch: stored energy, its gradient and its Hessian with respect to the tangents x_,s and x_,t; bending energy, its
// gradient and its Hessian with respect to the jets x_,s x_,t x_,ss x_,st x_,tt; mass matrix entries. The layout of tangents and jets is given in
// packed.hpp. `weight` are the weights of the Gauss rule.

#include "base/pack.hpp"
#include "membrane/laws.hpp"

namespace tanktread::membrane {

/// The unstressed surface at a Gauss point.
template <class Number>
struct ReferencePointOf {
  Number g11, g12, g22;  ///< contravariant metric G^ab
  Number inverse_det;    ///< 1/|G|, inverse determinant of the covariant metric
  Number area;           ///< Gauss weight times sqrt|G|; zero on idle lanes
};
using ReferencePoint = ReferencePointOf<Pack>;

/// Returns the address of the values of component `field` (0 .. 4) at point q of a batch: one value per lane, contiguous.
inline const double* numbers(const ReferencePoint* batch, int q, int field) { return numbers(&batch->g11) + (5 * q + field) * pack_lanes(); }
inline double* numbers(ReferencePoint* batch, int q, int field) { return numbers(&batch->g11) + (5 * q + field) * pack_lanes(); }

/// The linearised stress at a Gauss point with the tangents a1, a2. The derivatives u1 = u_,s and u2 = u_,t of a displacement u cause the strain
/// e = (a1.u1, a1.u2 + a2.u1, a2.u2) and the change dS = C e of the stress.
template <class Number>
struct TangentPointOf {
  Number a1[3], a2[3];                  ///< tangents at the linearisation
  Number s11, s12, s22;                 ///< stress S^ab, weights included; the derivative of the energy with respect to the tangent a_a is S^ab a_b
  Number c11, c12, c13, c22, c23, c33;  ///< moduli C, weights included
};
using TangentPoint = TangentPointOf<Pack>;

/// Computes the metric and area (ReferencePoint) of the unstressed surface at n Gauss points from its tangents a. The first `used` lanes hold
/// elements; the area is 0 in the other lanes.
void reference_points(int n, int used, const Pack* a, const double* weight, ReferencePoint* reference);

/// Computes the strain energy int Psi dGamma_0 of each element of a batch, one element per lane.
void energy(const Law& law, int n, const ReferencePoint* reference, const Pack* a, Pack* energy);

/// Computes p = dE/da, the derivative of the strain energy E with respect to the tangents a, at every Gauss point, in the layout of a. Psi_1 and
/// Psi_2 are the derivatives of Psi with respect to I1 and I2, and J_s is the ratio of current to unstressed area: p_a = S^ab a_b,
///
///   S^ab = 2 area (Psi_1 G^ab + Psi_2 J_s^2 g^ab) = area J_s tau^ab                    (3.2), (3.6)
void stresses(const Law& law, int n, const ReferencePoint* reference, const Pack* a, Pack* p);

/// Computes the smaller principal tension at every Gauss point, and the current area associated with the point.
void smaller_tensions(const Law& law, int n, const ReferencePoint* reference, const Pack* a, Pack* tension, Pack* area);

void tangent_points(const Law& law, int n, const ReferencePoint* reference, const Pack* a, TangentPoint* tangent);

/// Stores the moduli of the viscous stress (3.10) in place of the elastic moduli, and zero stress. apply() then computes the viscous p_a = J tau^ab
/// a_b from the velocity gradients, where J is the current area that the Gauss point represents.
void viscous_points(const SurfaceViscosity& viscosity, int n, const ReferencePoint* reference, const Pack* a, TangentPoint* tangent);

/// Computes p = (d^2E/da^2) u, where a are the tangents x_,s and x_,t of the shape. `u` holds the derivatives of a displacement with respect to s and
/// t. u and p have the layout of tangents (packed.hpp).
void apply(int n, const TangentPoint* tangent, const Pack* u, Pack* p);

/// Computes 2 chi = div n at every Gauss point: twice the mean curvature, 2/R on a sphere of radius R. n: outward unit normal.
void curvatures(int n, const Pack* jets, Pack* curvature);

/// Computes the bending energy Eb/2 int (2 chi - c0)^2 dGamma of each element of a batch, one element per lane. chi is the mean curvature; the
/// spontaneous curvature c0 is given at every point.
void bending_energy(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, Pack* energy);

/// Computes p, the gradient of the bending energy with respect to the jets.
void bending_stresses(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, Pack* p);

/// Computes p = H u, where H is the Hessian of the bending energy at `jets` and u holds the jets of a displacement.
void bending_apply(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, const Pack* u, Pack* p);

/// Computes entries[pair] = sum_q weight_q N_A N_B for all pairs (A, B) of basis functions with B <= A, in the order (0,0), (1,0), (1,1), (2,0), …;
/// n: number of Gauss points.
void mass_entries(int functions, int n, const Pack* values, const Pack* weight, Pack* entries);

/// Computes the Gauss weights times J = |x_,s x x_,t|.
void area_weights(int n, const Pack* a, const double* weight, Pack* area);

}  // namespace tanktread::membrane
