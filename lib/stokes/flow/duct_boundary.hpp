#pragma once
// The profile of a duct of any section, by boundary elements.

#include "stokes/flow/duct_flow.hpp"
#include "stokes/flow/outline_space.hpp"
#include "stokes/kernels/cauchy_kernel.hpp"

namespace tanktread::stokes {

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
