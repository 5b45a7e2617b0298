#include "app/prescribed.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <optional>

#include "app/results.hpp"
#include "app/signals.hpp"
#include "app/tube.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "coupling/kernel_count.hpp"
#include "coupling/rigid_body.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

namespace {

/// What the integrals of a density lack of the forces on the fluid: three components of the force, three of the torque.
Eigen::VectorXd reciprocal_correction(coupling::Resistance& body, const Net& u, const Net& f, const Vec3& centre) {
  std::vector<Net> z;
  for (int k = 0; k < 6; ++k) {
    coupling::RigidMotion unit;
    (k < 3 ? unit.velocity : unit.angular_velocity) = Vec3::Unit(k % 3);
    z.push_back(body.force_density(coupling::rigid_velocity(body.surface(), unit, centre)));
  }
  return body.residual_work(u, f, z);
}

double relative(const Vec3& value, const Vec3& exact) { return exact.norm() > 0 ? (value - exact).norm() / exact.norm() : RigidSolution::unknown; }

}  // namespace

RigidSolution rigid_solution(const Scene& scene, const Body& body, coupling::Resistance& resistance, Phases& phases, const coupling::Tube* tube) {
  const Vec3& centre = scene.particle.shape.center;
  const coupling::RigidMotion motion{scene.particle.velocity.value_or(Vec3::Zero()), scene.particle.angular_velocity.value_or(Vec3::Zero())};
  Net u = coupling::rigid_velocity(body.rest, motion, centre);
  if (body.flow.affine())
    for (Eigen::Index a = 0; a < u.rows(); ++a) u.row(a) -= body.flow.velocity(body.rest.row(a).transpose()).transpose();
  else
    u -= resistance.ambient(body.flow);

  RigidSolution s;
  s.density = resistance.force_density(u);
  s.iterations = resistance.last_iterations();
  s.integral = s.force = -resistance.force(s.density);
  s.torque = -resistance.torque(s.density, centre);
  if (scene.reciprocal_forces()) {
    const Eigen::VectorXd lacking = reciprocal_correction(resistance, u, s.density, centre);
    s.force -= lacking.head<3>();
    s.torque -= lacking.tail<3>();
  }
  if (tube) {
    s.pressure_drop = resistance.pressure_drop(s.density);
    s.gap = tube->gap();
    return s;
  }
  if (const auto exact = exact_body(scene, motion)) {
    const auto clock = phases.time("diagnostics");
    s.error = relative(s.force, exact->force());
    s.integral_error = relative(s.integral, exact->force());
    s.torque_error = relative(s.torque, exact->torque());
    s.surface = surface_errors(body.space, body.rest, s.density, *exact);
  }
  return s;
}

const std::vector<Column>& prescribed_columns() {
  static const std::vector<Column> all = [] {
    std::vector<Column> list = {{"time", "time", "the problem is steady"},
                                {"drag_x1", "force", "force on the particle, component 1"},
                                {"drag_x2", "force", "force on the particle, component 2"},
                                {"drag_x3", "force", "force on the particle, component 3"},
                                {"torque_x1", "force length", "torque on the particle about its centre, component 1"},
                                {"torque_x2", "force length", "torque on the particle about its centre, component 2"},
                                {"torque_x3", "force length", "torque on the particle about its centre, component 3"},
                                {"drag_error", "1", "|F - F_exact|/|F_exact|"},
                                {"drag_error_of_traction", "1", "the same, of the integral of the traction alone"},
                                {"torque_error", "1", "|T - T_exact|/|T_exact|"},
                                {"pressure_l2_error", "1", "L2 norm of p - p_exact over that of p_exact, p = -t.n"},
                                {"normal_l2_error", "1", "L2 norm of n_h - n over that of n"},
                                {"solver_iterations", "1", "iterations of the linear solver for the traction"},
                                {"kernel_evaluations", "1", "of the layer operator, all rules together"}};
    std::ranges::copy(named(tube_columns(), {"disturbed_pressure_drop", "gap"}), std::back_inserter(list));
    std::ranges::copy(named(columns(), {"stresslet_11", "stresslet_22", "stresslet_33", "stresslet_12", "stresslet_13", "stresslet_23", "volume",
                                        "area", "n_control_points", "wall_seconds"}),
                      std::back_inserter(list));
    return list;
  }();
  return all;
}

namespace {

/// The columns that this body has, and their values side by side.
struct Row {
  std::vector<Column> columns;
  std::vector<double> values;
};

Row row(const Scene& scene, const Body& body, const coupling::Resistance& resistance, const RigidSolution& s,
        const stokes::Evaluations& kernel, double seconds) {
  const surface::Measures measures = surface::measures(body.space, body.rest);
  const Mat3 stresslet = -resistance.stresslet(s.density, scene.particle.shape.center);
  const Vec3 &f = s.force, &t = s.torque;
  const double values[] = {0, f[0], f[1], f[2], t[0], t[1], t[2], s.error, s.integral_error, s.torque_error, s.surface.pressure, s.surface.normal,
                           static_cast<double>(s.iterations), static_cast<double>(kernel.total()), s.pressure_drop, s.gap,
                           stresslet(0, 0), stresslet(1, 1), stresslet(2, 2), stresslet(0, 1), stresslet(0, 2), stresslet(1, 2),
                           measures.volume, measures.area, static_cast<double>(body.space.n_points), seconds};
  Row row;
  for (size_t k = 0; k < std::size(values); ++k) {
    if (std::isnan(values[k])) continue;
    row.columns.push_back(prescribed_columns()[k]);
    row.values.push_back(values[k]);
  }
  return row;
}

Portrait portrait(const Scene& scene, const Body& body, const RigidSolution& s) {
  const coupling::RigidMotion motion{scene.particle.velocity.value_or(Vec3::Zero()), scene.particle.angular_velocity.value_or(Vec3::Zero())};
  return {body.rest, [&body, &s, exact = body.wall ? std::nullopt : exact_body(scene, motion)](const auto& nodes, output::NodeRange range) {
            const Net f = nodes.values(s.density, range), n = nodes.normals(body.rest, range), x = nodes.values(body.rest, range);
            const Eigen::VectorXd pressure = f.cwiseProduct(n).rowwise().sum().array() + s.surface.constant;
            std::vector<output::Field> fields = {{"traction", -f}, {"pressure", pressure}};
            if (exact) {
              Eigen::VectorXd error(pressure.size());
              for (Eigen::Index i = 0; i < error.size(); ++i) error[i] = pressure[i] - exact->pressure(x.row(i).transpose());
              fields.push_back({"pressure error", error});
            }
            return fields;
          }};
}

}  // namespace

output::Entries<std::string> rigid_plan(const Scene& scene, const Body& body, int ranks) {
  const bool free = scene.particle.motion == "free";
  output::Entries<std::string> fluid = {{"flow", scene.flow.type + ", unbounded: no wall unknowns, no pressure drop"}};
  if (body.wall) fluid = tube_plan(scene, body, ranks);
  output::Entries<std::string> lines =
         {{"surface", std::to_string(body.space.n_points) + " control points: " + body.space.description},
          {"unknowns", formatted("%d of the traction: single layer of the first kind, its null space made regular", 3 * body.space.n_points)},
          {"particle", free && body.wall ? "rigid and free, no membrane: its motion is solved for with the traction, at each place"
                       : free ? "rigid and free, no membrane: six rigid motions and five strains, solved once, are all that it can meet"
                            : "rigid, its motion prescribed: no membrane, nothing moves in time"},
          {"forces", free                                   ? "none"
                     : scene.reciprocal_forces() ? "corrected by the reciprocal theorem: six more solves"
                                                             : "integrals of the traction"},
          {"time", free ? scene.time.scheme + " for centre and orientation" : "steady"},
          {"assembled", formatted("%.1f MB on %d rank%s", 72e-6 * body.space.n_points * body.space.n_points, ranks, ranks > 1 ? "s" : "")},
          {"symmetry", "none used"}};
  lines.insert(lines.begin() + 2, fluid.begin(), fluid.end());
  return lines;
}

int resist(const Scene& scene, const RunRequest& request) {
  if (request.resume)
    throw UserError("--resume and Particle/motion `prescribed` contradict each other: a steady problem has nothing to go on with.");
  const auto start = std::chrono::steady_clock::now();
  coupling::Ranks ranks;
  Phases phases = started();
  std::optional<Phases::Scope> clock(std::in_place, phases, "set-up");
  const Body body = tanktread::body(scene);
  const output::Entries<std::string> chosen = rigid_plan(scene, body, ranks.size());
  if (ranks.rank() == 0 && !request.quiet) std::fputs(plan_text(chosen).c_str(), stdout);
  const std::unique_ptr<coupling::Tube> around = tube(scene, body, phases);
  coupling::Resistance resistance(body.space, body.rest, scene.flow.viscosity, scene.quadrature, scene.solvers, ranks, phases, around.get());
  clock.reset();
  stop_where_told();
  const RigidSolution solution = rigid_solution(scene, body, resistance, phases, around.get());
  stop_where_told();
  const double seconds = ranks.first(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  const stokes::Evaluations kernel = coupling::of_all(resistance.kernel_evaluations(), ranks);
  const Row only = row(scene, body, resistance, solution, kernel, seconds);

  clock.emplace(phases, "output");
  Results results(scene, request, body, surface::BezierMap(body.space), only.columns, ranks);
  results.record(only.values);
  motion::State state;
  state.x = body.rest;
  results.save(state, {}, portrait(scene, body, solution), state.time);
  clock.reset();
  Account account;
  account.plan = chosen;
  account.counts = {{"unknowns", 3L * body.space.n_points},
                    {"solver_iterations", solution.iterations},
                    {"solver_iterations_in_all", resistance.solver_iterations()},
                    {"kernel_evaluations_far", static_cast<long>(kernel.far)},
                    {"kernel_evaluations_near", static_cast<long>(kernel.near)},
                    {"kernel_evaluations_self", static_cast<long>(kernel.self)}};
  account.vectors = {{"drag", solution.force}, {"torque", solution.torque}};
  return results.close(account, phases);
}

}  // namespace tanktread
