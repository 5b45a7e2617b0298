#pragma once
// Direct sums of the contributions of all nodes at any number of targets.

#include <span>

#include "base/types.hpp"
#include "stokes/kernels/far_kernel.hpp"

namespace tanktread::stokes {

/// Compute the sums of G f (2.1) over point forces, or of the double layer (2.2) over nodes with the velocity v0[k] subtracted, at the targets k;
/// result u[3 k + c]. The result for a target is that of stokeslet_sum() or far_sum(), and does not depend on the other targets.
void far_sums(const Charges& forces, std::span<const Vec3> targets, double* u);
void far_sums(const Stresslets& nodes, std::span<const Vec3> targets, std::span<const Vec3> v0, double* u);

/// Computes a sum `kernel` that has three components per target, at the targets k; result u[3 k + c].
void kernel_sums(KernelSum kernel, const Charges& points, std::span<const Vec3> targets, double* u);

}  // namespace tanktread::stokes
