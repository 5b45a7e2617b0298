#pragma once
// The profile of a duct of any section, by boundary elements.

#include <array>
#include <vector>

#include "stokes/flow/duct_flow.hpp"
#include "stokes/kernels/cauchy_kernel.hpp"
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

/// u = v_c - r^2/4, r the distance from the section's centroid, v_c harmonic with v_c = r^2/4 on the outline                   (P-34, P-35)
/// Its flux q = dv_c/dn is the unknown: sigma = q dl/dt, a cubic spline in the running parameter of OutlineSpace, is collocated,
///   int G sigma dt + kappa = int (v_c - v_c(x0)) dG/dn dl,   int sigma dt = 0,   G = -ln|x - x0|/(2 pi)                     (2.15)
/// Without kappa and the mean the matrix would be singular where the outline has logarithmic capacity 1, such as the circle of radius 1.
/// Inside, v_c is the real part of the analytic function F that is v_c + i psi on the outline, psi = int q dl (2.17).
///   int u dA = int r^2 x.n/16 dl + int psi x/2.dx                                                                              (2.16)
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
  std::vector<double> x_, y_, dx_, dy_, f_, g_;  // nodes of (2.17), about the centroid
};

}  // namespace tanktread::stokes
