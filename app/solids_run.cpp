// The flow through a periodic cell that contains plates or posts but no particles.

#include <utility>

#include "app/runs.hpp"
#include "record/plan.hpp"
#include "scene/series/run_row.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

int flow_past_solids(const Scene& scene, const RunRequest& request) {
  StationaryRun run(scene, request, "Particle/shape `cylinder`");
  run.show(plan(scene, run.ranks().size()));
  const coupling::SolidScene around = *make_solids(scene, run.phases());
  coupling::PlatesAndPosts& all = *around.solids;
  run.end_set_up();
  const stokes::AmbientFlow ambient(scene.flow);
  const coupling::PlatesAndPosts::Flow flow = coupling::without_particles(around, ambient);
  const Vec3 velocity_integral = coupling::solids_flow_integral(around, flow);
  RunRow row{.progress = {.wall_seconds = run.seconds()}};
  row.solids = solids_row(scene, around, ambient, flow, Vec3::Zero(), velocity_integral);
  row.domain = {.cell = all.cell().vectors(), .pressure_gradient = around.driving_gradient};
  Columns columns;
  row.add_columns(scene, columns);
  finish(columns);

  Body body;
  body.space = all.surface().space, body.rest = body.initial = body.unstressed = all.surface().net;
  const Net force = all.on_space(flow.force);
  const SurfaceSnapshot snapshot{body.rest, [&](const auto& nodes) { return std::vector<output::Field>{{"traction", -nodes.values(force)}}; }};
  Account account;
  account.summary.counts = {{"unknowns", 3L * all.surface().n_points()}};
  return run.record(body, columns, snapshot, std::move(account), run.ranks().of_all(all.evaluations()));
}

}  // namespace tanktread
