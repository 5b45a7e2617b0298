#pragma once
// Bending energy at Gauss points, its gradient and Hessian by x_,s x_,t x_,ss x_,st x_,tt. Jets are laid out as packed.hpp says.

#include "base/pack.hpp"

namespace tanktread::membrane {

/// 2 chi = div n at every Gauss point; twice the mean curvature, 2/R on a sphere.
void curvatures(int n, const Pack* jets, Pack* curvature);

/// Eb/2 int (2 chi - c0)^2 dGamma over the elements of a batch, lane by lane; `weight` of the Gauss rule, c0 at every point.
Pack bending_energy(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets);

/// p = its gradient by the jets.
void bending_stresses(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, Pack* p);

/// p = its Hessian at `jets` times u.
void bending_apply(double modulus, int n, const double* weight, const Pack* c0, const Pack* jets, const Pack* u, Pack* p);

}  // namespace tanktread::membrane
