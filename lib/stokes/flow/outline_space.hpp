#pragma once
// Cubic splines along an outline, for densities that may jump or be singular at corners.

#include <array>
#include <vector>

#include "surface/outline.hpp"

namespace tanktread::stokes {

/// One element: side, range of the running parameter t, and the four functions on it,
///   N_a(t) = sum_i bernstein(a, i) B_i((t - begin)/(end - begin)).
struct OutlineElement {
  int side;
  double begin, end;
  std::array<int, 4> functions;
  Eigen::Matrix4d bernstein;
};

/// A collocation point: side, parameter t, and the element that holds it (the one that begins there, for a knot).
struct OutlineSite {
  int side;
  double t;
  int element;
};

/// Splines in a running parameter t. On a closed side t is the curve's own parameter and splines are periodic. A side between corners has t from
/// 0 to 1 with its points crowding towards both ends,
///   u = u_first + (u_last - u_first) w(t),   w = t^p/(t^p + (1 - t)^r),
/// p = 2 at the first corner where its angle is at most a right one, 3 where it is more, r likewise at the last, and splines with fourfold end
/// knots, nothing shared at the corner. Elements end at the knots of the outline's own spline, so that everything is smooth on an element.
class OutlineSpace {
 public:
  /// p and r of a side.
  struct Crowding {
    double first, last;
  };

  /// About `elements` elements, shared out by the square root of the sides' lengths, on a side even in t but for what its own knots ask for.
  OutlineSpace(const surface::Outline& outline, int elements);

  int size() const { return static_cast<int>(sites_.size()); }  ///< functions, and collocation points
  const std::vector<OutlineElement>& elements() const { return elements_; }

  /// Of a closed side the knots, of an open one the Greville abscissae with the end ones moved inwards by half the first spacing.
  const std::vector<OutlineSite>& sites() const { return sites_; }

  /// Place and derivative by t. The second derivative is not made.
  surface::PlaneJet at(int side, double t) const;

  const surface::Outline& outline() const { return outline_; }

 private:
  void add_closed(int side, const std::vector<double>& knots);
  void add_open(int side, const std::vector<double>& knots);
  void add_element(int side, double begin, double end, const std::array<int, 4>& functions, const std::array<double, 8>& knots);

  surface::Outline outline_;
  std::vector<Crowding> crowding_;  // a side each
  std::vector<OutlineElement> elements_;
  std::vector<OutlineSite> sites_;
};

}  // namespace tanktread::stokes
