#include "app/drift.hpp"

#include "base/small_matrices.hpp"

namespace tanktread {

bool holds_centre(const Scene& scene) {
  if (scene.particle.drift) return *scene.particle.drift == "held";
  if (scene.tube.present || scene.wall.present) return false;
  if (scene.flow.type == "parabolic") return false;
  const stokes::AmbientFlow flow(scene.flow);
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
