// A run in time: steps, snapshots, adaptation of meshes, and the reasons for which the run ends.

#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>

#include "app/runs.hpp"
#include "app/signals.hpp"
#include "app/time_steps.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/stop.hpp"
#include "motion/guarded.hpp"
#include "motion/integrator.hpp"
#include "record/files/checkpoint.hpp"
#include "record/files/progress.hpp"
#include "record/plan.hpp"
#include "record/results.hpp"
#include "scene/body.hpp"
#include "scene/member.hpp"
#include "scene/particles/gaps.hpp"
#include "scene/particles/particle_system.hpp"
#include "scene/particles/warnings.hpp"
#include "scene/plane_wall.hpp"
#include "scene/tube.hpp"
#include "system/parallel/agreement.hpp"
#include "system/parallel/stop_together.hpp"
#include "system/solids/shared_walls.hpp"
#include "system/solvers/krylov.hpp"

namespace tanktread {

namespace {

/// A time-dependent run, from its first to its last step.
class Run : AnyRun {
 public:
  Run(const Scene& scene, const RunRequest& request)
      : AnyRun(scene, request), particles_(make_particle_system(scene, ranks_, phases_)),
        results_(scene, request, particles_->body(), particles_->bezier(), ranks_), steps_(scene, *particles_) {
    ranks_.measure(phases_);
  }

  int go() {
    coupling::stop_together();
    print(plan(scene_, particles_->body(), ranks_.size()));
    begin();
    clock_.emplace(phases_, "time stepping");
    output::Progress progress(state_.time, scene_.time.final_time, !prints());
    std::string reason;
    while (reason.empty() && state_.time < scene_.time.final_time) {
      reason = step();
      if (interrupted_) break;
      progress.show({state_.time, totals_.step, steps_.report().iterations, first_.particle.rigid() ? 0 : row_.largest("taylor_inertia")});
      if (!reason.empty() || snapshot_due_) save_or_fail();
    }
    progress.close();
    if (results_.last_saved() != totals_.step) save_or_fail();
    clock_.reset();
    return end(reason);
  }

 private:
  void begin() {
    if (auto resumed = results_.resumed()) {
      resume(*resumed);
      return;
    }
    for (const Warning& warning : first_warnings(scene_)) warn(warning);
    state_.x = particles_->start();
    prepare();
    motion::GuardedDynamics motion(particles_->dynamics());
    motion::begin(motion, state_);
    if (!motion.failure().empty()) throw RunFailure("the evaluation of the velocity of the initial shape failed: " + motion.failure());
    state_.step = scene_.time.initial_step ? *scene_.time.initial_step : motion::first_step(motion, state_, scene_.time);
    record();
    collect_totals();
    save();
  }

  /// Adapts the initial mesh to thin films between particles, and between particles and a wall.
  void prepare() {
    if (!scene_.has_gaps() && !scene_.has_films_around_one()) return;
    for (int k = 0; k < 8 && particles_->adapt(state_, totals_); ++k) results_.remesh(particles_->body(), particles_->bezier());
  }

  void resume(Resumed& resumed) {
    if (particles_->resume(resumed)) results_.remesh(particles_->body(), particles_->bezier());
    state_ = resumed.state;
    if (scene_.time.final_time < state_.time)
      results_.warn(formatted("Time/final time %g is before the time %g that the run has reached: nothing was computed", scene_.time.final_time,
                              state_.time));
    if (request_.another_scheme) motion::forget(state_);
    totals_ = resumed.totals;
    earlier_wall_seconds_ = totals_.wall_seconds;
    warnings_.remember(totals_.warnings);
    earlier_seconds_ = totals_.seconds;
    particles_->forget();
    restore_counts();
  }

  /// Sets the counts of operations to those in totals_, so that operations since then do not count.
  void restore_counts() {
    particles_->set_counts(totals_.counts);
    const stokes::Evaluations here = kernel_evaluations(), all = totals_.kernel;
    earlier_kernel_ = {all.far - here.far, all.near - here.near, all.self - here.self};
  }

  /// Makes one step and records its row. Returns the reason to end the run early, or an empty text. If a stop signal arrives within the step or the
  /// step fails, discards the step. Throws RunFailure if the step fails.
  std::string step() {
    const motion::TimeState before = state_;
    const RunTotals totals = totals_;
    adapting_ = false;
    const std::string error = error_of([this] { advance(); });
    if (error.empty() && !interrupted_) {
      collect_totals();
      return reason_to_stop();
    }
    state_ = before;
    totals_ = totals;
    interrupted_ = true;
    within_step_.reset();
    const std::string undone = error_of([&] {
      if (!adapting_) return;
      particles_->undo_adapt(state_.x);
      results_.remesh(particles_->body(), particles_->bezier());
    });
    particles_->set_contacts(totals_.contacts);
    restore_counts();
    if (!error.empty()) fail(error);
    if (!undone.empty()) fail(undone);
    return reason_of_stop();
  }

  /// Runs `act`. Returns the error message if `act` fails on any rank, or an empty text if `act` succeeds or a stop signal interrupts it.
  std::string error_of(const std::function<void()>& act) {
    return coupling::failure_of_any([&] {
      try {
        act();
      } catch (const Stopped&) {
        interrupted_ = true;
      }
    });
  }

  void advance() {
    const double snapshot = scene_.next_snapshot(state_.time);
    const bool lands = scene_.lands_on_snapshots();
    motion::TimeState before = state_;
    within_step_.reset();
    steps_.advance(state_, lands ? snapshot : scene_.time.final_time, before);
    check_mesh();
    ++totals_.step;
    snapshot_due_ = state_.time >= snapshot * (1 - 1e-12);
    if (!lands && snapshot_due_ && state_.time > snapshot) interpolate_within(before);
    if (within_step_ && scene_.adapts()) {
      within_step_->sampled = sample();
      particles_->dynamics().set_time(state_.time, steps_.began());
    }
    adapting_ = true;
    adapt();
    for (const Warning& remark : particles_->remarks()) warn(remark);
    record();
  }

  /// Adapts the mesh if the adaptation criterion requires it. Then computes the velocity again: the loads on the new mesh differ, and steps that used
  /// the velocity of the old mesh were ten times shorter.
  void adapt() {
    if (!particles_->adapt(state_, totals_)) return;
    results_.remesh(particles_->body(), particles_->bezier());
    motion::GuardedDynamics motion(particles_->dynamics());
    motion.set_time(state_.time, steps_.began());  // if the flow jumps at the end of the step, the velocity before the jump
    state_.history = {motion.velocity(state_.x)};
    state_.slope_error = 0;
  }

  /// Returns the kernel evaluations of this part of the run on all ranks. Collective.
  stokes::Evaluations kernel_evaluations() const { return ranks_.of_all(particles_->kernel_evaluations() + scene_.walls->evaluations()); }

  void collect_counts() {
    totals_.counts = particles_->counts();
    totals_.kernel = earlier_kernel_ + kernel_evaluations();
  }

  /// Collects the totals of the run after a finished step, for a checkpoint: counts of operations, phase angle, contacts and warnings.
  void collect_totals() {
    collect_counts();
    totals_.phase_angle = particles_->phase_angle();
    totals_.contacts = particles_->contacts();
    totals_.warnings = warnings_.memory();
#ifndef NDEBUG
    if (!output::equal_on_all_ranks(state_)) fail("the states on the ranks are not identical");
#endif
  }

  void warn(const Warning& warning) {
    if (warnings_.fresh(warning)) results_.warn(warning);
  }

  [[noreturn]] void fail(const std::string& reason) {
    const std::string at = reason + formatted(" at time %.6g, step %d", state_.time, totals_.step), where = results_.directory().string();
    std::string unsaved;
    if (results_.last_saved() != totals_.step) unsaved = error_of([this] { save(); });
    error_of([&] { results_.close(account(output::run_status::failed + at), phases_); });
    if (unsaved.empty()) throw RunFailure(at + "; the checkpoint of the last good step is in " + where);
    throw RunFailure(at + formatted("; the newest checkpoint, of step %d, is in ", results_.last_saved()) + where +
                     ", because a newer one cannot be written: " + unsaved);
  }

  /// Interpolates the state at the latest snapshot time that the step has passed. The snapshot shows this state.
  void interpolate_within(const motion::TimeState& before) {
    double time = scene_.next_snapshot(before.time);
    for (double next = scene_.next_snapshot(time); next <= state_.time && next > time; next = scene_.next_snapshot(time)) time = next;
    const motion::DenseOutput dense(before, state_);
    motion::TimeState& state = within_step_.emplace().state;
    state.time = time, state.x = dense.state(time), state.history = {dense.slope(time)};
  }

  void record() {
    const auto clock = phases_.time("diagnostics");
    particles_->dynamics().set_time(state_.time, steps_.began());
    row_ = particles_->next_row(state_, {.step = steps_.report(), .wall_seconds = earlier_wall_seconds_ + seconds_here()});
    {
      const auto output = phases_.time("output");
      results_.record(row_);
    }
    warn_of_limits();
  }

  /// Computes the quality of the mesh. Throws RunFailure if an element is folded.
  void check_mesh() {
    if (first_.particle.rigid()) return;
    const auto clock = phases_.time("soundness");
    quality_ = soundness(particles_->bezier(), particles_->surface(state_.x), ranks_);
  }

  /// Prints a warning for each limit of validity that the last step has come close to.
  void warn_of_limits() {
    if (const std::string coarse = coarse_wall(scene_, particles_->body(), row_); !coarse.empty()) warn({"coarse wall", coarse});
    if (first_.particle.rigid()) return;
    const auto n_elements = static_cast<int>(particles_->body().space.elements.size());
    for (const Warning& warning : warnings_.of_step({first_, row_, quality_, n_elements})) results_.warn(warning);
  }

  void save() {
    const Meanwhile complete(stop_rules().answers, false);
    const auto clock = phases_.time("output");
    totals_.wall_seconds = earlier_wall_seconds_ + seconds_here();
    totals_.seconds = with_earlier(phases_, earlier_seconds_);
    const Results::Sampled snapshot = within_step_ && within_step_->sampled ? *within_step_->sampled : sample();
    if (!interrupted_) collect_counts();  // includes the evaluations of the snapshot, which the next row counts
    output::Checkpoint checkpoint;
    particles_->store(checkpoint);
    results_.save(std::move(checkpoint), state_, totals_, snapshot);
    coupling::Krylov::forget_recycled();
    particles_->forget();
  }

  /// Evaluates and returns the snapshot that is due, at the end of the last step or at a time within the step.
  Results::Sampled sample() {
    const motion::TimeState& shown = within_step_ ? within_step_->state : state_;
    particles_->dynamics().set_time(shown.time, steps_.began());
    return results_.sample(particles_->snapshot(shown), shown.time);
  }

  void save_or_fail() {
    const std::string error = error_of([this] { save(); });
    if (!error.empty()) fail(error);
  }

  /// Throws RunFailure if the gap between a particle and the wall is smaller than `contact_gap` times the least particle radius. `list` is the
  /// section of the wall in the deck.
  void end_at_wall(const std::string& list, double contact_gap) {
    const double gap = row_.value("gap"), least = contact_gap * scene_.least_radius();
    if (gap >= least) return;
    const auto* const system = particles_->capsule();
    const std::span<const coupling::Particle> particles = system ? system->particles() : std::span<const coupling::Particle>();
    fail(nearest_to_wall(scene_, particles_->body(), particles, particles_->surface(state_.x)) +
         formatted(" touches the wall: the gap is %.4g, less than %s/contact gap, %g R_C = %.4g,", gap, list.c_str(), contact_gap, least));
  }

  /// Throws RunFailure if two particles are so close that they count as touching.
  void end_at_contact() {
    const double gap = row_.value("smallest_gap"), least = scene_.contact.end() * scene_.least_radius();
    if (gap >= least) return;
    fail(touching(scene_, static_cast<int>(row_.value("first_of_gap")), static_cast<int>(row_.value("second_of_gap"))) +
         formatted(": the gap is %.4g, less than %.4g; Contact/limit is %g R_C,", gap, least, scene_.contact.limit));
  }

  /// Returns the reason to end the run after a finished step, or an empty text if it continues. Throws RunFailure if particles touch each other or a
  /// wall.
  std::string reason_to_stop() {
    if (scene_.tube.present) end_at_wall(scene_.tube.list(), scene_.tube.contact_gap);
    if (scene_.wall.present) end_at_wall("Wall", scene_.wall.contact_gap);
    if (scene_.has_gaps()) end_at_contact();
    const bool stops = coupling::any_stop_requested(stop_requested());
    const auto tolerance = scene_.time.steady_tolerance;
    const bool flow_changes = scene_.flow.history && scene_.flow.history->lasts(state_.time);
    if (tolerance && !flow_changes && row_.largest("shape_velocity") < *tolerance) return output::run_status::steady;
    if (scene_.time.end_when_past && least_axial_position(scene_, particles_->body(), row_) > *scene_.time.end_when_past)
      return output::run_status::past;
    if (!(state_.time < scene_.time.final_time)) return {};
    return stops ? reason_of_stop() : "";
  }

  Account account(const std::string& status) const {
    return {.summary = {.status = status, .counts = counts(totals_), .plan = plan(scene_, particles_->body(), ranks_.size())},
            .earlier = earlier_seconds_};
  }

  /// Closes the results and returns the exit code. `reason` is the reason for an early end, or empty.
  int end(const std::string& reason) {
    if (scene_.output.surface_text) results_.write_surface(particles_->snapshot(state_).surface);
    Account last = account(reason.empty() ? output::run_status::done : reason);
    const bool whole = output::reached_end(last.summary.status);
    if (!reason.empty() && !request_.of_ladder) last.remark = formatted("%s at time %g", spoken(reason).c_str(), state_.time);
    if (!whole && !request_.of_ladder) last.remark += "; --resume " + results_.directory().string() + " continues the run";
    const int code = results_.close(last, phases_);
    return whole ? code : Exit::stopped;
  }

  double earlier_wall_seconds_ = 0;  // wall time of the earlier parts of a resumed run
  std::unique_ptr<ParticleSystem> particles_;
  Results results_;
  TimeSteps steps_;
  motion::TimeState state_;
  RunTotals totals_;
  Columns row_;
  bool snapshot_due_ = false;
  bool adapting_ = false;     // true if the latest step has begun to adapt the mesh. If the step fails, the adaptation is undone
  bool interrupted_ = false;  // true if a step was interrupted and discarded
  stokes::Evaluations earlier_kernel_;        // kernel evaluations of the earlier parts of a resumed run
  output::Entries<double> earlier_seconds_;
  struct WithinStep {
    motion::TimeState state;
    std::optional<Results::Sampled> sampled;  // snapshot sampled on the previous mesh, if the latest step has adapted the mesh
  };
  std::optional<WithinStep> within_step_;  // state of the snapshot that is due at a time within the last step, if any
  surface::Quality quality_;
  ParticleScene first_ = scene_.first_deforming();
  Warnings warnings_{scene_};
};

}  // namespace

int simulate(const Scene& scene, const RunRequest& request) {
  check_vacant(request);
  if (scene.only_solids) return flow_past_solids(scene, request);
  if (scene.is_resistance_problem()) return resist(scene, request);
  if (!scene.runs_in_time()) return find_steady(scene, request);
  return Run(scene, request).go();
}

}  // namespace tanktread
