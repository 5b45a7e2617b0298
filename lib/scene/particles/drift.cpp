#include "scene/particles/drift.hpp"

#include "base/small_matrices.hpp"

namespace tanktread {

bool holds_centre(const ParticleScene& particle_scene) {
  if (particle_scene.particle.drift) return *particle_scene.particle.drift == "held";
  if (particle_scene.tube.present || particle_scene.wall.present || particle_scene.medium() || particle_scene.particle.rigid()) return false;
  if (!particle_scene.net_force().empty() || !particle_scene.loads.empty() || !particle_scene.equations.empty()) return false;
  const stokes::AmbientFlow flow(particle_scene.flow);
  if (!flow.affine()) return false;
  const Vec3& center = particle_scene.particle.shape.center;
  if (!flow.velocity(center).isZero(0)) return false;
  return largest_growth_rate(flow.gradient(center)) > 1e-4 * flow.rate();  // 0 for simple shear; up to 1e-5 if a rotated gradient is rounded
}

void hold_centre(const stokes::AmbientFlow& flow, const surface::Geometry& geometry, const Vec3& place, motion::TimeState& state) {
  constexpr coupling::BlockId shape{0};
  const Mat3 gradient = flow.gradient(place);
  const Vec3 off = geometry.measures(state.x(shape)).centroid - place, slope_off = gradient * off;
  state.x(shape).rowwise() -= off.transpose();
  for (coupling::State& slope : state.history) slope(shape).rowwise() -= slope_off.transpose();
  for (motion::PastPosition& earlier : state.places)
    earlier.x(shape).rowwise() -= (exponential(gradient * (earlier.time - state.time)) * off).transpose();
}

}  // namespace tanktread
