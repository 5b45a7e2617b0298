#include "scene/solids.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "quadrature/gauss.hpp"
#include "scene/posts.hpp"
#include "scene/room.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "surface/closest_points.hpp"
#include "surface/patch.hpp"
#include "surface/walls/solid_surface.hpp"
#include "system/solids/shared_walls.hpp"

namespace tanktread {

namespace {

using coupling::PlatesAndPosts;

int elements_along(const Post& post, const Vec3& period) {
  return post.along.value_or(std::max(4, static_cast<int>(std::ceil(period.norm() * post.around / (2 * std::numbers::pi * post.radius)))));
}

Vec3 lattice_vector(const stokes::PeriodicCell& cell, int d) { return cell.vectors().col(d); }

/// Returns the plates. Each plate moves at the velocity of the ambient flow on it, because the ambient flow satisfies no-slip on the plates.
std::vector<PlatesAndPosts::Solid> plates(const Scene& scene, const stokes::PeriodicCell& cell, const stokes::AmbientFlow& flow) {
  std::vector<PlatesAndPosts::Solid> all;
  for (const stokes::PlaneWall& wall : scene.wall.planes()) {
    const Vec3 middle = wall.normal().dot(wall.point()) * wall.normal();
    const std::array<int, 2> elements = scene.wall.elements(cell, scene.least_radius());
    all.push_back({surface::plate(middle, lattice_vector(cell, 0), lattice_vector(cell, 1), elements), flow.velocity(wall.point()),
                   [wall](const Vec3& x) { return wall.contains(x); }, all.empty() ? "the wall" : "the second wall"});
  }
  return all;
}

Vec3 center_in_cell(const Post& post, const stokes::PeriodicCell& cell) { return post.center - cell.shift(post.center); }

/// Returns the condition that a point is outside of a post and its images.
std::function<bool(const Vec3& x)> outside_of(const Post& post, const stokes::PeriodicCell& cell) {
  return [=, center = center_in_cell(post, cell), images = cell.around({1, 1, 1})](const Vec3& x) {
    const Vec3 apart = x - center, near = apart - cell.shift(apart);
    return std::ranges::none_of(images, [&](const Vec3& image) { return (near - image).cross(Vec3::Unit(post.axis)).norm() <= post.radius; });
  };
}

surface::SolidSurface surface_of(const Post& post, const stokes::PeriodicCell& cell) {
  const Vec3 period = period_of(post, cell);
  return surface::cylinder(center_in_cell(post, cell), period, post.radius, post.around, elements_along(post, period));
}

/// Returns true if the initial surface of the particle intersects the surface of the post or of one of its images.
bool intersects(const Body& body, const Post& post, const stokes::PeriodicCell& cell) {
  const surface::SolidSurface cylinder = surface_of(post, cell);
  const surface::Patches round(surface::BezierMap(cylinder.space), cylinder.net);
  const surface::ElementBoxes its(round);
  const surface::BezierMap map(body.space);
  const Vec3 back = cell.shift(body.initial.colwise().mean().transpose());
  const double reach = 1e-6 * body.radius;  // distance below which surfaces count as touching
  return std::ranges::any_of(cell.around({2, 2, 2}), [&](const Vec3& image) {
    const surface::Patches patches(map, body.initial.rowwise() + (image - back).transpose());
    const surface::ElementBoxes boxes(patches);
    return boxes.whole().exteriorDistance(its.whole()) < reach && surface::closest_points(boxes, its, 0.1 * reach, reach).gap < reach;
  });
}

/// Returns the free directions of (2.46), in which the walls do not determine the mean velocity.
std::vector<Vec3> free_directions(const SharedOptions& shared, const stokes::PeriodicCell& cell) {
  std::vector<Vec3> free;
  if (cell.n() == 3)
    for (int c = 0; c < 3; ++c) free.push_back(Vec3::Unit(c));
  else if (!shared.wall.distance)
    for (int c = 0; c < 2; ++c) free.emplace_back(shared.wall.planes().front().axes().row(c).transpose());
  return free;
}

}  // namespace

std::optional<coupling::SolidScene> make_solids(const Scene& scene, Phases& phases) {
  if (!scene.wall.solid && scene.posts.empty()) return {};
  const stokes::PeriodicCell cell = *scene.domain.cell();
  const stokes::AmbientFlow flow(scene.flow);
  std::vector<PlatesAndPosts::Solid> all = plates(scene, cell, flow);
  // Between plates, the pressure gradient is part of the ambient flow: it is mu times the Laplacian of the ambient velocity (2.20).
  const Vec3 pressure_gradient = scene.wall.solid ? Vec3(2 * scene.flow.viscosity * flow.curvature().trace() * flow.quadratic_direction())
                                                  : scene.flow.pressure_gradient.value_or(Vec3::Zero());
  for (const Post& post : scene.posts) all.push_back({surface_of(post, cell), Vec3::Zero(), outside_of(post, cell), post.path()});
  const PlatesAndPosts::Parameters parameters{cell, free_directions(scene, cell), scene.flow.viscosity, scene.quadrature};
  return coupling::SolidScene{
      scene.walls->solids.of([&](const PlatesAndPosts& one) { return one.is_for(all, parameters); },
                             [&] { return new PlatesAndPosts(all, parameters, phases); }),
      scene.wall.solid ? scene.wall.planes() : std::vector<stokes::PlaneWall>(), pressure_gradient, scene.quadrature};
}

void check_outside_of_posts(const Scene& scene, const Member& member) {
  for (const Post& post : scene.posts) {
    const stokes::PeriodicCell cell = *scene.domain.cell();
    if (!outside_of(post, cell)(surface::value(member.body->space, member.body->initial, {0, 0.5, 0.5})) || intersects(*member.body, post, cell))
      throw NoRoom(member.scene.path() + " crosses " + post.path() + " at the start: give it another center.", 0);
  }
}

double solid_points(const Scene& scene) {
  const stokes::PeriodicCell cell = *scene.domain.cell();
  double points = 0;
  if (scene.wall.solid) {
    const auto [first, second] = scene.wall.elements(cell, scene.least_radius());
    points += (scene.wall.distance ? 2. : 1.) * first * second;
  }
  for (const Post& post : scene.posts) points += static_cast<double>(post.around) * elements_along(post, period_of(post, cell));
  return points;
}

std::string solids_line(const Scene& scene, int ranks) {
  const stokes::PeriodicCell cell = *scene.domain.cell();
  const double points = solid_points(scene);
  std::string line;
  if (scene.wall.solid) {
    const auto [first, second] = scene.wall.elements(cell, scene.least_radius());
    const int plates = scene.wall.distance ? 2 : 1;
    line = formatted("%d plate%s of %d x %d elements", plates, plates > 1 ? "s" : "", first, second);
  }
  for (const Post& post : scene.posts) {
    const int along = elements_along(post, period_of(post, cell));
    line += (line.empty() ? "" : ", ") + formatted("a post of %d x %d elements", post.around, along);
  }
  line += formatted(": %.0f unknowns of their traction, ", 3 * points);
  if (scene.posts.empty()) return line + "inverted once by Fourier series";
  return line + formatted("factored once: %.1f MB on each of %d rank%s", 72e-6 * points * points, ranks, ranks > 1 ? "s" : "");
}

void SolidsRow::add_columns(const SharedOptions& shared, Columns& to) const {
  constexpr const char *walls = "; with walls in a Domain", *posts = "; with posts", *both = "; with two walls or posts in a Domain";
  const auto add = [&](const Vec3& value, const std::string& name, const char* unit, const char* description, const char* where) {
    to.add(value, "x1 x2 x3", {name, unit, description, {}, where});
  };
  if (to.when(shared.wall.solid)) {
    add(wall_force, "wall_force_", "force",
        "component # of the force of the fluid on one period of the wall. The uniform part of the pressure, which is arbitrary, is not "
        "included: between two walls it is chosen such that the normal forces on both are equal",
        walls);
    if (to.when(shared.wall.distance.has_value()))
      add(second_wall_force, "second_wall_force_", "force", "component # of the force of the fluid on one period of the second wall", walls);
  }
  const auto add_force = [&](const std::string& name, const Vec3& force) {
    const std::string prefix = name.empty() ? "" : name + "/";
    add(force, prefix + "post_force_", "force", "component # of the force of the fluid on one period of the post", posts);
  };
  for (std::size_t k = 0; k < shared.posts.size(); ++k) add_force(shared.posts[k].name, k < post_forces.size() ? post_forces[k] : Vec3::Zero());
  if (shared.posts.empty() && to.when(false)) add_force({}, Vec3::Zero());
  if (!to.when(shared.wall.distance.has_value() || !shared.posts.empty())) return;
  add(mean_velocity, "mean_velocity_", "length/time",
      "component # of the velocity averaged over the periodic cell (between two walls, over the space between them), particles and posts "
      "included: flow rate divided by the area of the cross-section",
      both);
  if (to.when(shared.flow.pressure_gradient.has_value()))
    to.add(
        permeability,
        {"permeability",
         "length^2",
         "permeability, if Flow/pressure gradient is given: outer viscosity times the mean velocity opposite to this gradient, divided "
         "by its magnitude",
         "the pressure gradient is zero at this time",
         both});
}

SolidsRow solids_row(const SharedOptions& shared, const coupling::SolidScene& of, const stokes::AmbientFlow& ambient,
                     const PlatesAndPosts::Flow& flow, const Vec3& particle_force, const Vec3& velocity_integral) {
  const PlatesAndPosts& solids = *of.solids;
  const Vec3 gradient = ambient.change() * shared.flow.pressure_gradient.value_or(Vec3::Zero());
  std::vector<Vec3> forces = solids.forces(flow.force);
  SolidsRow row;
  double volume = solids.cell().volume();
  if (of.planes.empty()) {
    row.mean_velocity = ambient.velocity(Vec3::Zero()) + flow.drift;
  } else {
    const Vec3& n = of.planes.front().normal();
    Vec3 across = particle_force;  // force of particles and posts on the fluid; only its component along the wall normal n is used
    for (std::size_t k = of.planes.size(); k < forces.size(); ++k) across += forces[k];
    const Vec3 each = n.dot(across) / static_cast<double>(of.planes.size()) * n;
    const auto on_wall = [&](std::size_t k) -> Vec3 {
      const stokes::PlaneWall& wall = of.planes[k];
      return shared.flow.viscosity * volume * (ambient.gradient(wall.point()) * wall.normal()) - (forces[k] - n.dot(forces[k]) * n) + each;
    };
    row.wall_force = on_wall(0);
    if (of.planes.size() > 1) {
      row.second_wall_force = on_wall(1);
      const double distance = *shared.wall.distance;
      volume *= distance;
      const quadrature::GaussRule& rule = quadrature::gauss(2);
      for (int q = 0; q < 2; ++q)
        row.mean_velocity += rule.weights[q] * ambient.velocity(of.planes[0].point() + rule.nodes[q] * distance * n);
      row.mean_velocity += velocity_integral / volume;
    }
  }
  // In the integral equation, the pressure gradient also drives a fictitious flow inside the post. The force and the flow rate of this fictitious
  // flow are removed here.
  for (std::size_t k = 0; k < shared.posts.size(); ++k) {
    const Post& post = shared.posts[k];
    const Vec3 along = Vec3::Unit(post.axis);
    const double section = std::numbers::pi * post.radius * post.radius, length = period_of(post, solids.cell()).norm(), slope = gradient[post.axis];
    row.post_forces.push_back(-forces[of.planes.size() + k] + slope * section * length * along);
    row.mean_velocity += slope * section * post.radius * post.radius / (8 * shared.flow.viscosity) * length / volume * along;
  }
  if (gradient.norm() > 1e-12 * shared.flow.pressure_gradient.value_or(Vec3::Zero()).norm())
    row.permeability = -shared.flow.viscosity * row.mean_velocity.dot(gradient) / gradient.squaredNorm();
  return row;
}

}  // namespace tanktread
