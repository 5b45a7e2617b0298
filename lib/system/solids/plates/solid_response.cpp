#include "system/solids/plates/solid_response.hpp"

#include <algorithm>
#include <stdexcept>

namespace tanktread::coupling {

namespace {

double distance(const SolidScene& scene) { return scene.planes.front().height(scene.planes.back().point()); }

/// Returns phi = z (D - z)/2 of (2.49) at the height z above the first of two plates at the distance D.
double profile(const SolidScene& scene, double height) { return height * (distance(scene) - height) / 2; }

Vec3 along(const stokes::PlaneWall& wall, const Vec3& v) { return v - wall.normal().dot(v) * wall.normal(); }

}  // namespace

PlatesAndPosts::Flow without_particles(const SolidScene& scene, const stokes::AmbientFlow& flow) {
  const PlatesAndPosts& solids = *scene.solids;
  Vec3 force = Vec3::Zero();
  if (solids.cell().n() == 3) force = solids.cell().volume() * flow.change() * scene.driving_gradient;
  return solids.solve(solids.velocities() * flow.change().transpose() - flow.velocities(solids.sites()), force);
}

Vec3 solids_flow_integral(const SolidScene& scene, const PlatesAndPosts::Flow& flow) {
  if (scene.solids->cell().n() == 3) return scene.solids->cell().volume() * flow.drift;
  if (scene.planes.size() == 1) return Vec3::Zero();
  const stokes::PlaneWall& wall = scene.planes.front();
  const Eigen::VectorXd weights = scene.solids->moments([&](const Vec3& x) { return profile(scene, wall.height(x)); });
  return along(wall, flow.force.transpose() * weights) / scene.solids->viscosity();
}

SolidResponse::SolidResponse(const SolidScene& scene, const spline::Space& space, const Net& unstressed, std::span<const Particle> particles,
                             const stokes::AmbientFlow& flow)
    : scene_(scene),
      flow_(flow),
      particles_(space, {}, unstressed, particles, scene.quadrature.for_response(), scene.solids->viscosity()) {
  particles_.repeat(scene.solids->cell(), {.target_range = scene.solids->range()});
}

void SolidResponse::set_shape(const Net& x, const Net& at, std::span<const int> own) {
  PlatesAndPosts& solids = *scene_.solids;
  solids.reach(x);  // also for an unchanged x, because another system that shares the solids may have changed their range
  if (same(shape_, x) && same(on_particles_.at, at) && std::ranges::equal(own, on_particles_.own)) return;
  shape_ = {};  // no shape is set if one of the next calls throws
  particles_.set_shape(x);
  areas_ = particles_.single_layer.moments(particles_.single_layer.weights());
  on_particles_ = solids.prepared(at, {own.begin(), own.end()});
  on_solids_ = particles_.prepared(solids.sites(), solids.own());
  shape_ = x;
}

const PlatesAndPosts::Flow& SolidResponse::empty() {
  if (!empty_ || change_ != flow_.change()) empty_ = without_particles(scene_, flow_), change_ = flow_.change();
  return *empty_;
}

PlatesAndPosts::Flow SolidResponse::respond(const Net& f, const Net& v) {
  if (shape_.rows() == 0) throw std::logic_error("plates and posts need the shape of the particles before they respond");
  const PlatesAndPosts& solids = *scene_.solids;
  Vec3 force = Vec3::Zero();
  if (f.size() > 0) force = f.transpose() * areas_;
  const Net u = solids.ranks().filled(solids.sites().rows(), [&](Net& all) { particles_.add(f, v, on_solids_, all); });
  return solids.solve(-u, force);
}

void SolidResponse::velocities(const PlatesAndPosts::Flow& flow, Net& u) { scene_.solids->velocity_at(on_particles_, flow, u); }

Vec3 SolidResponse::flow_integral(const PlatesAndPosts::Flow& flow, const Net& f, const Net& v) {
  if (scene_.planes.size() != 2) return coupling::solids_flow_integral(scene_, flow);
  const stokes::PlaneWall& wall = scene_.planes.front();
  const Vec3& n = wall.normal();
  Vec3 sum = coupling::solids_flow_integral(scene_, flow);
  if (f.size() > 0) {
    const Net weights = particles_.weights_of_load([&](const Net& x) {
      Net all(x.rows(), 3);
      for (Eigen::Index k = 0; k < x.rows(); ++k) all.row(k).setConstant(profile(scene_, wall.height(x.row(k).transpose())));
      return all;
    });
    sum -= weights.cwiseProduct(f).colwise().sum().transpose() / scene_.solids->viscosity();
  }
  for (int i = 0; i < 3 && v.size() > 0 && particles_.double_layer; ++i)
    sum[i] += dot(particles_.weights_of_velocity([&](const Net& x, const Net& normals) {
      Net stress(x.rows(), 3);  // (2.49): sigma_i n = x_i n + slope (e_i (m.n) + m (e_i.n)), m: normal of the plates
      for (Eigen::Index k = 0; k < x.rows(); ++k) {
        const Vec3 normal = normals.row(k).transpose();
        const double slope = distance(scene_) / 2 - wall.height(x.row(k).transpose());
        stress.row(k) = (x(k, i) * normal + slope * (n.dot(normal) * Vec3::Unit(i) + normal[i] * n)).transpose();
      }
      return stress;
    }), v);
  return along(wall, sum);
}

}  // namespace tanktread::coupling
