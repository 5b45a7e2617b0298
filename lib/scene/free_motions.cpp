#include "scene/free_motions.hpp"

#include <algorithm>

#include <Eigen/SVD>

#include "base/small_matrices.hpp"

namespace tanktread {

namespace {

/// The conditions of the loads of all particles on a rigid motion.
membrane::RigidConditions conditions(std::span<const coupling::Particle> particles) {
  membrane::RigidConditions all(0, 6);
  for (const coupling::Particle& particle : particles)
    for (const auto& load : particle.loads) {
      const membrane::RigidConditions more = load->rigid_conditions();
      all.conservativeResize(all.rows() + more.rows(), 6);
      all.bottomRows(more.rows()) = more;
    }
  return all;
}

}  // namespace

std::vector<coupling::RigidMotion> free_motions(const Scene& scene, const stokes::AmbientFlow& flow, double size,
                                                std::span<const coupling::Particle> particles) {
  const membrane::RigidConditions of_loads = conditions(particles);
  if (scene.tube.channel) return {};
  if (scene.tube.present) return of_loads.col(0).isZero(0) ? std::vector{coupling::unit_motion(0)} : std::vector<coupling::RigidMotion>();
  Net places(4, 3);
  places << size, 0, 0, 0, size, 0, 0, 0, size, size, size, size;
  const Net v = flow.velocities(places);
  const std::vector<Mat3> gradients = flow.gradients(places);
  Eigen::MatrixXd change(12 + of_loads.rows(), 6);
  change.bottomRows(of_loads.rows()) = scene.rate() * of_loads;
  change.bottomRightCorner(of_loads.rows(), 3) /= size;
  for (int k = 0; k < 6; ++k) {
    const coupling::RigidMotion motion = coupling::unit_motion(k);
    const double unit = k < 3 ? 1 : 1 / size;
    const Net moved = coupling::rigid_velocity(places, motion, Vec3::Zero());
    for (int i = 0; i < 4; ++i)
      change.block<3, 1>(3 * i, k) =
          unit * (gradients[static_cast<std::size_t>(i)] * moved.row(i).transpose() - motion.angular_velocity.cross(Vec3(v.row(i).transpose())));
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(change, Eigen::ComputeFullV);
  std::vector<coupling::RigidMotion> free;
  for (int k = 0; k < 6; ++k) {
    if (svd.singularValues()[k] > 1e-9 * std::max(scene.rate(), svd.singularValues()[0])) continue;
    const Eigen::VectorXd motion = svd.matrixV().col(k);
    free.push_back({motion.head<3>(), motion.tail<3>() / size});
  }
  return free;
}

double steady_step(const Scene& scene) {
  constexpr double most_relaxation_times = 10;
  if (scene.steady.step) return *scene.steady.step;
  double step = 0.5 / scene.rate();
  for (const Scene& one : scene.alone())
    if (!one.particle.rigid()) step = std::min(step, most_relaxation_times * one.flow.viscosity * one.radius() / one.modulus());
  return step;
}

bool holds_centre(const Scene& scene) {
  if (scene.particle.drift) return *scene.particle.drift == "held";
  if (scene.tube.present || scene.wall.present || scene.particle.rigid()) return false;
  const stokes::AmbientFlow flow(scene.flow);
  if (!flow.affine()) return false;
  const Vec3& center = scene.particle.shape.center;
  if (!flow.velocity(center).isZero(0)) return false;
  return largest_growth_rate(flow.gradient(center)) > 1e-9 * flow.rate();
}

void hold_centre(const stokes::AmbientFlow& flow, const surface::Geometry& geometry, const Vec3& place, motion::State& state) {
  const Mat3 gradient = flow.gradient(place);
  const Vec3 off = geometry.measures(state.x).centroid - place, carried = gradient * off;
  state.x.rowwise() -= off.transpose();
  for (Net& slope : state.history) slope.rowwise() -= carried.transpose();
  for (motion::Place& earlier : state.places) {
    earlier.x.rowwise() -= (exponential(gradient * (earlier.time - state.time)) * off).transpose();
  }
}

}  // namespace tanktread
