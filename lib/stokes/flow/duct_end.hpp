#pragma once
// The open ends of a channel, where its flow equals the flow of a straight duct.

#include <vector>

#include "base/types.hpp"
#include "stokes/flow/duct_flow.hpp"
#include "surface/walls/channel.hpp"

namespace tanktread::stokes {

/// Velocity in the fluid due to a plane end of a channel, without the contribution of the pressure at the end. The duct flow u(y2, y3) passes through
/// the end in the direction `along`:
///
///   P_i(x0) = -1/(8 pi) int G_ij(x, x0) (n.along) u_,a (e_a)_j dS + 1/(8 pi) int u along_j T_ijk(x, x0) n_k dS,   a = 2, 3  (2.29)
///
/// where n points into the fluid and e_a are the axes of the cross-section. Velocity and traction of the duct flow are exact. The plane is integrated
/// by Gauss points on rays from the centroid, with cells that are halved near a close target.
class DuctEnd {
 public:
  /// `place`: position and axes of the end's cross-section. `flow`: flow of the straight duct with this cross-section. `inward`: 1 if the direction
  /// `place.along` points into the fluid (inlet), -1 otherwise (outlet). Throws UserError if a ray from the centroid of the cross-section meets its
  /// outline twice.
  DuctEnd(DuctFlow flow, const surface::Channel::Section& place, int inward);

  /// Returns the velocity (2.29) that the end causes at each row of x, a point in the fluid or on the wall. Units length/time.
  Net velocities(const Net& x) const;

  /// Gauss points of the cross-section: positions and areas.
  struct Points {
    Net x;
    Eigen::VectorXd area;
  };
  Points points() const;

  const DuctFlow& flow() const { return flow_; }

 private:
  /// Part of the cross-section: the rays from the centroid to the points t[0] .. t[1] (curve parameter) of one side, over the fractions r[0] .. r[1]
  /// of their length.
  struct Cell {
    int side;
    double t[2], r[2];
  };
  struct Nodes {
    std::vector<double> y[2], area;
  };
  void add(const Cell& cell, int order, Nodes& nodes) const;
  void add_graded(const Cell& cell, const Vec3& at, Nodes& nodes) const;
  surface::Vec2 ray(const Cell& cell, double t, double r) const;
  struct Sources {
    std::vector<double> x[3], force[3], velocity[3], normal[3];
  };
  Sources sources(const Nodes& nodes) const;
  static void add(const Sources& sources, const Vec3& target, Eigen::Ref<Eigen::Matrix<double, 1, 3>> u);
  bool close(const Cell& cell, const Vec3& at, bool& around) const;
  std::vector<Cell> cells(int around) const;

  DuctFlow flow_;
  surface::Channel::Section place_;
  double inward_;
  double arm_ = 0;  // largest distance of the outline from its centroid
  Sources far_;
  std::vector<Cell> cells_;
  std::vector<Sources> close_;  // for each cell, its nodes as sources, for targets close to the plane of the end but not to the cell
};

}  // namespace tanktread::stokes
