#include "stokes/medium/plane_wall.hpp"

#include <cmath>
#include <utility>

#include "base/formatted.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "stokes/medium/wall_images.hpp"

namespace tanktread::stokes {

std::unique_ptr<LayerMedium> PlaneWall::in_layer(const LayerSources& sources, bool by_clusters) const {
  return std::make_unique<WallImages>(*this, sources, by_clusters);
}

std::string PlaneWall::refusal(const AmbientFlow& flow) const {
  const Vec3 along = axes_.row(0).transpose(), across = axes_.row(1).transpose(), here = flow.velocity(point_);
  const double size = here.norm() + flow.velocity(point_ + normal_).norm() + flow.rate();
  for (const auto& [a, b] : {std::pair(0, 0), {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}}) {
    const Vec3 place = point_ + a * along + b * across, there = flow.velocity(place);
    if ((there - here).norm() + std::abs(there.dot(normal_)) <= 1e-9 * size) continue;
    return std::string(along_the_wall) +
           formatted(", but at [%.4g, %.4g, %.4g] it is [%.4g, %.4g, %.4g], and at [%.4g, %.4g, %.4g] on the wall.", place[0], place[1],
                     place[2], there[0], there[1], there[2], here[0], here[1], here[2]);
  }
  return {};
}

}  // namespace tanktread::stokes
