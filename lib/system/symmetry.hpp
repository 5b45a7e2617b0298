#pragma once
// Which symmetries a scene has, so that only a part of it needs to be solved.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "deck/forward.hpp"
#include "membrane/load.hpp"
#include "membrane/symmetric_solver.hpp"
#include "spline/space.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "surface/symmetry.hpp"
#include "surface/tube_wall.hpp"

namespace tanktread::coupling {

/// `Symmetry/*` of the deck.
struct SymmetryOptions {
  std::string use = "auto";  ///< or none

  void declare(deck::Section& section);
};

/// Whether v(c + S y) = S v(c + y), with S = diag(signs) and c the middle of the net, at its control points, gradients included.
bool keeps(const stokes::AmbientFlow& flow, const surface::Image& image, const Net& net);

using LoadList = std::vector<std::shared_ptr<membrane::Load>>;

/// Returns the reflections that flow, in every direction that it takes, loads, the normal of a plane wall, space and all nets have in common, or only
/// the identity if the options ask for that. What else bounds the fluid has to be looked at here too.
surface::Symmetry symmetry(const SymmetryOptions& options, const spline::Space& space, std::span<const Net* const> nets,
                           const stokes::AmbientFlow& flow, const LoadList& loads = {}, const Vec3& wall_normal = Vec3::Zero());

/// The same in a channel: mirror planes and half turns that leave its wall as it is.
surface::Symmetry symmetry(const SymmetryOptions& options, const spline::Space& space, std::span<const Net* const> nets,
                           const surface::TubeWall& wall, const LoadList& loads = {});

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
