#pragma once
// The wall of a tube as a spline surface.

#include <memory>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "surface/walls/channel.hpp"
#include "surface/walls/outline.hpp"

namespace tanktread::surface {

/// Cylinder along x1 from `start` to `end`, open at both ends, with an outline as its cross-section. The surface is a tensor product of cubic
/// splines. The splines around the outline are periodic if the outline has no corners. Otherwise, each side has open splines that share no control
/// point with other sides. Along x1 the knots are open and denser around x1 = 0. The normal x_,s x x_,t points into the fluid (s along x1, t around).
///
/// Control point i n_around + k is point k of ring i. A ring is the row of control points around one cross-section. Rings ascend along x1.
/// Collocation points are Greville points; the points of the first and last ring lie on the ends of the wall. Collocation points at a corner, where
/// two sides meet, are moved away from the corner by half of the distance to the next point.
struct TubeWall {
  DuctKind kind = DuctKind::straight_tube;
  spline::Space space;
  Net net;
  Outline outline;  ///< cross-section of the wall (in a channel: at its inlet), with cubic sides
  double start = 0, end = 0;
  int n_around = 0, n_along = 0;
  double widest = 0;                       ///< approximate largest side length of the elements at x1 = 0, or where a channel is narrowest
  std::shared_ptr<const Channel> channel;  ///< channel of this wall; set if `kind` is DuctKind::channel
  /// collocation points of densities on the wall; on a wall that is not periodic, they are the collocation points of `space`
  std::vector<std::vector<spline::Site>> sites;
  std::vector<spline::Site> middles;  ///< midpoints of the elements on which densities are defined
  /// for each element of `space`, the index in `middles` of the midpoint of the density element that contains this element
  std::vector<int> middle_of;
  double period = 0;  ///< period L along x1; 0 for an open wall with two ends
  /// matrix E, which maps control values of a periodic density to control values on `space`; empty if the wall is not periodic
  Eigen::SparseMatrix<double> open_from_periodic;

  double length() const { return end - start; }
  double radius() const { return outline.radius(); }  ///< returns R_T = sqrt(area/pi)
  double axial_position(const Vec3& x) const;         ///< returns x1; in a channel, the arc length s of the centre line
};

/// Returns the wall of a straight tube over [-length/2, length/2], with the numbers of elements and the grading g given in the options: the element
/// density is proportional to 1 + (g - 1)/(1 + (x1/w)^4), where w is the larger of the tube radius R_T and `half_length`, half the length of the
/// particle.
TubeWall tube_wall(const Outline& section, const TubeOptions& options, double length, double half_length = 0);

/// Returns one period of a periodic wall with the cross-section `section`, approximately for x1 in [-period/2, period/2). It has `elements` elements
/// along x1, graded as the options require. The geometry is an open spline surface. Densities on the wall are periodic splines; the matrix E maps
/// their coefficients to control values on `space`. The ends of the wall lie at a quarter of an element of the periodic splines, so that neither a
/// collocation point nor the midpoint of an element lies on an end.
TubeWall periodic_tube_wall(const Outline& section, const TubeOptions& options, double period, int elements, double half_length = 0);

/// Returns the wall of a channel (2.31). The centre line C and the scaled axes f2 N and f3 e3 of the cross-section (N: unit normal of C; f2, f3:
/// scale factors) are interpolated by cubic splines at the channel's knots, in tensor product with the splines of the outline. `start` and `end` are
/// arc lengths along the centre line.
TubeWall channel_wall(std::shared_ptr<const Channel> channel, int azimuthal_elements);

/// Returns the length given by the options. The default is the larger of 2 pi R_T, with R_T the tube radius, and the particle's length plus 4.6 R_T
/// (the disturbance decays like exp(-4.5 x1/R_T)).
double tube_length(const TubeOptions& options, double radius, double particle_length);

/// Returns the number of elements along a period. If the options do not set this number, the elements are as dense as around a short particle in a
/// tube that is not periodic.
int elements_per_period(const TubeOptions& options, double radius, double period, double half_length);

/// Throws UserError if the particle, which extends from x1 = `first` to `last`, is closer than 1.7 tube radii to an end of the wall. At this
/// distance, the relative error due to the cut-off of the wall is about 1e-5.
void check_length(const TubeWall& wall, double first, double last);

}  // namespace tanktread::surface
