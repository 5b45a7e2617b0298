#include "scene/wall_options.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/section.hpp"
#include "scene/scene.hpp"
#include "stokes/flow/ambient_flow.hpp"

namespace tanktread {

void WallOptions::declare(deck::Section& section) {
  section.key("shape", shape, deck::Choice{"plane"}, "shape of the wall. `plane`: an infinite plane");
  section.key("point", point, deck::any(), "length", "position of any point on the plane wall");
  section.key("normal", normal, deck::any(), "1", "normal vector of the plane wall, pointing into the fluid; its length has no effect");
  section.key("distance", distance, deck::positive(), "length",
              "distance between the wall and a second, parallel wall along Wall/normal, so that the fluid is between two plates. It needs "
              "a Domain that is periodic along both directions in the plates");
  section.key("velocity", velocity, deck::any(), "length/time",
              "velocity of the wall, or of the first of two walls, in a periodic Domain: three numbers, tangential to the wall. If not "
              "given, the wall moves with the flow of Flow/type. Flow/history changes it in time");
  section.key("second velocity", second_velocity, deck::any(), "length/time",
              "velocity of the second wall, which Wall/distance adds: three numbers, tangential to the wall. If not given, the wall moves "
              "with the flow of Flow/type. Flow/history changes both as it changes the flow");
  section.key("elements per period", elements_per_period, deck::between(4, 200), "1",
              "number of elements of each plane wall along the longer of its two periods; along the shorter period, elements have about the "
              "same length. If not given: the smallest number for which elements are no longer than a twelfth of Wall/distance (with a single "
              "wall, of R_C, the radius of the sphere with the particle's volume), but at most 72");
  section.key("contact gap", contact_gap, deck::between(1e-6, 1), "R_C",
              "smallest allowed gap between a particle and the plane wall, divided by R_C, the radius of the sphere with the volume of the "
              "smallest particle. If a gap is smaller, the run ends with a checkpoint");
}

void WallOptions::check(const stokes::FlowOptions& flow, const std::optional<stokes::PeriodicCell>& cell) const {
  if (!(normal.norm() > 0)) throw UserError("Wall/normal must have a direction, but is [0, 0, 0].");
  if (flow.type == "duct") return;  // reject() rejects this combination
  if (!solid) {
    if (distance)
      throw UserError("Wall/distance needs a Domain that is periodic along both directions in the plates: give Domain/periodic and "
                      "Domain/side lengths.");
    for (const auto& [name, given] : {std::pair("velocity", velocity.has_value()), {"elements per period", elements_per_period.has_value()}})
      if (given)
        throw UserError(std::string("Wall/") + name +
                        " needs a Domain: without a Domain the wall is represented by images and moves with the flow.");
  }
  if (second_velocity && !distance) throw UserError("Wall/second velocity needs Wall/distance, the distance between the two walls.");
  const Vec3 n = normal.normalized();
  for (const auto& [name, given] : {std::pair("velocity", &velocity), {"second velocity", &second_velocity}})
    if (*given && std::abs(n.dot(**given)) > 1e-9 * (*given)->norm())
      throw UserError(std::string("Wall/") + name +
                      " must be along the wall, because the position of the wall is fixed, but has a component along Wall/normal.");
  if (solid && cell)
    for (int d = 0; d < 3; ++d)
      if (cell->n() != 2 || (d < 2 && std::abs(cell->vectors().col(d).dot(n)) > 1e-9 * cell->vectors().col(d).norm()))
        throw UserError(
            "Wall and Domain do not fit each other: walls bound the fluid along Wall/normal, so that the Domain must be periodic along "
            "both directions in the walls and along no other. Give these two as Domain/periodic.");
  for (const stokes::PlaneWall& wall : planes()) check_flow(flow, wall, "Wall");
  if (!flow.pressure_gradient || !solid) return;
  if (!distance)
    throw UserError(
        "Flow/pressure gradient needs a second wall, at Wall/distance, because a single wall does not balance the force of the pressure.");
  if (std::abs(n.dot(*flow.pressure_gradient)) > 1e-9 * flow.pressure_gradient->norm())
    throw UserError(
        "Flow/pressure gradient must be along the walls, because a gradient across them drives no flow, but has a component along "
        "Wall/normal.");
}

void WallOptions::reject(const ParticleScene& particle_scene, Rejections& to) const {
  if (!present && !to.every()) return;
  // This entry appears only in the documentation's table of rejected combinations. For a given deck, check() throws UserError if the flow is not
  // along the wall or not uniform on it.
  if (to.every()) to.pair(true, "Wall", "Flow/type", std::string(stokes::along_the_wall));
  to.pair(particle_scene.flow.type == "duct" && !particle_scene.tube.present, "Wall", "Flow/type `duct`",
          "the wall of a duct is given in a section Tube or Channel");
  to.pair(particle_scene.tube.present, "Wall", particle_scene.duct_choice(),
          "a plane wall is represented by images, which need a fluid without other walls");
  to.pair(particle_scene.flow.pressure_gradient && solid && particle_scene.flow.type == "parabolic", "Flow/pressure gradient",
          "Flow/type `parabolic`", "that flow already has a pressure gradient");
  to.pair(particle_scene.quadrature.rule != quadrature::LayerRule::adaptive, "Wall",
          {"Quadrature/rule `" + deck::word(quadrature::layer_rules, particle_scene.quadrature.rule) + "`",
           "Quadrature/rule `fixed` or `desingularised`"},
          "the film at a wall needs quadrature to a tolerance; give `adaptive`");
  to.pair(!particle_scene.runs_in_time() && !distance, particle_scene.sought(), {"Wall", "Wall without Wall/distance"},
          "a deformable particle next to a single wall moves away from it or towards it, so that no shape is steady");
  to.pair(particle_scene.particle.drift == "held", "Wall", "Particle/drift `held`", reason::drift);
}

std::optional<stokes::PlaneWall> WallOptions::plane() const {
  if (!present || solid) return {};
  return stokes::PlaneWall(point, normal);
}

std::vector<stokes::PlaneWall> WallOptions::planes() const {
  if (!present) return {};
  std::vector<stokes::PlaneWall> all{{point, normal}};
  if (distance) all.emplace_back(point + *distance * normal.normalized(), -normal);
  return all;
}

std::optional<stokes::Plates> WallOptions::plates() const {
  if (!solid) return {};
  return stokes::Plates{point, normal.normalized(), distance, velocity, second_velocity};
}

std::array<int, 2> WallOptions::elements(const stokes::PeriodicCell& cell, double radius) const {
  constexpr double most = 72;
  const double first = cell.vectors().col(0).norm(), second = cell.vectors().col(1).norm(), longer = std::max(first, second);
  const double along = elements_per_period ? *elements_per_period : std::min(most, std::ceil(12 * longer / distance.value_or(radius)));
  const auto number = [&](double length) { return std::max(4, static_cast<int>(std::lround(along * length / longer))); };
  return {number(first), number(second)};
}

}  // namespace tanktread
