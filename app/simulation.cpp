#include "app/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <numeric>
#include <new>
#include <optional>

#include "app/prescribed_run.hpp"
#include "app/signals.hpp"
#include "app/steady.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "motion/guarded.hpp"
#include "motion/integrator.hpp"
#include "record/files/progress.hpp"
#include "record/files/state.hpp"
#include "record/plan.hpp"
#include "record/results.hpp"
#include "scene/body.hpp"
#include "scene/member.hpp"
#include "scene/particles/gaps.hpp"
#include "scene/particles/particle_system.hpp"
#include "scene/particles/warnings.hpp"
#include "scene/plane_wall.hpp"
#include "scene/tube.hpp"
#include "system/agreement.hpp"
#include "system/kernel_count.hpp"

namespace tanktread {

namespace {

/// Why a run ends before its time, as its status says it.
const std::string by_signal = "stopped: by a signal", by_clock = "stopped: at the wall-clock limit", steady = "steady", past = "past";

/// Next multiple of the snapshot interval after `time`, or the final time.
double next_snapshot(const Scene& scene, double time) {
  const double interval = scene.snapshot_interval();
  const double next = (std::floor(time / interval * (1 + 1e-12)) + 1) * interval;
  return next < scene.time.final_time * (1 - 1e-12) ? next : scene.time.final_time;
}

/// Steps that do not land on snapshots are no longer than the time between two of them, so that each has its own step.
motion::TimeOptions time_options(const Scene& scene) {
  motion::TimeOptions time = scene.time;
  time.unit = 1 / scene.rate();
  if (!scene.lands_on_snapshots() && !time.fixed_step)
    time.maximum_step = std::min(scene.snapshot_interval(), time.maximum_step.value_or(scene.snapshot_interval()));
  return time;
}

/// Returns whether any mesh may change.
bool adapts(const Scene& scene) {
  return std::ranges::any_of(scene.alone(), [](const Scene& one) { return one.adaptation.enabled; });
}

/// Returns the scene of the first particle that deforms, as if it were alone; of the first one if all are rigid.
Scene first_deforming(const Scene& scene) {
  std::vector<Scene> all = scene.alone();
  const auto found = std::ranges::find_if(all, [](const Scene& one) { return !one.particle.rigid(); });
  return std::move(found == all.end() ? all.front() : *found);
}

/// A run between its first and its last step.
class Run {
 public:
  Run(const Scene& scene, const RunRequest& request)
      : scene_(scene), request_(request), particle_(particle_system(scene, ranks_, phases_)),
        results_(scene, request, particle_->body(), particle_->bezier(), ranks_),
        scheme_(motion::integrator(time_options(scene), scene.solvers.nox)) {
    ranks_.measure(phases_);
  }

  int go() {
    stop_where_told();
    if (ranks_.rank() == 0 && !request_.quiet) std::fputs(plan_text(plan(scene_, particle_->body(), ranks_.size())).c_str(), stdout);
    begin();
    clock_.emplace(phases_, "time stepping");
    output::Progress progress(state_.time, scene_.time.final_time, request_.quiet || ranks_.rank() != 0);
    std::string reason;
    while (reason.empty() && state_.time < scene_.time.final_time) {
      reason = step();
      if (interrupted_) break;
      progress.show({state_.time, totals_.step, report_.iterations, first_.particle.rigid() ? 0 : largest("taylor_inertia")});
      if (!reason.empty() || snapshot_due_) save_or_fail();
    }
    progress.close();
    if (results_.last_saved() != totals_.step) save_or_fail();
    clock_.reset();
    return end(reason);
  }

 private:
  using Clock = std::chrono::steady_clock;
  double seconds_here() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  void begin() {
    if (auto resumed = results_.resumed()) {
      resume(*resumed);
      return;
    }
    state_.x = particle_->start();
    prepare();
    motion::GuardedDynamics motion(particle_->dynamics(), told_to_stop);
    motion::begin(motion, state_);
    if (!motion.failure().empty()) throw RunFailure("the velocity of the initial shape cannot be had: " + motion.failure());
    state_.step = scene_.time.initial_step ? *scene_.time.initial_step : motion::first_step(motion, state_, scene_.time);
    record();
    settle();
    save();
  }

  /// Particles that start side by side need a mesh for the film between them.
  void prepare() {
    if (!scene_.has_gaps() && !scene_.wall.present) return;
    for (int k = 0; k < 8 && particle_->adapt(state_, totals_); ++k) results_.remesh(particle_->body(), particle_->bezier());
  }

  void resume(Resumed& resumed) {
    if (particle_->resume(resumed)) results_.remesh(particle_->body(), particle_->bezier());
    state_ = resumed.state;
    if (request_.another_scheme) motion::forget(state_);
    totals_ = resumed.totals;
    earlier_wall_seconds_ = totals_.wall_seconds;
    warnings_.remember(totals_.warnings);
    earlier_seconds_ = totals_.seconds;
    const stokes::Evaluations again = coupling::of_all(particle_->kernel_evaluations(), ranks_), before = totals_.kernel;
    earlier_kernel_ = {before.far - again.far, before.near - again.near, before.self - again.self};
  }

  /// One step and its row, or nothing of either where the run is stopped within it, or where it fails, which ends the run. Says why the run is to end
  /// before its time, if it is.
  std::string step() {
    const motion::State before = state_;
    const RunTotals totals = totals_;
    adapting_ = false;
    const std::string error = error_of([this] { advance(); });
    if (error.empty() && !interrupted_) {
      settle();
      return reason_to_stop();
    }
    state_ = before;
    totals_ = totals;
    interrupted_ = true;
    pictured_.reset();
    const std::string undone = error_of([&] {
      if (!adapting_) return;
      particle_->undo_adapt(state_.x);
      results_.remesh(particle_->body(), particle_->bezier());
    });
    particle_->hold_by(totals_.contacts);
    if (!error.empty()) fail(error);
    if (!undone.empty()) fail(undone);
    return by_signal;
  }

  /// What ends `act`, on any rank; empty where it comes to its end, or is told to stop.
  std::string error_of(const std::function<void()>& act) {
    std::string error;
    try {
      act();
    } catch (const motion::Stopped&) {
      interrupted_ = true;
    } catch (const UserError&) {
      throw;
    } catch (const std::bad_alloc&) {
      error = "there is not enough memory";
    } catch (const std::exception& exception) {
      error = exception.what();
    }
    return coupling::error_of_any(error);
  }

  void advance() {
    const double snapshot = next_snapshot(scene_, state_.time);
    const bool lands = scene_.lands_on_snapshots();
    motion::State before = state_;
    pictured_.reset();
    integrate(lands ? snapshot : scene_.time.final_time, before);
    judge();
    ++totals_.step;
    snapshot_due_ = state_.time >= snapshot * (1 - 1e-12);
    if (!lands && snapshot_due_ && state_.time > snapshot) picture_within(before);
    adapting_ = true;
    if (pictured_ && adapts(scene_)) pictured_->sampled = sample();
    adapt();
    for (const Warning& remark : particle_->remarks()) warn(remark);
    record();
  }

  /// Another mesh where the rule says so, with the velocity there: loads of a finer mesh are others, and steps that went on with the velocity of the
  /// mesh before were a tenth as long.
  void adapt() {
    if (!particle_->adapt(state_, totals_)) return;
    results_.remesh(particle_->body(), particle_->bezier());
    motion::GuardedDynamics motion(particle_->dynamics(), told_to_stop);
    state_.history.clear();
    motion::begin(motion, state_);
  }

  /// A step of the scheme; `before`: where it began, on this side of a kink of the motion.
  void integrate(double limit, motion::State& before) {
    motion::GuardedDynamics motion(particle_->dynamics(), told_to_stop);
    try {
      if (motion::cross_kink(motion, state_)) before = state_;
      if (!state_.history.front().allFinite()) throw RunFailure("there is no velocity to go on with");
      began_ = state_.time;
      advance_apart(motion, limit, before);
    } catch (const RunFailure& failure) {
      const std::string what = failure.what();
      const std::string& why = motion.failure();
      throw RunFailure(what + (why.empty() || why == what ? "" : " after a velocity that cannot be had: " + why));
    }
  }

  /// A step after which particles can be held apart, if they are to be.
  void advance_apart(motion::GuardedDynamics& motion, double limit, const motion::State& before) {
    for (int rejected = 0;; ++rejected) {
      report_ = scheme_->advance(motion, state_, limit);
      report_.rejected += rejected;
      if (particle_->hold_apart(state_, report_.step)) return;
      if (scene_.time.fixed_step) throw RunFailure("after a step of fixed size particles are too close for Contact/limiter to hold them apart");
      Net frozen = std::move(state_.frozen);
      state_ = before;
      if (state_.frozen.rows() != frozen.rows() || state_.frozen != frozen) state_.secants = {};  // they belong to the operators before
      state_.frozen = std::move(frozen);
      state_.step = report_.step / 2;
    }
  }

  /// What a step that is done leaves for a checkpoint.
  void settle() {
    totals_.work = particle_->work();
    totals_.phase_angle = particle_->phase_angle();
    totals_.contacts = particle_->contacts();
    totals_.kernel = earlier_kernel_ + coupling::of_all(particle_->kernel_evaluations(), ranks_);
    totals_.warnings = warnings_.memory();
#ifndef NDEBUG
    if (!output::equal_on_all_ranks(state_)) fail("the ranks hold states that are not the same to the bit");
#endif
  }

  /// Across a gap that is narrower than 0.6 of the wall's elements its traction is off by more than 1e-4.
  void warn_of_coarse_wall(double gap) {
    const double widest = particle_->body().wall->widest;
    if (gap > 0.6 * widest) return;
    warn({"coarse wall", formatted("at time %.4g the gap to the wall (%.2g) is narrower than 0.6 of the wall's elements (%.2g): set more "
                                   "%s/azimuthal elements and %s/axial elements",
                                   state_.time, gap, widest, scene_.tube.list().c_str(), scene_.tube.list().c_str())});
  }

  void warn(const Warning& warning) {
    if (warnings_.fresh(warning)) results_.warn(warning.sentence);
  }

  [[noreturn]] void fail(const std::string& reason) {
    const std::string at = reason + formatted(" at time %.6g, step %d", state_.time, totals_.step), where = results_.directory().string();
    std::string unsaved;
    if (results_.last_saved() != totals_.step) unsaved = error_of([this] { save(); });
    error_of([&] { results_.close(account("failed: " + at), phases_); });
    if (unsaved.empty()) throw RunFailure(at + "; the checkpoint of the last good step is in " + where);
    throw RunFailure(at + formatted("; the newest checkpoint, of step %d, is in ", results_.last_saved()) + where +
                     ", for a newer one cannot be had: " + unsaved);
  }

  /// The last snapshot's time within the step just made, and the state there.
  void picture_within(const motion::State& before) {
    double time = next_snapshot(scene_, before.time);
    for (double next = next_snapshot(scene_, time); next <= state_.time && next > time; next = next_snapshot(scene_, time)) time = next;
    const motion::DenseOutput dense(before, state_);
    motion::State& state = pictured_.emplace().state;
    state.time = time, state.x = dense.place(time), state.history = {dense.slope(time)};
  }

  void record() {
    const auto clock = phases_.time("diagnostics");
    particle_->dynamics().at(state_.time, began_);
    row_ = particle_->row(state_, {.step = report_, .wall_seconds = earlier_wall_seconds_ + seconds_here()});
    coupling::take_first(row_.values());  // what is decided by it is decided alike
    warn_of_limits();
    const auto output = phases_.time("output");
    results_.record(row_);
  }

  /// The mesh's quality. Throws RunFailure when an element is folded.
  void judge() {
    if (first_.particle.rigid()) return;
    const auto clock = phases_.time("soundness");
    quality_ = soundness(particle_->bezier(), state_.x, ranks_);
  }

  /// What the step has come near to.
  void warn_of_limits() {
    if (first_.particle.rigid()) return;
    StepFindings signs;
    signs.time = state_.time;
    signs.step = report_.step;
    signs.smallest_tension = smallest("smallest_tension");
    signs.compressed_area = largest("compressed_area");
    signs.volume_error = std::max(largest("volume_error"), -smallest("volume_error"));
    signs.jacobian_ratio = quality_.jacobian_ratio;
    signs.aspect_ratio = quality_.aspect_ratio;
    if (scene_.tube.present || (scene_.wall.present && !first_.adaptation.enabled)) signs.gap = row_.value("gap");
    const std::vector<double> areas = row_.of_particles("area");
    const auto n_elements = static_cast<double>(particle_->body().space.elements.size());
    signs.element = std::sqrt(std::accumulate(areas.begin(), areas.end(), 0.) / n_elements);
    for (const std::string& sentence : warnings_.sentences(signs)) results_.warn(sentence);
  }

  void save() {
    const auto clock = phases_.time("output");
    totals_.wall_seconds = earlier_wall_seconds_ + seconds_here();
    totals_.seconds = with_earlier(phases_, earlier_seconds_);
    const Results::Sampled picture = pictured_ && pictured_->sampled ? *pictured_->sampled : sample();
    if (pictured_) settle();  // the picture has taken work, and the next solution starts from its own
    output::Checkpoint checkpoint;
    particle_->store(checkpoint);
    results_.save(std::move(checkpoint), state_, totals_, picture);
    particle_->forget_recycled();
  }

  /// The picture that is due, of the last step's end or of a moment within.
  Results::Sampled sample() {
    const motion::State& pictured = pictured_ ? pictured_->state : state_;
    particle_->dynamics().at(pictured.time, began_);
    return results_.sample(particle_->picture(pictured), pictured.time);
  }

  void save_or_fail() {
    const std::string error = error_of([this] { save(); });
    if (!error.empty()) fail(error);
  }

  /// Of a particle with the wall, whose list in the deck this is.
  void end_at_wall(const std::string& list, double contact_gap) {
    const double gap = row_.value("gap"), least = contact_gap * scene_.least_radius();
    if (gap >= least) return;
    fail(formatted("a particle touches the wall: the gap is %.4g, less than %s/contact gap, %g R_C = %.4g,", gap, list.c_str(), contact_gap, least));
  }

  /// Of two of several particles.
  void end_at_contact() {
    const double gap = row_.value("smallest_gap"), least = scene_.contact.end() * scene_.least_radius();
    if (gap >= least) return;
    fail(touching(scene_, static_cast<int>(row_.value("first_of_gap")), static_cast<int>(row_.value("second_of_gap"))) +
         formatted(": the gap is %.4g, less than Contact/limit, %g R_C = %.4g,", gap, scene_.contact.limit, least));
  }

  /// After a step that is done.
  std::string reason_to_stop() {
    if (scene_.tube.present) {
      end_at_wall(scene_.tube.list(), scene_.tube.contact_gap);
      warn_of_coarse_wall(row_.value("gap"));
    }
    if (scene_.wall.present) end_at_wall("Wall", scene_.wall.contact_gap);
    if (scene_.has_gaps()) end_at_contact();
    if (coupling::largest(told_to_stop()) > 0) return by_signal;
    const auto limit = scene_.output.wall_clock_limit;
    if (limit && ranks_.first(seconds_here()) > *limit) return by_clock;
    const auto tolerance = scene_.time.steady_tolerance;
    if (tolerance && largest("shape_velocity") < *tolerance) return steady;
    if (scene_.time.end_when_past && least_way() > *scene_.time.end_when_past) return past;
    return {};
  }

  /// Along x1, or the centre line of a channel, of the centroid that has come least far.
  double least_way() const {
    const std::string name = scene_.in_system() ? "centroid_x" : "center_x";
    std::vector<double> x[3];
    for (int c = 0; c < 3; ++c) x[c] = entries(name + std::to_string(c + 1));
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < x[0].size(); ++p) {
      const auto& wall = particle_->body().wall;
      const bool bent = wall && wall->channel;
      least = std::min(least, bent ? wall->channel->coordinates({x[0][p], x[1][p], x[2][p]})[0] : x[0][p]);
    }
    return least;
  }

  Account account(const std::string& status) const {
    return {plan(scene_, particle_->body(), ranks_.size()), counts(totals_), status, {}, false, earlier_seconds_, {}, {}};
  }

  /// `reason`: to have ended before its time, if it did.
  int end(const std::string& reason) {
    if (scene_.output.surface_text) results_.write_surface(particle_->picture(state_).surface);
    Account last = account(reason.empty() ? "done" : reason);
    last.whole = reason.empty() || reason == steady || reason == past;
    if (!reason.empty()) last.remark = formatted("%s at time %g", spoken(reason).c_str(), state_.time);
    if (!last.whole) last.remark += "; --resume " + results_.directory().string() + " goes on";
    const int code = results_.close(last, phases_);
    return last.whole ? code : stopped;
  }

  /// A status without its colon.
  static std::string spoken(std::string status) {
    std::erase(status, ':');
    return status;
  }

  /// Of all particles that have it; 0 where none has.
  double smallest(std::string_view name) const { return std::ranges::min(entries(name)); }
  double largest(std::string_view name) const { return std::ranges::max(entries(name)); }
  std::vector<double> entries(std::string_view name) const {
    std::vector<double> all = row_.of_particles(name);
    if (all.empty()) all.push_back(0);
    return all;
  }

  const Scene& scene_;
  const RunRequest& request_;
  const Clock::time_point start_ = Clock::now();
  double earlier_wall_seconds_ = 0;  // of a resumed run
  Phases phases_ = started();
  std::optional<Phases::Scope> clock_{std::in_place, phases_, "set-up"};  // of what no other phase counts
  coupling::Ranks ranks_;
  std::unique_ptr<ParticleSystem> particle_;
  Results results_;
  std::unique_ptr<motion::Integrator> scheme_;
  motion::State state_;
  motion::StepReport report_;
  double began_ = 0;  // the last step
  RunTotals totals_;
  Columns row_;
  bool snapshot_due_ = false;
  bool adapting_ = false;     // within a step, or done with it
  bool interrupted_ = false;  // within a step, of which nothing is kept
  stokes::Evaluations earlier_kernel_;        // in earlier parts of the run
  output::Entries<double> earlier_seconds_;
  struct Pictured {
    motion::State state;
    std::optional<Results::Sampled> sampled;  // before the mesh changes
  };
  std::optional<Pictured> pictured_;  // where a snapshot is due within the last step
  surface::Quality quality_;
  Scene first_ = first_deforming(scene_);
  Warnings warnings_{first_};  // of several particles by the numbers of the first that deforms
};

}  // namespace

int simulate(const Scene& scene, const RunRequest& request) {
  check_vacant(request);
  if (!scene.in_system() && scene.particle.motion == Motion::prescribed) return resist(scene, request);
  if (!scene.runs_in_time()) return find_steady(scene, request);
  return Run(scene, request).go();
}

}  // namespace tanktread
