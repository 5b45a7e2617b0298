#pragma once
// Maxwell element of a membrane: a viscosity with memory, that is, springs in series with dashpots.

#include <vector>

#include <Eigen/Core>

#include "base/types.hpp"
#include "membrane/field.hpp"
#include "membrane/laws.hpp"
#include "membrane/packed.hpp"
#include "membrane/points_kernel.hpp"
#include "spline/space.hpp"

namespace tanktread::membrane {

/// Maxwell element parallel to an elastic membrane; together they form a standard linear solid. Its in-plane springs have the shear modulus
/// G = eta_s/T and the dilatation modulus K = kappa_s/T, with the surface viscosities eta_s and kappa_s. Their stress relaxes within the time T,
/// because their stress-free metric C^-1 follows the metric g_ab of the surface (|.|: determinant):
///
///   E = int (G/2 (t/J - 2) + K/2 (J - 1)^2) dGamma,   t = C^ab g_ab,   J^2 = |C| |g|                                        (3.23)
///   T dC^ab/dt = (2 J^2/t) g^ab - (2 - 1/J) C^ab                                                                           (3.24)
///
/// The power lost in the relaxation is dissipated as heat (3.25). For T -> 0, the element becomes the surface viscosity (3.10). E is the energy of
/// the law `MaxwellSpring` on a reference surface with the metric C^-1. The unknowns are C^11, C^12, C^22 at the Gauss points, divided by g^11,
/// sqrt(g^11 g^22), g^22 of the shape `initial`. Uses no MPI.
class MaxwellElement : public Field {
 public:
  /// `order`: number of Gauss points per direction, with the same meaning as in Membrane. `space` must outlive this object. `time`: relaxation time
  /// T.
  MaxwellElement(const spline::Space& space, const Net& initial, int order, const SurfaceViscosity& viscosity, double time);

  Eigen::Index size() const override { return 3 * unit_.rows(); }  ///< number of coefficients: the components C^11, C^12, C^22 at every Gauss point
  Eigen::VectorXd start(const Net& shape) const override;          ///< coefficients of an element without stress on this shape
  void set_state(const Net& x, const Eigen::VectorXd& q) override;
  Net load() const override;
  Eigen::VectorXd rate(const Net&) const override { return rate_; }
  double energy() const override;

  /// Returns the power (3.25) that the dashpots dissipate as heat, int (G (t^2 - 4 J^2)/(2 t J) + K (J - 1)^2)/T dGamma, with the symbols of (3.23).
  double dissipation() const override { return dissipation_; }

  void linearise(const Net&) override;
  Eigen::VectorXd value_change(const Net&, const Eigen::VectorXd& dq) const override { return dq; }
  Net load_change(const Net& dx, const Eigen::VectorXd& dq) const override;
  Eigen::VectorXd rate_change(const Net& dx, const Eigen::VectorXd& dq, const Net&) const override;
  Eigen::VectorXd solve(double shift, const Eigen::VectorXd& r) const override;  ///< solves (I - shift d(rate)/dq) dq = r exactly, by a 3 x 3 system
                                                                                 ///< per Gauss point
  bool follows_shape() const override { return true; }
  Eigen::VectorXd relabelled(const Net&) const override { return Eigen::VectorXd::Zero(size()); }
  std::vector<std::pair<int, double>> images(const surface::Image& image) const override;
  surface::FieldsAt values_at() const override;  ///< logarithm of the strain tensor C^ab x_,a x_,b (3.23), nine Cartesian components
  /// Interpolates the logarithm of the strain C (3.23), with components in orthonormal frames of the surface, so that C stays positive definite.
  Eigen::VectorXd transferred(const Field& from, const Net& x, const std::function<spline::Site(const spline::Site&)>& site) const override;

 private:
  /// Metric, strain and tangents at a Gauss point as dual numbers, for given changes of x and q.
  struct Point;
  int order(std::size_t element) const;
  Eigen::MatrixX3d raised_metric(const Net& x) const;
  Eigen::MatrixX3d logarithms() const;
  Eigen::Vector3d interpolated(const Eigen::MatrixX3d& logarithms, const spline::Site& site) const;
  template <class Use>
  void each_change(const Net& dx, const Eigen::VectorXd& dq, const Use& use) const;
  template <class Use>
  void each_batch(const Net& x, const Use& use) const;
  template <class Use>
  void each_point(const Net& x, const Use& use) const;

  const spline::Space& space_;
  MaxwellSpring spring_;
  double time_;
  std::vector<Group> groups_;
  std::vector<Eigen::Index> first_;                     // for each element, index of its first Gauss point, which is a row of `unit_`
  // g^11, sqrt(g^11 g^22), g^22 of the shape `initial`, one row per Gauss point; a coefficient q is a component of C (3.23) divided by the
  // corresponding entry of `unit_`
  Net unit_;
  Net x_;
  std::vector<ReferencePoint> relaxed_;                 // stress-free surface at the Gauss points, batch after batch
  Eigen::VectorXd rate_;
  double dissipation_ = 0;
  Eigen::VectorXd q_, known_q_;  // q_: coefficients that set_state() set last. known_q_: coefficients at the last call of linearise()
  Net known_x_;
  std::vector<Eigen::Matrix3d> known_rates_;  // d(rate)/dq at each Gauss point
};

}  // namespace tanktread::membrane
