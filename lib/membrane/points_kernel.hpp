#pragma once
// What happens at the Gauss points of a batch: stored energy, its gradient and its Hessian by the tangents x_,s and x_,t; bending energy, its
// gradient and its Hessian by the jets x_,s x_,t x_,ss x_,st x_,tt; mass. Tangents and jets are laid out as packed.hpp says, `weight` is that of the
// Gauss rule.

#include "base/pack.hpp"
#include "membrane/laws.hpp"

namespace tanktread::membrane {

/// The unstressed surface at a Gauss point.
template <class Number>
struct ReferencePointOf {
  Number g11, g12, g22;  ///< contravariant metric G^ab
  Number inverse_det;    ///< 1/|G|
  Number area;           ///< Gauss weight times sqrt|G|; zero on idle lanes
};
using ReferencePoint = ReferencePointOf<Pack>;

/// Where number `field` of the five at point q of a batch lies, a lane behind the other.
inline const double* numbers(const ReferencePoint* batch, int q, int field) { return numbers(&batch->g11) + (5 * q + field) * pack_lanes(); }
inline double* numbers(ReferencePoint* batch, int q, int field) { return numbers(&batch->g11) + (5 * q + field) * pack_lanes(); }

/// The tangent at a Gauss point. With e = (a1.u1, a1.u2 + a2.u1, a2.u2) the change of the stress is dS = C e.
template <class Number>
struct TangentPointOf {
  Number a1[3], a2[3];                  ///< tangents of the linearisation
  Number s11, s12, s22;                 ///< stress S^ab, weights included: p_a = S^ab a_b
  Number c11, c12, c13, c22, c23, c33;  ///< moduli C, weights included
};
using TangentPoint = TangentPointOf<Pack>;

/// The reference from its tangents; `used` of the lanes hold elements.
void reference_points(int n, int used, const Pack* a, const double* weight, ReferencePoint* reference);

/// int Psi over the elements of a batch, lane by lane.
void energy(const Law& law, int n, const ReferencePoint* reference, const Pack* a, Pack* energy);

/// p = dE/da at every Gauss point, in the layout of a:  p_a = S^ab a_b,
///
///   S^ab = 2 area (Psi_1 G^ab + Psi_2 J_s^2 g^ab) = area J_s tau^ab                    (3.2), (3.6)
void stresses(const Law& law, int n, const ReferencePoint* reference, const Pack* a, Pack* p);

/// At every Gauss point the smaller principal tension, and the present area that stands for the point.
void smaller_tensions(const Law& law, int n, const ReferencePoint* reference, const Pack* a, Pack* tension, Pack* area);

void tangent_points(const Law& law, int n, const ReferencePoint* reference, const Pack* a, TangentPoint* tangent);

/// The moduli of the viscous stress (3.10) in place of the elastic ones, without a stress of its own: apply() then makes p_a = J tau^ab a_b of the
/// velocity's gradients.
void viscous_points(const SurfaceViscosity& viscosity, int n, const ReferencePoint* reference, const Pack* a, TangentPoint* tangent);

/// p = d^2E/da^2 u, for displacement gradients u in the layout of a.
void apply(int n, const TangentPoint* tangent, const Pack* u, Pack* p);

/// 2 chi = div n at every Gauss point; twice the mean curvature, 2/R on a sphere.
void curvatures(int n, const Pack* jets, Pack* curvature);

/// Eb/2 int (2 chi - c0)^2 dGamma over the elements of a batch, lane by lane, c0 at every point.
void bending_energy(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, Pack* energy);

/// p = its gradient by the jets.
void bending_stresses(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, Pack* p);

/// p = its Hessian at `jets` times u.
void bending_apply(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, const Pack* u, Pack* p);

/// entries[pair] = sum_q weight_q N_A N_B for all A, B <= A in the order (0,0), (1,0), (1,1), (2,0), …; n: Gauss points.
void mass_entries(int functions, int n, const Pack* values, const Pack* weight, Pack* entries);

/// Gauss weights times J = |x_,s x x_,t|.
void area_weights(int n, const Pack* a, const double* weight, Pack* area);

}  // namespace tanktread::membrane
