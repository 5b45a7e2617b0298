#pragma once
// Points of a tube's wall at which the velocity is prescribed, and the weighted means over these points that form the rows of the linear system.

#include <functional>
#include <span>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "stokes/layer.hpp"
#include "surface/geometry.hpp"
#include "surface/symmetry.hpp"
#include "surface/walls/tube_wall.hpp"
#include "system/parallel/ranks.hpp"

namespace tanktread::coupling {

/// Returns the positions of parametric points of a wall; of several sites for the same point, the first.
Net positions(const surface::TubeWall& wall, const stokes::Sites& sites);

/// Returns int N_A field dGamma over the wall for every control point A. Along the wall, the map s = 3 q^2 - 2 q^3 moves the Gauss points q towards
/// both ends of each element, because the inlet integral (2.13) is steep at the rim of the inlet.
Net wall_integrals(const surface::TubeWall& wall, const std::function<Vec3(const surface::Point&)>& field);

/// Collocation points of a wall, and in a channel the midpoints of elements, with their division among the ranks.
///
/// If the velocity vanishes at the collocation points of a wall, the residual velocity between these points has the same sign everywhere, so that
/// fluid leaks through the wall. In a channel this leak would be a part of the flow rate, and for a train of particles it would grow with the
/// pressure from one particle to the next. On the wall of a channel the mean velocity around each collocation point is therefore set to zero instead
/// of the velocity at the point (2.39).
class WallPoints {
 public:
  /// `symmetry`: symmetry of all fields on the wall. `phases`: if given, records the time of communication between ranks; must outlive this object.
  WallPoints(const surface::TubeWall& wall, const surface::Symmetry& symmetry, Phases* phases);

  const Net& sites() const { return sites_; }           ///< collocation points
  const std::vector<int>& own() const { return own_; }  ///< rank-owned collocation points, all of them fundamental points
  const Ranks& ranks() const { return ranks_; }         ///< division of the fundamental points among the ranks; other points are their images

  /// Returns the points at which the velocity on the wall is evaluated: the collocation points, followed in a channel by the midpoints of elements
  /// (2.39).
  const Net& targets() const { return targets_; }
  const std::vector<int>& own_targets() const { return own_targets_; }  ///< targets needed for the rows of rank-owned collocation points
  stokes::Sites target_sites(const surface::TubeWall& wall) const;      ///< parametric points of the targets

  /// Returns the right-hand side of the wall's system, one row per collocation point, from the velocity u at the targets. Each rank reads only the
  /// rows own_targets() of u. Collective.
  Net collocated(const Net& u) const;

  /// Assembles an operator for the linear system of the wall, three rows for each of the collocation points `sites`. `assemble` computes the rows of
  /// the operator at given targets. In a channel, the rows at a collocation point are the weighted mean (2.39) of the rows at this point and at the
  /// adjacent midpoints of elements. collocated() forms the same mean of velocities.
  template <class Real>
  void collocate(std::span<const int> sites, const std::function<void(std::span<const int> targets, stokes::Rows<Real>& rows)>& assemble,
                 stokes::Rows<Real>& rows) const;

 private:
  double share_of_middle(int site) const;

  Net sites_, targets_;
  std::vector<int> own_, own_targets_;
  Ranks ranks_;
  std::vector<std::vector<int>> middles_;  // for each collocation point, the targets that are midpoints of adjacent elements; empty outside channels
};

}  // namespace tanktread::coupling
