#include "scene/wall_options.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/section.hpp"
#include "stokes/flow/ambient_flow.hpp"

namespace tanktread {

void WallOptions::declare(deck::Section& section) {
  section.key("shape", shape, deck::Choice{"plane"}, "a plane without end");
  section.key("point", point, deck::any(), "length", "one of the plane");
  section.key("normal", normal, deck::any(), "1", "of the plane, into the fluid; of any length");
  section.key("contact gap", contact_gap, deck::between(1e-6, 1), "R_C",
              "smallest gap between a particle and the wall, over the R_C of the smallest particle; a run that comes closer stops with a checkpoint");
}

void WallOptions::check(const stokes::FlowOptions& flow) const {
  if (!(normal.norm() > 0)) throw UserError("Wall/normal must have a direction, but is [0, 0, 0].");
  if (flow.type == "duct") throw UserError("Wall and Flow/type `duct` contradict each other: a duct has walls of its own, in a list Tube.");
  const stokes::PlaneWall wall = *plane();
  const Vec3 along = wall.axes().row(0).transpose(), across = wall.axes().row(1).transpose();
  for (const stokes::AmbientFlow& ambient : stokes::AmbientFlow(flow).directions()) {
    const Vec3 here = ambient.velocity(point);
    const double size = here.norm() + ambient.velocity(point + wall.normal()).norm() + ambient.rate();
    for (const auto& [a, b] : {std::pair(0, 0), {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}}) {
      const Vec3 place = point + a * along + b * across, there = ambient.velocity(place);
      if ((there - here).norm() + std::abs(there.dot(wall.normal())) <= 1e-9 * size) continue;
      throw UserError("Wall and Flow/type `" + flow.type +
                      "` contradict each other: a flow must be along the wall and the same everywhere on it, but at " +
                      formatted("[%.4g, %.4g, %.4g] it is [%.4g, %.4g, %.4g], and at Wall/point [%.4g, %.4g, %.4g].", place[0], place[1], place[2],
                                there[0], there[1], there[2], here[0], here[1], here[2]));
    }
  }
}

std::optional<stokes::PlaneWall> WallOptions::plane() const {
  if (!present) return {};
  return stokes::PlaneWall(point, normal);
}

}  // namespace tanktread
