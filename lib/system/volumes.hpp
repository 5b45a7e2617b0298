#pragma once
// Volumes of all particles, and the projection of velocities that keeps these volumes constant.

#include <functional>
#include <vector>

#include "surface/geometry.hpp"
#include "system/parallel/row_share.hpp"
#include "system/particle.hpp"

namespace tanktread::coupling {

/// The projection P = 1 - c b^T/(b.c) of (2.8), applied to each deformable particle, at one shape. Without rows, P = 1. The field c of a particle is
/// zero on all other particles. For a constraint whose multiplier causes a flow, c would have rows on all particles. The multipliers of all particles
/// would then be the solution of one linear system.
struct VolumeProjection {
  Net gradient;                       ///< b = dV/dx: the rows of each particle contain the gradient of the volume of this particle
  Net direction;                      ///< c, for example M0^-1 b: field along which velocities are corrected
  std::vector<spline::Block> blocks;  ///< rows of the deformable particles

  bool active() const { return gradient.size() > 0; }
  Eigen::VectorXd multipliers(const Net& v) const;                     ///< returns b.v / (b.c) of each deformable particle
  void subtract(const Eigen::VectorXd& multipliers, Net& v) const;     ///< subtracts from v, on each deformable particle, its multiplier times c
  void apply(Net& v) const { subtract(multipliers(v), v); }            ///< replaces the velocity v by P v, which changes no volume
  Net applied(Net v) const { apply(v); return v; }                     ///< returns P v
};

/// The volumes V of all particles and their prescribed volumes V0. Rigid bodies are excluded from all corrections. Calls with a shape are collective.
class Volumes {
 public:
  /// Stores V0 of each particle: Particle::kept_volume if set, otherwise the volume of the particle in the net `initial`. References, except
  /// `initial`, must outlive this object.
  Volumes(const spline::Space& space, const Net& initial, const std::vector<Particle>& particles, const RowShare& layout, Phases& phases);

  const surface::Geometry& geometry() const { return geometry_; }
  double error(double volume, std::size_t p) const { return volume / kept_[p] - 1; }  ///< V/V0 - 1 of particle p

  void keep(double volume, std::size_t p) { kept_[p] = volume; }  ///< prescribes the volume V0 of particle p

  /// Returns b = dV/dx, see VolumeProjection.
  Net gradient(const Net& x) const;

  /// Returns the projection with these fields b and c.
  VolumeProjection projection(Net gradient, Net direction) const;

  /// Moves x so that the volumes become V0, by Newton's method. V is a cubic form in x, so V = x.(dV/dx)/3. Sets x to NaN if the iteration fails.
  /// `along(b)`: returns the direction in which each particle is displaced to change its volume, for b = dV/dx.
  void restore(Net& x, const std::function<Net(const Net& b)>& along) const;

 private:
  const std::vector<Particle>& particles_;
  const RowShare& layout_;
  Phases& phases_;
  surface::Geometry geometry_;
  std::vector<double> kept_;  // V0 of each particle
};

}  // namespace tanktread::coupling
