#pragma once
// Detects the symmetries of a scene, so that only a part of it needs to be solved.

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
#include "stokes/medium/medium.hpp"
#include "stokes/medium/periodic_images.hpp"
#include "surface/symmetry.hpp"
#include "surface/walls/tube_wall.hpp"

namespace tanktread::coupling {

/// Options `Symmetry/*` of the deck.
struct SymmetryOptions {
  std::string use = "auto";  ///< "auto" or "none"

  void declare(deck::Section& section);
};

/// Returns whether the flow has the symmetry v(c + S y) = S v(c + y), where S = diag(signs) and c is the centre of the net. Compares the velocities
/// and their gradients at the control points.
bool keeps(const stokes::AmbientFlow& flow, const surface::Image& image, const Net& net);

using LoadList = std::vector<std::shared_ptr<membrane::Load>>;

/// Returns the symmetries (mirror planes, half turns, point symmetry) that the flow (in all its directions over time), the loads, the medium or a
/// plate, the lattice of a periodic cell, the space and all nets have in common. Returns only the identity if the option `use` is "none". Other
/// boundaries of the fluid, for example posts, are not checked; the caller must exclude them.
surface::Symmetry symmetry(const SymmetryOptions& options, const spline::Space& space, std::span<const Net* const> nets,
                           const stokes::AmbientFlow& flow, const LoadList& loads = {}, const stokes::Medium* medium = nullptr,
                           const std::optional<stokes::PeriodicCell>& cell = {});

/// Returns the symmetries of a scene in a channel: mirror planes and half turns that map the wall onto itself.
surface::Symmetry symmetry(const SymmetryOptions& options, const spline::Space& space, std::span<const Net* const> nets,
                           const surface::TubeWall& wall, const LoadList& loads = {});

/// Returns the velocity D x of the material points along the surface x when the unstressed surface X rotates onto itself at unit angular velocity
/// about the axis e_k (k = axis + 1) through its centre X_c. The result has control values on the points `block`, and 0 in all other rows:
///
///   D x = F (e_k x (X - X_c)),   F the deformation gradient                                                        (4.22)
///
/// This motion changes neither the shape nor the tensions. A membrane that tank-treads at the angular velocity omega around a steady shape therefore
/// has the velocity v = omega D x. Returns nothing if the unstressed surface is not a surface of revolution about the axis, or if it has a pole,
/// where F is undefined.
std::optional<Net> label_rotation(const spline::Space& space, const spline::Block& block, const Net& unstressed, const Net& x, int axis,
                                  const membrane::SymmetricSolver& collocation);

}  // namespace tanktread::coupling
