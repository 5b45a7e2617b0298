#include "app/carrying_particle.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "app/series.hpp"
#include "coupling/power_balance.hpp"

namespace tanktread {

void CarryingParticle::carry(membrane::Carried& carried) {
  carried_ = &carried;
  take_particle();
}

void CarryingParticle::take_particle() { motion_.emplace(static_cast<coupling::Capsule&>(particle_->dynamics()), *carried_); }

motion::State CarryingParticle::of_particle(const motion::State& state) const {
  motion::State own = state;
  own.x = motion_->shape(state.x);
  for (Net& slope : own.history) slope = motion_->shape(slope);
  return own;
}

bool CarryingParticle::resume(Resumed& resumed) {
  motion::State whole = std::exchange(resumed.state, of_particle(resumed.state));
  const bool another_mesh = particle_->resume(resumed);
  resumed.state = std::move(whole);
  take_particle();
  return another_mesh;
}

bool CarryingParticle::adapt(motion::State& state, RunTotals& totals) {
  motion::State own = of_particle(state);
  const bool another_mesh = particle_->adapt(own, totals);
  state.x = motion_->with_shape(state.x, own.x);
  for (std::size_t k = 0; k < state.history.size(); ++k) state.history[k] = motion_->with_shape(state.history[k], own.history[k]);
  return another_mesh;
}

std::size_t CarryingParticle::column(std::string_view name) const {
  const std::vector<Series> all = run_series(scene_);
  const auto found = std::ranges::find(all, name, &Series::name);
  if (found == all.end()) throw std::logic_error("a run without the series " + std::string(name));
  return static_cast<std::size_t>(found - all.begin());
}

std::vector<double> CarryingParticle::row(const motion::State& state, const motion::StepReport& report, double wall_seconds) {
  const motion::State own = of_particle(state);
  const Eigen::VectorXd q = motion_->content(state.x);
  const auto& capsule = static_cast<coupling::Capsule&>(particle_->dynamics());
  if (!capsule.evaluated_about(own.x, scene_.time.tolerance)) motion_->place(state.x);  // else what the step evaluated last serves the row
  std::vector<double> row = particle_->row(own, report, wall_seconds);
  carried_->place(own.x, q);
  row[column("energy")] += carried_->energy();
  if (scene_.output.power_balance) own_power(row, own);
  complete(row, q);
  return row;
}

/// What is carried drives the particle from outside as far as that knows: its power is of no force, but the surface's own.
void CarryingParticle::own_power(std::vector<double>& row, const motion::State& own) {
  auto& capsule = static_cast<coupling::Capsule&>(particle_->dynamics());
  const Net velocity = capsule.slides() ? capsule.fluid_velocity(own.x) : own.history.front();
  double &forces = row[column("force_power")], &residual = row[column("power_residual")];
  const double flow = row[column("flow_power")], fluids = row[column("fluid_dissipation")], before = coupling::turnover(flow, forces, fluids);
  forces += carried_->load().cwiseProduct(velocity).sum();
  if (const double all = coupling::turnover(flow, forces, fluids); all > 0) residual *= before / all;
}

SurfacePicture CarryingParticle::picture(const motion::State& state) {
  motion_->place(state.x);
  pictured_ = of_particle(state);
  SurfacePicture picture = particle_->picture(pictured_);
  complete(picture);
  return picture;
}

}  // namespace tanktread
