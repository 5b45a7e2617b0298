// The traction on a body with prescribed motion, and what runs of all kinds and runs without time steps have in common.

#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "app/runs.hpp"
#include "app/signals.hpp"
#include "base/errors.hpp"
#include "base/stop.hpp"
#include "record/plan.hpp"
#include "scene/exact_body.hpp"
#include "scene/particles/adaptation.hpp"
#include "scene/particles/prescribed.hpp"
#include "scene/series/run_row.hpp"
#include "surface/geometry.hpp"
#include "system/parallel/stop_together.hpp"
#include "system/solids/shared_walls.hpp"

namespace tanktread {

namespace {

SurfaceSnapshot snapshot(const ParticleScene& particle_scene, const Body& body, const RigidSolution& s) {
  const auto exact = exact_body(particle_scene);
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

AnyRun::AnyRun(const Scene& scene, const RunRequest& request) : scene_(scene), request_(request) {
  set_stop_request([this] { return stop_signal_received() || scene_.output.too_late(seconds_here()); });
}

AnyRun::~AnyRun() { set_stop_request(stop_signal_received); }

void AnyRun::print(const output::Entries<std::string>& plan) const {
  if (prints()) std::fputs(plan_text(plan).c_str(), stdout);
}

StationaryRun::StationaryRun(const Scene& scene, const RunRequest& request, const std::string& why) : AnyRun(scene, request) {
  refuse(request.resume, "--resume", why, "a steady problem has no time steps to continue");
}

void StationaryRun::show(output::Entries<std::string> plan) {
  plan_ = std::move(plan);
  print(plan_);
}

void StationaryRun::end_set_up() {
  clock_.reset();
  coupling::stop_together();
}

int StationaryRun::record(const Body& body, Columns& row, const SurfaceSnapshot& snapshot, Account account, const stokes::Evaluations& kernel,
                          std::span<const Warning> remarks) {
  const Meanwhile complete(stop_rules().answers, false);
  clock_.emplace(phases_, "output");
  Results results(scene_, request_, body, surface::BezierMap(body.space), ranks_);
  results.record(row);
  for (const Warning& remark : remarks) results.warn(remark);
  if (const std::string coarse = coarse_wall(scene_, body, row); !coarse.empty()) results.warn(coarse);
  motion::TimeState state;
  state.x = coupling::State(std::make_shared<coupling::Layout>(std::vector<coupling::Block>{{"shape", 0, body.rest.rows()}}));
  state.x(coupling::BlockId{0}) = body.rest;
  results.save({}, state, {}, results.sample(snapshot, state.time));
  if (scene_.output.surface_text) results.write_surface(body.rest);
  clock_.reset();
  account.summary.plan = plan_;
  each_kernel_count(kernel, [&](const char* name, auto, auto, auto count) { account.summary.counts.emplace_back(name, static_cast<long>(count)); });
  return results.close(account, phases_);
}

int resist(const Scene& scene, const RunRequest& request) {
  StationaryRun run(scene, request, "Particle/motion `prescribed`");
  const ParticleScene particle_scene = scene.first();
  Body body = make_body(particle_scene);
  const std::vector<Warning> remarks = refine_isolated_body(particle_scene, body, [&](const Body& on) {
    const std::unique_ptr<coupling::Tube> wall = make_tube(particle_scene, on, run.phases());
    coupling::RigidTractions there = make_tractions(particle_scene, on, run.ranks(), wall.get());
    return rigid_solution(particle_scene, on, there, run.phases()).density;
  });
  run.show(plan(scene, body, run.ranks().size()));
  const std::unique_ptr<coupling::Tube> around = make_tube(particle_scene, body, run.phases());
  coupling::RigidTractions tractions = make_tractions(particle_scene, body, run.ranks(), around.get());
  run.end_set_up();
  const RigidSolution solution = rigid_solution(particle_scene, body, tractions, run.phases());
  const double seconds = run.seconds();
  const stokes::Evaluations kernel = run.ranks().of_all(tractions.kernel_evaluations() + particle_scene.walls->evaluations());
  RunRow row{.progress = {.wall_seconds = seconds}};
  row.progress.counts.solver_iterations = solution.iterations;
  if (around) row.tube = tube_row(*around, body.flow, solution.density, solution.pressure_drop);
  if (scene.wall.present) row.wall = wall_row(scene.wall.planes(), body, body.rest);
  Columns columns;
  row.add_columns(scene, columns);
  PrescribedRow{solution, surface::measures(body.space, body.rest), body.space.n_points, static_cast<double>(kernel.total())}
      .add_columns(particle_scene, columns);
  finish(columns);

  Account account;
  account.summary.counts = {{"unknowns", 3L * body.space.n_points}, {"solver_iterations", solution.iterations}};
  account.summary.final_vectors = {{"drag", solution.force}, {"torque", solution.torque}};
  return run.record(body, columns, snapshot(particle_scene, body, solution), std::move(account), kernel, remarks);
}

}  // namespace tanktread
