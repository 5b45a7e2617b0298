#pragma once
// Forces that hold or pull a membrane, such as the forces of beads in optical tweezers.

#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "deck/forward.hpp"
#include "membrane/load.hpp"
#include "spline/space.hpp"

namespace tanktread::membrane {

/// A force on a patch of a membrane, `Membrane/forces/<name>`. The patch is the part of the unstressed surface inside a cylinder of the given radius
/// around the ray from the centroid in the given direction. The force stays on the same material points and keeps its direction. Its density per
/// unstressed area is proportional to (1 - d^2/radius^2)^2, with d the distance from the ray.
struct PatchForce {
  std::string name;
  Vec3 direction = Vec3::Zero();  ///< direction of the ray, of any length
  double radius = 0;              ///< radius of the patch
  Vec3 force = Vec3::Zero();

  void declare(deck::Section& section);
};

/// All patch forces, `Membrane/forces`.
struct PatchForces {
  std::vector<PatchForce> all;

  void declare(deck::Section& section);

  Vec3 total() const;

  /// Throws UserError, with a one-sentence message, if a patch has no direction or two patches coincide.
  void check() const;

  /// Returns the virtual work of all forces for a unit displacement of each control point, F_A = sum int N_A w dGamma_0 force (3.9), shape (N, 3). w
  /// is the density of a force per unstressed area, divided by the force. The quadrature satisfies int w dGamma_0 = 1, so the rows add up to the
  /// total force to rounding. Throws UserError if a patch contains no membrane.
  Net virtual_work(const spline::Space& space, const Net& unstressed) const;
};

/// Load of all patch forces on a membrane. Their virtual work per displacement does not depend on the shape.
class PatchLoad : public Load {
 public:
  PatchLoad(const PatchForces& forces, const spline::Space& space, const Net& unstressed)
      : forces_(forces.all), work_(forces.virtual_work(space, unstressed)) {}

  void add_global_work(const Net& /*x*/, std::span<const Net> /*sums*/, Net& work) const override { work -= work_; }
  bool admits(const surface::Image& image) const override;
  RigidConditions rigid_conditions() const override;

 private:
  std::vector<PatchForce> forces_;
  Net work_;
};

}  // namespace tanktread::membrane
