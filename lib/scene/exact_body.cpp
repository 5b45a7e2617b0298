#include "scene/exact_body.hpp"

#include <cmath>

#include "quadrature/gauss.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

Vec3 ExactBody::force() const { return -(axes * ellipsoid.force(viscosity, velocity)); }

Vec3 ExactBody::torque() const { return -(axes * ellipsoid.torque(viscosity, angular_velocity)); }

double ExactBody::pressure(const Vec3& x) const {
  const Vec3 at = ellipsoid.point(local(x));
  return ellipsoid.force_density(viscosity, velocity, angular_velocity, at).dot(ellipsoid.normal(at));
}

Vec3 ExactBody::normal(const Vec3& x) const { return axes * ellipsoid.normal(local(x)); }

bool ExactBody::presses() const {
  const Vec3& a = ellipsoid.semi_axes;
  bool result = velocity.norm() > 0;
  for (int k = 0; k < 3; ++k) result = result || (angular_velocity[k] != 0 && a[(k + 1) % 3] != a[(k + 2) % 3]);
  return result;
}

coupling::RigidMotion prescribed_motion(const ParticleScene& particle_scene) {
  return {particle_scene.particle.velocity.value_or(Vec3::Zero()), particle_scene.particle.angular_velocity.value_or(Vec3::Zero())};
}

std::optional<ExactBody> exact_body(const ParticleScene& particle_scene) {
  if (particle_scene.wall.present || particle_scene.medium()) return {};
  const surface::ParticleShape& shape = particle_scene.particle.shape;
  const coupling::RigidMotion motion = prescribed_motion(particle_scene);
  if (particle_scene.tube.present || !shape.ellipsoidal()) return {};
  const stokes::AmbientFlow flow(particle_scene.flow);
  if (!flow.affine()) return {};
  const Mat3 l = flow.gradient(shape.center);
  if ((l + l.transpose()).norm() > 1e-14 * l.norm()) return {};
  const Mat3 axes = shape.rotation();
  const Vec3 semi_axes = shape.semi_axes ? *shape.semi_axes : Vec3::Constant(shape.equivalent_radius());
  const Vec3 spin(l(2, 1), l(0, 2), l(1, 0));  // angular velocity of the flow, from the antisymmetric velocity gradient
  return ExactBody{stokes::Ellipsoid(semi_axes),
                   axes,
                   shape.center,
                   axes.transpose() * (motion.velocity - flow.velocity(shape.center)),
                   axes.transpose() * (motion.angular_velocity - spin),
                   particle_scene.flow.viscosity};
}

SurfaceErrors surface_errors(const spline::Space& space, const Net& surface, const Net& f, const ExactBody& exact) {
  // 8 x 8 Gauss points per element are enough, because the errors are as smooth as the spline functions on each element
  const quadrature::TensorRule& rule = quadrature::tensor_gauss(8);
  double area = 0, difference = 0, square = 0, norm = 0, normals = 0;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e)
    for (int q = 0; q < rule.size(); ++q) {
      const spline::Site site{e, rule.s[q], rule.t[q]};
      const surface::Point p = surface::point(space, surface, site);
      const double weight = rule.weights[q] * p.jacobian, known = exact.pressure(p.x);
      const double d = surface::value(space, f, site).dot(p.n) - known;
      area += weight;
      difference += weight * d;
      square += weight * d * d;
      norm += weight * known * known;
      normals += weight * (p.n - exact.normal(p.x)).squaredNorm();
    }
  const double mean = difference / area;
  return {std::sqrt(std::max(0.0, square - area * mean * mean) / norm), std::sqrt(normals / area), -mean};
}

}  // namespace tanktread
