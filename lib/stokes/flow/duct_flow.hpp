#pragma once
// The flow of a straight duct along x1 without a particle.

#include <memory>
#include <span>

#include "base/types.hpp"
#include "surface/outline.hpp"

namespace tanktread::stokes {

/// The shape of a duct's velocity: u with u_,22 + u_,33 = -1 in the section and u = 0 on its outline. Units: u length^2, coordinates x2, x3.
class DuctProfile {
 public:
  virtual ~DuctProfile() = default;

  /// u and, unless `u2` is null, its derivatives by x2 and x3 at n points; arrays of n numbers. Points must not lie outside of the section.
  virtual void evaluate(int n, const double* x2, const double* x3, double* u, double* u2, double* u3) const = 0;

  virtual double flow_rate() const = 0;  ///< int u dA, units length^4
};

/// Closed forms: of an ellipse or circle, and of a rectangle (a series, to round-off), both about the origin.
std::unique_ptr<DuctProfile> ellipse_profile(const surface::Vec2& semi_axes);
std::unique_ptr<DuctProfile> rectangle_profile(const surface::Vec2& sides);

/// What remains of an exact section: the profile that TubeOptions ask for.
std::unique_ptr<DuctProfile> duct_profile(const surface::TubeOptions& options, const surface::Outline& outline);

/// Unidirectional flow v = (v_1(x2, x3), 0, 0) with  mu (v_1,22 + v_1,33) = p_,1 = -G  and v_1 = 0 on the wall                  (P-33)
/// whose mean over the section is given. All queries are independent of x1 but for the pressure p = -G x1. Where a channel's section changes, what
/// derives from this has another velocity; the rest is that of its inlet.
class DuctFlow {
 public:
  DuctFlow(const surface::TubeOptions& options, double viscosity, double mean_velocity);
  DuctFlow(surface::Outline outline, std::shared_ptr<const DuctProfile> profile, double viscosity, double mean_velocity);
  DuctFlow(const DuctFlow&) = default;
  DuctFlow& operator=(const DuctFlow&) = default;
  virtual ~DuctFlow() = default;

  Vec3 velocity(const Vec3& x) const;
  Mat3 gradient(const Vec3& x) const;                 ///< L_ij = dv_i/dx_j; only L_12 and L_13 are not zero
  virtual Net velocities(const Net& x) const;         ///< a row each; much faster than one by one
  Net tractions(const Net& x, const Net& n) const;    ///< f_inf = (-p 1 + 2 mu E) n, p = -G x1: full, of the outer viscosity
  virtual std::vector<Mat3> gradients(const Net& x) const;

  const surface::Outline& outline() const { return outline_; }
  const DuctProfile& profile() const { return *profile_; }
  double viscosity() const { return viscosity_; }
  double mean_velocity() const { return mean_velocity_; }
  double flow_rate() const { return mean_velocity_ * outline_.area(); }  ///< Q
  double pressure_gradient() const { return pressure_gradient_; }        ///< G = -p_,1, units pressure/length
  double radius() const { return outline_.radius(); }                    ///< R_T

  struct Maximum {
    surface::Vec2 place;
    double velocity;
  };
  Maximum maximum() const;  ///< the largest velocity and where it is

 private:
  struct Samples {
    Eigen::ArrayXd u, u2, u3;
  };
  Samples samples(const Net& x, bool derivatives) const;

  surface::Outline outline_;
  std::shared_ptr<const DuctProfile> profile_;
  double viscosity_, mean_velocity_, pressure_gradient_, scale_;
};

}  // namespace tanktread::stokes
