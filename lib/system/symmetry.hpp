#pragma once
// Which symmetries a scene has, so that only a part of it needs to be solved.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "membrane/load.hpp"
#include "spline/space.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "surface/symmetry.hpp"
#include "surface/tube_wall.hpp"

namespace tanktread::deck {
class Section;
}

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

}  // namespace tanktread::coupling
