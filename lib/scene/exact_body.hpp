#pragma once
// What the solution of a rigid body is held against where the exact one is known.

#include <optional>

#include "base/types.hpp"
#include "scene/scene.hpp"
#include "spline/space.hpp"
#include "stokes/flow/ellipsoid.hpp"
#include "system/solids/rigid_body.hpp"

namespace tanktread {

/// A sphere, spheroid or ellipsoid in a flow without strain: force and traction depend on its motion relative to the flow alone.
struct ExactBody {
  stokes::Ellipsoid ellipsoid;
  Mat3 axes;  ///< columns: the principal axes in space
  Vec3 centre;
  Vec3 velocity, angular_velocity;  ///< relative to the flow, in the principal axes
  double viscosity;

  Vec3 force() const;   ///< on the body
  Vec3 torque() const;  ///< on the body, about its centre

  /// At the point of the exact surface in the direction of x: pressure p = -t.n without its constant, t the traction on the body, and normal.
  double pressure(const Vec3& x) const;
  Vec3 normal(const Vec3& x) const;

  /// Whether there is any pressure: a body that only turns about axes of revolution makes none.
  bool presses() const;

 private:
  Vec3 local(const Vec3& x) const { return axes.transpose() * (x - centre); }
};

/// `Particle/velocity` and `Particle/angular velocity`.
coupling::RigidMotion prescribed_motion(const Scene& scene);

/// Empty where no exact solution is known: another shape, a flow that strains, a tube.
std::optional<ExactBody> exact_body(const Scene& scene);

/// Errors over the surface with control net `surface`, for the force density f on the fluid (control values); n_h its own normal.
struct SurfaceErrors {
  double pressure = 0;  ///< p = f.n_h with the constant fixed by int (p - p_exact) dG = 0: L2 norm of p - p_exact over that of p_exact (6.3)
  double normal = 0;    ///< L2 norm of n_h - n over that of n
  double constant = 0;  ///< to be added to f.n_h
};
SurfaceErrors surface_errors(const spline::Space& space, const Net& surface, const Net& f, const ExactBody& exact);

}  // namespace tanktread
