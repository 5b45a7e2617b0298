#include "scene/steady_system.hpp"

#include <algorithm>

#include "system/shape_coordinates.hpp"

namespace tanktread {

Net System::without_sliding(const Net& before, const Net& after) {
  const coupling::Capsule& capsule = *particle->capsule();
  if (std::ranges::none_of(capsule.particles(), &coupling::Particle::slides)) return after;
  const Body& body = particle->body();
  coupling::CoupledMotion* fields = particle->fields();
  const surface::Symmetry none, &symmetry = fields && !fields->knows_images(body.symmetry) ? none : body.symmetry;
  const Net mean = 0.5 * (before + after);
  coupling::ShapeCoordinates shapes(body.space, capsule.particles(), symmetry, mean.topRows(capsule.n_points()), capsule.projection());
  if (fields) shapes.add_fields(*fields, mean);
  return before + shapes.displacement(shapes.coordinates(after - before));
}

}  // namespace tanktread
