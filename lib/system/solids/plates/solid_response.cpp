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
  const auto height = [&](const std::vector<double> (&x)[3], std::size_t k) { return wall.height(Vec3(x[0][k], x[1][k], x[2][k])); };
  Vec3 sum = coupling::solids_flow_integral(scene_, flow);
  const stokes::Layer& single = particles_.single_layer;
  std::vector<double> weighted = single.weights();
  for (std::size_t k = 0; k < weighted.size(); ++k) weighted[k] *= profile(scene_, height(single.nodes(), k)) / scene_.solids->viscosity();
  if (f.size() > 0) sum -= f.transpose() * single.moments(weighted);
  if (v.size() > 0 && particles_.double_layer) {  // stress of (2.49): sigma_i n = x_i n + slope (e_i (m.n) + m (e_i.n)), m: normal of the plates
    const stokes::Layer& dual = *particles_.double_layer;
    for (int i = 0; i < 3; ++i)
      for (int c = 0; c < 3; ++c) {
        std::vector<double> stress(dual.nodes()[0].size());
        for (std::size_t k = 0; k < stress.size(); ++k) {
          const Vec3 normal(dual.normals()[0][k], dual.normals()[1][k], dual.normals()[2][k]);
          const double slope = distance(scene_) / 2 - height(dual.nodes(), k);
          stress[k] = dual.nodes()[i][k] * normal[c] + slope * ((i == c ? n.dot(normal) : 0.) + n[c] * normal[i]);
        }
        sum[i] += dual.moments(stress).dot(v.col(c));
      }
  }
  return along(wall, sum);
}

}  // namespace tanktread::coupling
