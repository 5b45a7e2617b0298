#include "app/body.hpp"

#include <utility>

#include "app/initial_shape.hpp"
#include "app/member.hpp"
#include "app/numbers.hpp"
#include "app/prescribed.hpp"
#include "app/tube.hpp"
#include "base/formatted.hpp"
#include "coupling/frozen_operator.hpp"
#include "spline/extraction.hpp"
#include "stokes/layer_surface.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"

namespace tanktread {

namespace {

membrane::Law law(const membrane::Options& options, double modulus) {
  if (options.law == "Skalak") return membrane::Skalak{modulus, options.area_dilatation.value_or(1.0)};
  if (options.law == "surface tension") return membrane::SurfaceTension{modulus};
  return membrane::NeoHookean{modulus};
}

}  // namespace

void lay_out(const Scene& scene, spline::TMesh mesh, Body& body) {
  body.mesh = std::move(mesh);
  if (scene.surface.polar()) {
    const spline::PolarMesh polar = scene.surface.polar_mesh();
    body.space = spline::space(body.mesh, polar.poles, polar.subdivisions);
    if (scene.adaptation.enabled && polar.poles == spline::PoleRule::bezier_transform)
      body.plain = std::make_shared<const spline::Space>(spline::space(body.mesh, spline::PoleRule::plain));
  } else {
    const bool g1 = scene.surface.extraordinary_points == "g1";
    body.space = spline::space(body.mesh, g1 ? spline::ExtraordinaryRule::g1 : spline::ExtraordinaryRule::catmull_clark);
  }
}

Body body(const Scene& scene) {
  Body b;
  const int levels = scene.adaptation.enabled ? scene.adaptation.levels : 0;
  if (const auto& imported = scene.particle.shape.imported) {
    b.space = imported->space;
    b.rest = surface::imported_shape(scene.particle.shape);
  } else if (scene.surface.polar()) {
    const spline::PolarMesh mesh = scene.surface.polar_mesh();
    lay_out(scene, spline::polar(mesh.azimuthal, mesh.meridional, levels), b);
    b.rest = surface::initial_shape(b.space, mesh, scene.surface.axis(), scene.particle.shape);
  } else {
    lay_out(scene, spline::cube(scene.surface.elements_per_side.value(), levels), b);
    b.rest = surface::initial_shape(b.space, b.mesh, scene.particle.shape);
  }
  const auto before = run_before(scene);
  if (before && scene.adaptation.enabled) {
    lay_out(scene, stored_mesh(b.mesh, *before), b);
    b.rest = before->arrays.at("initial");
  }
  b.initial = initial_shape(scene, b, before ? &*before : nullptr);
  b.unstressed = membrane::unstressed(b.rest, scene.particle.shape.center, scene.membrane.pre_inflation);
  b.duct = duct(scene);
  b.flow = stokes::AmbientFlow(scene.flow, scene.flow.type == "duct" ? b.duct : nullptr);
  b.plane = flow_plane(scene.flow);
  b.radius = scene.radius();
  b.modulus = scene.modulus();
  b.law = law(scene.membrane, b.modulus);
  check_fit(scene, b);
  if (scene.name.empty()) b.wall = wall(scene, b);
  b.symmetry = symmetry(scene, b, b.initial);
  const bool own = scene.particle.shape.initial && scene.particle.shape.initial->volume == "own";
  b.volume = surface::measures(b.space, own ? b.initial : b.rest).volume;
  return b;
}

surface::Symmetry symmetry(const Scene& scene, const Body& body, const Net& x) {
  if (scene.particle.rigid() || body.wall) return surface::Symmetry(body.space.n_points);
  const Net* nets[] = {&body.unstressed, &body.rest, &x};
  return coupling::symmetry(scene.symmetry, body.space, nets, body.flow, scene.body_force());
}

stokes::Measure load_measure(const Scene& scene) {
  const bool reference =
      scene.membrane.load == "weak" && scene.membrane.load_measure == "reference" && scene.membrane.law != "surface tension";
  return reference ? stokes::Measure::reference : stokes::Measure::current;
}

std::string unbounded_flow(const Scene& scene) {
  return scene.flow.type + (scene.flow.history ? ", changing in time" : "") + ", unbounded: no wall unknowns, no pressure drop";
}

namespace {

/// Lines that are of one of several particles, or of the only one.
std::string viscosity_line(const Scene& scene, int n_points, bool tree) {
  if (scene.particle.viscosity_ratio == 1) return "ratio 1: no double layer, no system for the velocity";
  return formatted("ratio %g: double layer %s, a system of %d unknowns a velocity", scene.particle.viscosity_ratio,
                   scene.solvers.assembled(tree) ? "assembled" : "matrix-free", 3 * n_points);
}

std::string membrane_line(const Scene& scene) {
  const bool reference = scene.membrane.load_measure == "reference";
  return scene.membrane.law + ", load " + scene.membrane.load +
         (scene.load_is_strong()                    ? " at the collocation sites (P-3)"
          : scene.membrane.law == "surface tension" ? " per current area (3.6)"
          : reference                               ? " per unstressed area (3.7), mass matrix factored once"
                                                    : " per current area (3.6), mass matrix factored every evaluation");
}

std::string mesh_line(const Scene& scene) {
  if (!scene.adaptation.enabled) return "fixed";
  return scene.adaptation.indicator == "error" ? "refined as the particle deforms, by estimated errors (1.5)"
                                               : "refined as the particle deforms (P-37)";
}

std::string time_line(const Scene& scene, double points, int n_evaluated, int ranks) {
  const bool implicit = scene.time.assembles() || scene.time.scheme == "auto";
  return scene.time.scheme + (scene.time.scheme == "auto" ? ", bs3 or tr-bdf2 by the measured stiffness" : "") +
         (!implicit ? std::string(", explicit in the fluid: nothing is assembled")
          : scene.solvers.frozen_operator == "nodal"
              ? std::string(", frozen single layer by one node a control point, not assembled")
              : formatted(", frozen single layer of %.1f MB on %d rank%s", 1e-6 * coupling::FrozenOperator::bytes_a_pair * points * n_evaluated,
                          ranks, ranks > 1 ? "s" : ""));
}

std::string rigid_line(const Scene& scene, int n_points) {
  return formatted("rigid, %s: no membrane, no mesh that moves; a double layer, in a system of %d unknowns a velocity (2.23)",
                   scene.particle.motion == "free" ? "free" : "moving as told", 3 * n_points);
}

output::Entries<std::string> plan_of_several(const Scene& scene, const Body& all, int ranks) {
  const bool tree = stokes::sums_by_tree(all.space, scene.quadrature);
  output::Entries<std::string> lines = {{"particles", formatted("%d, in one system", static_cast<int>(scene.particles.size()))},
                                        {"surface", formatted("%d control points, %d elements in all", all.space.n_points,
                                                              static_cast<int>(all.space.elements.size()))},
                                        {"far sum", tree ? "by clusters of nodes and targets" : "every target meets every node"},
                                        {"volume", scene.volume.constraint + ", of each"},
                                        {"time", time_line(scene, all.space.n_points, all.space.n_points, ranks)},
                                        {"symmetry", "none looked for among several particles"}};
  const output::Entries<std::string> fluid = all.wall ? tube_plan(scene, all, ranks) : output::Entries<std::string>{{"flow", unbounded_flow(scene)}};
  lines.insert(lines.begin() + 2, fluid.begin(), fluid.end());
  std::string last;
  for (const Scene& one : scene.alone()) {
    const std::string line = one.particle.rigid() ? rigid_line(one, all.space.n_points)
                             : membrane_line(one) + "; " + viscosity_line(one, all.space.n_points, tree) + "; mesh " + mesh_line(one);
    if (lines.back().second == line)
      last = " … " + one.name;
    else
      lines.back().first += std::exchange(last, {}), lines.emplace_back(one.name, line);
  }
  lines.back().first += last;
  return lines;
}

}  // namespace

output::Entries<std::string> plan(const Scene& scene, const Body& body, int ranks) {
  if (!scene.particles.empty()) return plan_of_several(scene, body, ranks);
  if (scene.particle.rigid()) return rigid_plan(scene, body, ranks);
  const double points = body.space.n_points;
  const int n_evaluated = static_cast<int>(body.symmetry.fundamental().size());
  const bool tree = stokes::sums_by_tree(body.space, scene.quadrature);
  output::Entries<std::string> fluid = {{"flow", unbounded_flow(scene)}};
  if (body.wall) fluid = tube_plan(scene, body, ranks);
  output::Entries<std::string> lines = {
      {"surface", formatted("%d control points, %d elements: %s", body.space.n_points, static_cast<int>(body.space.elements.size()),
                            body.space.description.c_str())},
      {"unknowns", formatted("%d positions", 3 * body.space.n_points)},
      {"viscosity", viscosity_line(scene, body.space.n_points, tree)},
      {"membrane", membrane_line(scene)},
      {"deformation", body.plane.description()},
      {"numbers", numbers_text(numbers(scene, body))},
      {"far sum", tree ? "by clusters of nodes and targets, to the tolerance of the quadrature" : "every target meets every node"},
      {"volume", scene.volume.constraint},
      {"time", time_line(scene, points, n_evaluated, ranks)},
      {"mesh", mesh_line(scene)},
      {"symmetry", body.symmetry.order() == 1
                       ? std::string("none") + (scene.symmetry.use == "none" ? " used"
                                                : body.wall                  ? " looked for in a tube"
                                                                             : " found")
                       : body.symmetry.description() + formatted(": %d of %d control points evaluated, %.2g times less; whatever would break "
                                                                 "it is left out (Symmetry/use)",
                                                                 n_evaluated, body.space.n_points, points / n_evaluated)},
  };
  lines.insert(lines.begin() + 2, fluid.begin(), fluid.end());
  return lines;
}

}  // namespace tanktread
