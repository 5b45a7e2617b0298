#pragma once
// The volume constraint of deformable particles in the coupled system.

#include <algorithm>
#include <optional>
#include <span>

#include "system/system.hpp"
#include "system/volumes.hpp"

namespace tanktread::coupling {

/// Volumes do not change: b.v = 0 (2.8). The multipliers are eliminated by the projection P = 1 - c b^T/(b.c), or are unknowns pi, which add pi c to
/// the rows of the velocity.
class VolumeConstraint : public Equation {
 public:
  /// `unknowns`: layout with the block of the multipliers; null if they are eliminated. `volumes` must outlive this object.
  VolumeConstraint(const VolumeProjection& volumes, const Layout* unknowns) : volumes_(volumes) {
    if (unknowns) multipliers_ = unknowns->id(name, -1);
  }
  static Block unknowns(std::span<const Particle> particles) {
    const Eigen::Index n = std::ranges::count_if(particles, [](const Particle& one) { return !one.rigid; });
    return {.name = name, .rows = n, .components = 1, .parity = Parity::scalar};
  }

  std::string plan() const override { return multipliers_ ? "volumes, by multipliers" : "volumes, whose multipliers are eliminated by a projection"; }
  void project(BlockVector& x) const override;
  void add_residual(const BlockVector& x, const Sources& from, const SurfaceVelocity& u, Given given, BlockVector& r) const override;
  void precondition(const BlockVector& r, BlockVector& x) const override;

 private:
  static constexpr const char* name = "multipliers of the volumes";

  const VolumeProjection& volumes_;
  std::optional<BlockId> multipliers_;
};

}  // namespace tanktread::coupling
