#pragma once
// What relabels the material points of a membrane.

#include <optional>
#include <vector>

#include "base/types.hpp"
#include "membrane/symmetric_solver.hpp"
#include "spline/space.hpp"

namespace tanktread::coupling {

/// Control values, on points `block` of the net x, of the rates at which material points pass each other along the surface where the unstressed
/// surface turns in itself about the axis x_{axis+1} through its centre:
///
///   D x = F (e_k x (X - X_c)),   F the deformation gradient                                                        (4.22)
///
/// Tensions do not change by that, so that a membrane that treads around a steady shape moves by v = omega D x. Nothing where the unstressed surface
/// is not one that turns in itself, or has a pole, where F is not known.
std::optional<Net> label_rotation(const spline::Space& space, const spline::Block& block, const Net& unstressed, const Net& x, int axis,
                                  const membrane::SymmetricSolver& collocation);

}  // namespace tanktread::coupling
