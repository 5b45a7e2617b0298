#pragma once
// Exact solutions for rigid bodies, with which numerical solutions are compared.

#include <optional>

#include "base/types.hpp"
#include "scene/scene.hpp"
#include "spline/space.hpp"
#include "stokes/flow/ellipsoid.hpp"
#include "system/solids/bodies/rigid_body.hpp"

namespace tanktread {

/// Exact solution for a sphere, spheroid or ellipsoid in a flow without strain. Force and traction depend only on the motion relative to the flow.
struct ExactBody {
  stokes::Ellipsoid ellipsoid;
  Mat3 axes;  ///< columns: principal axes of the ellipsoid, in coordinates of space
  Vec3 centre;
  Vec3 velocity, angular_velocity;  ///< velocities of the body relative to the flow, in components along the principal axes
  double viscosity;

  Vec3 force() const;   ///< returns the force on the body
  Vec3 torque() const;  ///< returns the torque on the body about its centre

  /// Returns the pressure p = -t.n up to a constant, with the traction t on the body, at the point of the exact surface that lies in the direction of
  /// x from the centre.
  double pressure(const Vec3& x) const;
  /// Returns the unit normal n at this point.
  Vec3 normal(const Vec3& x) const;

  /// Returns false if the pressure is zero everywhere, which is the case if the body only rotates about axes of revolution.
  bool presses() const;

 private:
  Vec3 local(const Vec3& x) const { return axes.transpose() * (x - centre); }
};

/// Returns the motion given by `Particle/velocity` and `Particle/angular velocity`.
coupling::RigidMotion prescribed_motion(const ParticleScene& particle_scene);

/// Returns the exact solution of an ellipsoid with prescribed motion. Returns nothing for other shapes, for a flow that is not affine or has a
/// nonzero rate of strain, and for a scene with a tube or wall.
std::optional<ExactBody> exact_body(const ParticleScene& particle_scene);

/// Errors of the pressure p, which follows from the force density f on the fluid, and of the normal n_h of the numerical surface. surface_errors()
/// computes them from the control net `surface` and the control values `f`.
struct SurfaceErrors {
  /// L2 norm of p - p_exact divided by the L2 norm of p_exact (6.3); p = f.n_h + c, with the constant c for which the mean of p - p_exact is zero
  double pressure = 0;
  double normal = 0;    ///< L2 norm of the error n_h - n of the numerical normal, divided by the L2 norm of the exact normal n
  double constant = 0;  ///< the constant c in the numerical pressure p = f.n_h + c
};
SurfaceErrors surface_errors(const spline::Space& space, const Net& surface, const Net& f, const ExactBody& exact);

}  // namespace tanktread
