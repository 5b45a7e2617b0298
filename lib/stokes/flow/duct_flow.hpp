#pragma once
// The flow of a straight duct along x1 without a particle.

#include <memory>

#include "base/types.hpp"
#include "surface/walls/tube_wall.hpp"

namespace tanktread::stokes {

/// Velocity profile of a duct: u with u_,22 + u_,33 = -1 in the cross-section and u = 0 on its outline. Units: u length^2, coordinates x2, x3.
class DuctProfile {
 public:
  virtual ~DuctProfile() = default;

  /// Evaluates u and, unless `u2` is null, its derivatives with respect to x2 and x3 at n points; arrays of length n. Points must not lie outside the
  /// cross-section.
  virtual void evaluate(int n, const double* x2, const double* x3, double* u, double* u2, double* u3) const = 0;

  virtual double flow_rate() const = 0;  ///< int u dA, units length^4
};

/// Returns a profile in closed form, for an ellipse or a rectangle (a series, exact to round-off) with its centre at the origin.
std::unique_ptr<DuctProfile> ellipse_profile(const surface::Vec2& semi_axes);
std::unique_ptr<DuctProfile> rectangle_profile(const surface::Vec2& sides);

/// Returns the profile selected by TubeOptions: a closed form or the boundary-element profile.
std::unique_ptr<DuctProfile> duct_profile(const surface::TubeOptions& options, const surface::Outline& outline);

/// Unidirectional flow v = (v_1(x2, x3), 0, 0) with  mu (v_1,22 + v_1,33) = p_,1 = -G  and v_1 = 0 on the wall (equation 33 of Maestre et al. 2017),
/// with a given mean velocity in the cross-section. Only the pressure p = -G x1 depends on x1. For channels with varying cross-section, a derived
/// class overrides the virtual functions; all other members then refer to the inlet.
class DuctFlow {
 public:
  DuctFlow(const surface::TubeOptions& options, double viscosity, double mean_velocity);
  DuctFlow(surface::Outline outline, std::shared_ptr<const DuctProfile> profile, double viscosity, double mean_velocity);
  DuctFlow(const DuctFlow&) = default;
  DuctFlow& operator=(const DuctFlow&) = default;
  virtual ~DuctFlow() = default;

  Vec3 velocity(const Vec3& x) const;
  Mat3 gradient(const Vec3& x) const;                 ///< L_ij = dv_i/dx_j; only L_12 and L_13 are not zero
  virtual Net velocities(const Net& x) const;         ///< returns the velocities at the rows of x; much faster than one call per point
  Net tractions(const Net& x, const Net& n) const;  ///< returns tractions f_inf = (-p 1 + 2 mu E) n with the pressure p = -G x1 and the viscosity mu
                                                    ///< of the outer fluid
  virtual std::vector<Mat3> gradients(const Net& x) const;

  /// Returns the pressure drop over a wall of this length; in a channel, between its ends or over one period.
  virtual double pressure_drop(double length) const { return pressure_gradient_ * length; }
  virtual double extra_pressure_drop() const { return 0; }  ///< pressure drop minus the pressure drop of a straight duct
  virtual std::shared_ptr<const surface::TubeWall> fixed_wall() const { return {}; }  ///< wall of a channel; null for a wall that moves

  const surface::Outline& outline() const { return outline_; }
  double viscosity() const { return viscosity_; }
  double mean_velocity() const { return mean_velocity_; }
  double flow_rate() const { return mean_velocity_ * outline_.area(); }  ///< returns Q
  double pressure_gradient() const { return pressure_gradient_; }        ///< G = -p_,1, units pressure/length
  double radius() const { return outline_.radius(); }                    ///< returns R_T = sqrt(area/pi)

  struct Maximum {
    surface::Vec2 place;
    double velocity;
  };
  Maximum maximum() const;  ///< largest velocity and its position

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
