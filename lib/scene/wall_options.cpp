#include "scene/wall_options.hpp"

#include <string_view>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/section.hpp"
#include "scene/scene.hpp"
#include "stokes/flow/ambient_flow.hpp"

namespace tanktread {

namespace {
constexpr std::string_view along_the_wall = "a flow must be along the wall and the same everywhere on it";
}

void WallOptions::declare(deck::Section& section) {
  section.key("shape", shape, deck::Choice{"plane"}, "shape of the wall. `plane`: an infinite plane");
  section.key("point", point, deck::any(), "length", "position of any point on the plane wall");
  section.key("normal", normal, deck::any(), "1", "normal vector of the plane wall, pointing into the fluid; its length has no effect");
  section.key("contact gap", contact_gap, deck::between(1e-6, 1), "R_C",
              "smallest allowed gap between a particle and the plane wall, divided by the R_C of the smallest particle. If a gap is smaller, the "
              "run ends with a checkpoint");
}

void WallOptions::check(const stokes::FlowOptions& flow) const {
  if (!(normal.norm() > 0)) throw UserError("Wall/normal must have a direction, but is [0, 0, 0].");
  if (flow.type == "duct") return;  // rejected with the other combinations
  const stokes::PlaneWall wall = *plane();
  const Vec3 along = wall.axes().row(0).transpose(), across = wall.axes().row(1).transpose();
  for (const stokes::AmbientFlow& ambient : stokes::AmbientFlow(flow).directions()) {
    const Vec3 here = ambient.velocity(point);
    const double size = here.norm() + ambient.velocity(point + wall.normal()).norm() + ambient.rate();
    for (const auto& [a, b] : {std::pair(0, 0), {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}}) {
      const Vec3 place = point + a * along + b * across, there = ambient.velocity(place);
      if ((there - here).norm() + std::abs(there.dot(wall.normal())) <= 1e-9 * size) continue;
      throw UserError("Wall and Flow/type `" + flow.type +
                      "` contradict each other: " + std::string(along_the_wall) + ", but at " +
                      formatted("[%.4g, %.4g, %.4g] it is [%.4g, %.4g, %.4g], and at Wall/point [%.4g, %.4g, %.4g].", place[0], place[1], place[2],
                                there[0], there[1], there[2], here[0], here[1], here[2]));
    }
  }
}

void WallOptions::reject(const Scene& scene, Rejections& to) const {
  if (!present && !to.every()) return;
  if (to.every()) to.pair(true, "Wall", "Flow/type", std::string(along_the_wall));  // `check` tells where the flow is not
  to.pair(scene.flow.type == "duct", "Wall", "Flow/type `duct`", "a duct has walls of its own, in a list Tube");
  to.pair(scene.tube.present, "Wall", {scene.tube.list(), "Tube or Channel"}, "images are of one plane in a fluid that is unbounded otherwise");
  to.pair(scene.domain.present, "Wall", "Domain", "images in a wall of a scene that repeats are not there");
  to.pair(scene.quadrature.rule != "adaptive", "Wall",
          {"Quadrature/rule `" + scene.quadrature.rule + "`", "Quadrature/rule `fixed` or `desingularised`"},
          "a film at a wall takes rules by tolerance, `adaptive`");
  to.pair(!scene.runs_in_time(), scene.sought(), "Wall", "beside a wall nothing that deforms keeps its distance from it");
  to.pair(scene.particle.drift == "held", "Wall", "Particle/drift `held`", "its distance from the wall matters");
}

std::optional<stokes::PlaneWall> WallOptions::plane() const {
  if (!present) return {};
  return stokes::PlaneWall(point, normal);
}

}  // namespace tanktread
