#include <chrono>
#include <cstdio>
#include <optional>

#include "app/runs.hpp"
#include "app/signals.hpp"
#include "base/errors.hpp"
#include "record/plan.hpp"
#include "scene/series/series.hpp"
#include "scene/solids.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

int flow_past_solids(const Scene& scene, const RunRequest& request) {
  refuse(request.resume, "--resume", "Particle/shape `cylinder`", "a steady problem has no time steps to continue");
  const auto start = std::chrono::steady_clock::now();
  coupling::Ranks ranks;
  Phases phases = started();
  std::optional<Phases::Scope> clock(std::in_place, phases, "set-up");
  const output::Entries<std::string> chosen = plan(scene, ranks.size());
  if (ranks.rank() == 0 && !request.quiet) std::fputs(plan_text(chosen).c_str(), stdout);
  const coupling::SolidScene around = *solids(scene, phases);
  coupling::Solids& all = *around.solids;
  clock.reset();
  stop_where_told(scene.output.too_late(ranks.seconds_since(start)));
  const stokes::AmbientFlow ambient(scene.flow);
  const coupling::Solids::Flow flow = coupling::without_particles(around, ambient);
  const Vec3 velocity_integral = coupling::velocity_integral(around, flow);
  Columns row;
  ProgressRow{.wall_seconds = ranks.seconds_since(start)}.add_columns(scene, row);
  solids_row(scene, around, ambient, flow, Vec3::Zero(), velocity_integral).add_columns(scene, row);
  DomainRow now{.cell = all.cell().vectors(), .pressure_gradient = around.driving_gradient};
  now.add_columns(scene, row);
  finish(row);

  Body body;
  body.space = all.surface().space, body.rest = body.initial = body.unstressed = all.surface().net;
  const Net force = all.on_space(flow.force);
  const SurfaceSnapshot snapshot{body.rest, [&](const auto& nodes) { return std::vector<output::Field>{{"traction", -nodes.values(force)}}; }};
  Account account;
  account.plan = chosen;
  account.counts = {{"unknowns", 3L * all.surface().n_points()}};
  return record_steady(scene, request, body, ranks, phases, row, snapshot, std::move(account), ranks.of_all(all.evaluations()));
}

}  // namespace tanktread
