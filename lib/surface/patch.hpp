#pragma once
// A Bezier element with its points in space.

#include <array>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "spline/basis.hpp"
#include "surface/bezier_points.hpp"

namespace tanktread::surface {

/// View of the Bezier points of one element of degree p, stored as a (3, (p+1)^2) array: all x1, then all x2, then all x3. The index along s runs
/// fastest.
struct Patch {
  int degree = 3;
  const double* points = nullptr;

  int n_bezier() const { return (degree + 1) * (degree + 1); }
  double coordinate(int c, int b) const { return points[c * n_bezier() + b]; }
};

/// Position and its derivatives up to second order with respect to the local coordinates s and t, from 0 to 1.
struct Jet {
  Vec3 x, s, t, ss, st, tt;
};
Jet jet(const Patch& patch, double s, double t);

/// One coordinate and its derivatives, as in Jet.
struct CoordinateJet {
  double x, s, t, ss, st, tt;
};
CoordinateJet jet(const Patch& patch, int c, double s, double t);

/// Returns |x_,s x x_,t|.
double jacobian(const Jet& jet);

/// Returns the position only.
Vec3 position(const Patch& patch, double s, double t);

/// Returns the mean curvature chi = 1/2 div n with the outward normal n; 1/R for a sphere. Units 1/length.
double mean_curvature(const Jet& jet);

constexpr int cells = 6;  ///< number of intervals per direction of the grid on which sample() evaluates an element

/// Values at the parameters (s, t) = (i, j)/cells of an element, indexed [j][i]. sample() returns the positions at these parameters.
template <class Value>
using Grid = std::array<std::array<Value, cells + 1>, cells + 1>;
Grid<Vec3> sample(const Patch& patch);

/// Returns coordinate c (0, 1 or 2) of the positions that sample(patch) returns.
Grid<double> sample(const Patch& patch, int c);

/// The Bezier points of one element of a surface.
class ElementPoints {
 public:
  ElementPoints(const spline::Space& space, const Net& net, int element)
      : degree_(space.elements[element].degree), points_(spline::bezier_points(space.elements[element], net)) {}
  Patch patch() const { return {degree_, points_.data()}; }

 private:
  int degree_;
  spline::BezierPoints points_;
};

/// The Bezier points of all elements of a surface, or of some elements in the given order.
class Patches {
 public:
  Patches(const BezierMap& map, const Net& net);
  Patches(const BezierMap& map, const Net& net, std::span<const int> elements);
  int size() const { return static_cast<int>(patches_.size()); }
  const Patch& operator[](int element) const { return patches_[element]; }

 private:
  std::vector<double> points_;
  std::vector<Patch> patches_;
};

}  // namespace tanktread::surface
