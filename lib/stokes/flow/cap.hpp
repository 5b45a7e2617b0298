#pragma once
// The open ends of a tube.

#include <vector>

#include "base/types.hpp"
#include "surface/walls/outline.hpp"

namespace tanktread::stokes {

/// A plane cap across a tube at x1 = `place`. The traction on it is -p e1 with a constant p, and its single layer (2.1) is -p c with the integral
///
///   c(x0) = 1/(8 pi) int G(x, x0) e1 dS                                                                         (2.13)
///
/// Computes c by a line integral over the outline, which is exact for any cross-section. With rho = (x - x0) in the plane, the outward normal nu of
/// the outline in the plane, h = place - x0_1 and r^2 = rho^2 + h^2,
///
///   8 pi c_1 = oint rho.nu / r dl,    8 pi c_a = -h oint nu_a / r dl,   a = 2, 3.
///
/// The value c_j(y)/mu is, by reciprocity, also the flow rate along x1 through the cap due to a unit point force e_j at y.
class Cap {
 public:
  /// `tolerance`: error of the integrals relative to their largest value.
  Cap(const surface::Outline& outline, double place, double tolerance);

  double place() const { return place_; }

  /// Returns the integral c (2.13) at any point, including points on the rim of the cap. Units length.
  Vec3 integral(const Vec3& x0) const;

  /// Returns the integral c (2.13) at the rows of x; fast for points off the plane of the cap.
  Net integral(const Net& x) const;

  /// Returns the flow rate along x1 through the cap due to a double-layer point singularity at y with normal n, for each component j of its strength:
  /// int T_1jk(y, x) n_k dS(x)/(8 pi). Only for points off the plane of the cap.
  Vec3 double_layer_flow(const Vec3& y, const Vec3& n) const;

  /// Returns the flow rate of the field c (2.13) through the cap, along x1: int c_1 dS over the cap.
  double own_flow() const;

 private:
  struct Nodes {
    std::vector<double> y, z, ny, nz;  ///< positions, and normals times weights dl
  };
  Nodes nodes(int order) const;
  const Nodes& nodes_for(double distance) const;

  surface::Outline outline_;
  double place_, reach_ = 0;                     ///< place_: coordinate x1 of the cap. reach_: half the length of the longest curve segment of the
                                                 ///< outline
  std::vector<std::pair<double, Nodes>> rules_;  ///< for each rule, the smallest distance from the plane at which it is used, and its nodes
};

}  // namespace tanktread::stokes
