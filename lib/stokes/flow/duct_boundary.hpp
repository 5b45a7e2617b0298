#pragma once
// The velocity profile of a duct of any cross-section, by boundary elements.

#include <array>
#include <vector>

#include "stokes/flow/duct_flow.hpp"
#include "stokes/kernels/cauchy_kernel.hpp"
#include "surface/walls/outline.hpp"

namespace tanktread::stokes {

/// One element of the outline: the side that contains it, its range of the parameter t, and its four basis functions,
///   N_a(t) = sum_i bernstein(a, i) B_i((t - begin)/(end - begin)).
struct OutlineElement {
  int side;
  double begin, end;
  std::array<int, 4> functions;
  Eigen::Matrix4d bernstein;
};

/// A collocation point: side, parameter t, and the element that contains it (for a knot the element that starts there).
struct OutlineSite {
  int side;
  double t;
  int element;
};

/// Splines in a parameter t on each side of an outline. On a closed side, t is the parameter u of the curve, and the splines are periodic. On a side
/// between corners, t runs from 0 to 1, and u(t) is graded towards both ends,
///   u = u_first + (u_last - u_first) w(t),   w = t^p/(t^p + (1 - t)^r).
/// The exponent p belongs to the first corner and r to the last corner: 2 if the angle of the corner is at most about a right angle, otherwise 3. The
/// splines on a side between corners have fourfold end knots and share no function with the next side. Elements end at the knots of the outline's
/// spline, so that all functions are smooth on an element.
class OutlineSpace {
 public:
  /// Exponents p and r of the grading function w(t) of a side, at its first and last corner.
  struct Crowding {
    double first, last;
  };

  /// Constructs about `elements` elements. The number of elements on a side is proportional to the square root of its length. Elements of a side are
  /// uniform in t, but also end at the knots of the outline's spline.
  OutlineSpace(const surface::Outline& outline, int elements);

  int size() const { return static_cast<int>(sites_.size()); }  ///< number of functions, equal to the number of collocation points
  const std::vector<OutlineElement>& elements() const { return elements_; }

  /// Returns the collocation sites: on a closed side the knots, on an open side the Greville abscissae with the end points moved inwards by half the
  /// first spacing.
  const std::vector<OutlineSite>& sites() const { return sites_; }

  /// Returns the position and its derivative with respect to t. The second derivative is not set.
  surface::PlaneJet at(int side, double t) const;

  const surface::Outline& outline() const { return outline_; }

 private:
  surface::Outline outline_;
  std::vector<Crowding> crowding_;  // one per side
  std::vector<OutlineElement> elements_;
  std::vector<OutlineSite> sites_;
};

/// Velocity u = v_c - r^2/4 (equations 34 and 35 of Maestre et al. 2017). r is the distance from the centroid of the cross-section; v_c is harmonic
/// with v_c = r^2/4 on the outline. The unknowns are the cubic spline sigma = q dl/dt with the flux q = dv_c/dn, and a constant kappa. They satisfy
/// these equations at collocation points x0 on the outline:
///   int G sigma dt + kappa = int (v_c - v_c(x0)) dG/dn dl,   int sigma dt = 0,   G = -ln|x - x0|/(2 pi)                     (2.15)
/// Without kappa and the condition int sigma dt = 0, the matrix is singular if the outline has logarithmic capacity 1, as a unit circle has.
/// Inside, v_c is the real part of the analytic function F (2.17) with the boundary values v_c + i psi, psi = int q dl. The flow rate is
///   int u dA = int r^2 x.n/16 dl + int psi/2 x.dx                                                                              (2.16)
class BoundaryProfile : public DuctProfile {
 public:
  BoundaryProfile(const surface::Outline& outline, int elements);

  void evaluate(int n, const double* x2, const double* x3, double* u, double* u2, double* u3) const override;
  double flow_rate() const override { return flow_rate_; }

  int n_elements() const { return n_elements_; }

 private:
  Eigen::VectorXd density(const OutlineSpace& space) const;
  Eigen::VectorXd add_nodes(const OutlineSpace& space, const Eigen::VectorXd& sigma);
  void sweep(const Eigen::VectorXd& flux);

  surface::Vec2 centroid_;
  double radius_, flow_rate_;
  int n_elements_;
  std::vector<double> x_, y_, dx_, dy_, f_, g_;  // values at the nodes of (2.17). x_, y_: position relative to the centroid. dx_, dy_: line element.
                                                 // f_, g_: real part v_c and imaginary part psi of F
};

}  // namespace tanktread::stokes
