#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/runs.hpp"
#include "app/signals.hpp"
#include "base/errors.hpp"
#include "record/plan.hpp"
#include "scene/exact_body.hpp"
#include "scene/particles/adaptation.hpp"
#include "scene/particles/prescribed.hpp"
#include "scene/plane_wall.hpp"
#include "scene/series/series.hpp"
#include "scene/tube.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

namespace {

SurfaceSnapshot snapshot(const ParticleScene& scene, const Body& body, const RigidSolution& s) {
  const auto exact = exact_body(scene);
  return {body.rest, [&body, &s, exact](const auto& nodes) {
            const Net f = nodes.values(s.density), n = nodes.normals(body.rest), x = nodes.values(body.rest);
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

int resist(const Scene& whole, const RunRequest& request) {
  refuse(request.resume, "--resume", "Particle/motion `prescribed`", "a steady problem has no time steps to continue");
  const ParticleScene scene = whole.first();
  const auto start = std::chrono::steady_clock::now();
  coupling::Ranks ranks;
  Phases phases = started();
  std::optional<Phases::Scope> clock(std::in_place, phases, "set-up");
  Body body = tanktread::body(scene);
  refine_alone(scene, body, [&](const Body& on) {
    const std::unique_ptr<coupling::Tube> wall = tube(scene, on, phases);
    coupling::RigidTractions there = tractions_of(scene, on, ranks, wall.get());
    return rigid_solution(scene, on, there, phases).density;
  });
  const output::Entries<std::string> chosen = plan(whole, body, ranks.size());
  if (ranks.rank() == 0 && !request.quiet) std::fputs(plan_text(chosen).c_str(), stdout);
  const std::unique_ptr<coupling::Tube> around = tube(scene, body, phases);
  coupling::RigidTractions tractions = tractions_of(scene, body, ranks, around.get());
  clock.reset();
  stop_where_told(scene.output.too_late(ranks.seconds_since(start)));
  const RigidSolution solution = rigid_solution(scene, body, tractions, phases);
  stop_where_told();
  const double seconds = ranks.seconds_since(start);
  const stokes::Evaluations kernel = ranks.of_all(tractions.kernel_evaluations());
  Columns row;
  ProgressRow now{.wall_seconds = seconds};
  now.counts.solver_iterations = solution.iterations;
  now.add_columns(whole, row);
  PrescribedRow{solution, surface::measures(body.space, body.rest), body.space.n_points, static_cast<double>(kernel.total())}
      .add_columns(scene, row);
  if (around) tube_row(*around, body.flow, solution.density, solution.pressure_drop).add_columns(scene, row);
  if (const auto walls = scene.wall.planes(); !walls.empty()) wall_row(walls, body, body.rest).add_columns(whole, row);
  finish(row);

  Account account;
  account.plan = chosen;
  account.counts = {{"unknowns", 3L * body.space.n_points}, {"solver_iterations", solution.iterations}};
  account.vectors = {{"drag", solution.force}, {"torque", solution.torque}};
  return record_steady(whole, request, body, ranks, phases, row, snapshot(scene, body, solution), std::move(account), kernel);
}

int record_steady(const Scene& scene, const RunRequest& request, const Body& body, const coupling::Ranks& ranks, Phases& phases, Columns& row,
                  const SurfaceSnapshot& snapshot, Account account, const stokes::Evaluations& kernel) {
  std::optional<Phases::Scope> clock(std::in_place, phases, "output");
  Results results(scene, request, body, surface::BezierMap(body.space), ranks);
  results.record(row);
  if (const std::string coarse = coarse_wall(scene, body, row); !coarse.empty()) results.warn(coarse);
  motion::State state;
  state.x = body.rest;
  results.save({}, state, {}, results.sample(snapshot, state.time));
  clock.reset();
  for (const auto& [name, count] : {std::pair("far", kernel.far), {"near", kernel.near}, {"self", kernel.self}})
    account.counts.emplace_back(std::string("kernel_evaluations_") + name, static_cast<long>(count));
  return results.close(account, phases);
}

}  // namespace tanktread
