#pragma once
// The wall of a tube as a spline surface.

#include <memory>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "surface/channel.hpp"
#include "surface/outline.hpp"

namespace tanktread::surface {

/// An outline drawn along x1 from `start` to `end`, open there: cubic splines around (periodic, or open ones between corners, where nothing is
/// shared) times open cubic knots along, denser around x1 = 0. The normal x_,s x x_,t (s along x1, t around) points into the fluid.
///
/// Control point i n_around + k is number k of ring i; rings ascend along x1. Collocation points are Greville points, those of the first and last
/// ring on the rims; the ones at a corner are moved away from it by half of the first spacing, for two sides meet there.
struct TubeWall {
  spline::Space space;
  Net net;
  Outline outline;  ///< of the wall itself, of a channel at its inlet: cubic sides
  double start = 0, end = 0;
  int n_around = 0, n_along = 0;
  double widest = 0;  ///< the larger side of the largest element at x1 = 0, of a channel where it is narrowest, about
  std::shared_ptr<const Channel> channel;  ///< that this is the wall of; none: a straight tube
  std::vector<std::vector<spline::Site>> sites;  ///< collocation points of densities; of an open wall those of the space
  std::vector<spline::Site> middles;             ///< of the elements of densities
  std::vector<int> middle_of;                    ///< number of the middle for each element of the space
  double period = 0;                             ///< L, after which it repeats along x1; 0: it is open, with two ends
  Eigen::SparseMatrix<double> open_from_periodic;  ///< E: control values on the space from those of a periodic density; of an open wall empty

  double length() const { return end - start; }
  double radius() const { return outline.radius(); }  ///< R_T
};

/// The wall of a section over [-length/2, length/2], with the elements and the grading of the options: density 1 + (g - 1)/(1 + (x1/w)^4), w = R_T
/// or `half_length` of the particle where that is more.
TubeWall tube_wall(const Outline& section, const TubeOptions& options, double length, double half_length = 0);

/// One period [-period/2, period/2) of the wall of a section, about, with this number of elements along it and the grading of the options. Its
/// geometry is an open spline surface, on which densities are periodic splines: (control values on the space) = E (those of the density). The seam is
/// inside of an element, at a quarter of it, so that neither a collocation point nor the middle of an element lies on it.
TubeWall periodic_tube_wall(const Outline& section, const TubeOptions& options, double period, int elements, double half_length = 0);

/// The wall of a channel: (C, f2 N, f3 e3) interpolated by cubic splines at the channel's knots, times the outline. `start` and `end` count along its
/// centre line.
TubeWall channel_wall(std::shared_ptr<const Channel> channel, int azimuthal_elements);

/// The length that the options ask for: by default 2 pi R_T, or the particle's length and 4.6 R_T where that is more (the disturbance
/// decays like exp(-4.5 x1/R_T)).
double tube_length(const TubeOptions& options, double radius, double particle_length);

/// Number of elements along a period: those of the options, or as dense as those around a short particle in a tube that does not repeat.
int elements_per_period(const TubeOptions& options, double radius, double period, double half_length);

/// Throws UserError when the particle, from x1 = `first` to `last`, is closer than 1.7 R_T to an end of the wall: what is neglected
/// there is 1e-5 at 1.7 R_T.
void check_length(const TubeWall& wall, double first, double last);

}  // namespace tanktread::surface
