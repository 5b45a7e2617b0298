#pragma once
// Forces by which a membrane is held or pulled, as by beads in optical tweezers.

#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "deck/forward.hpp"
#include "membrane/load.hpp"
#include "spline/space.hpp"

namespace tanktread::membrane {

/// A force on the patch of a membrane that a cylinder cuts out of its unstressed surface, about the ray from the centroid in a direction:
/// `Membrane/forces/<name>`. It stays on the same material points and keeps its direction. Per unstressed area it is, up to a factor,
/// (1 - d^2/radius^2)^2 at the distance d from the ray.
struct PatchForce {
  std::string name;
  Vec3 direction = Vec3::Zero();  ///< of the ray, of any length
  double radius = 0;              ///< of the patch
  Vec3 force = Vec3::Zero();

  void declare(deck::Section& section);
};

/// `Membrane/forces`.
struct PatchForces {
  std::vector<PatchForce> all;

  void declare(deck::Section& section);

  Vec3 total() const;

  /// One sentence (UserError) for a patch without direction, or two on one place.
  void check() const;

  /// Their virtual work for a unit displacement of each control point, F_A = sum int N_A w dGamma_0 force (3.9), shape (N, 3), where
  /// int w dGamma_0 = 1 by the rule that is used: the rows add up to the forces to rounding. Throws UserError for a patch without membrane.
  Net virtual_work(const spline::Space& space, const Net& unstressed) const;
};

/// Patch forces as a load: their virtual work does not depend on the shape.
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
