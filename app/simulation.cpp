#include "app/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <sstream>

#include "app/adaptation.hpp"
#include "app/body.hpp"
#include "app/diagnostics.hpp"
#include "app/results.hpp"
#include "base/errors.hpp"
#include "motion/integrator.hpp"
#include "output/checkpoint.hpp"
#include "output/progress.hpp"

namespace tanktread {

namespace {

volatile std::sig_atomic_t asked_to_stop = 0;

void heed_signals() {
  asked_to_stop = 0;
  for (const int signal : {SIGTERM, SIGINT}) std::signal(signal, [](int) { asked_to_stop = 1; });
}

/// Wall clock of this run, earlier parts of a resumed one included.
class Watch {
 public:
  double here() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  double seconds() const { return before_ + here(); }
  void add(double before) { before_ += before; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  double before_ = 0;
};

output::Entries<long> counts(const Standing& standing, const coupling::Work& work, const stokes::Evaluations& kernel) {
  return {{"steps", standing.step},
          {"refinements", standing.refinements},
          {"coarsenings", standing.coarsenings},
          {"evaluations", work.evaluations},
          {"assemblies", work.assemblies},
          {"tangents", work.tangents},
          {"linear_solves", work.solves},
          {"solver_iterations", work.solver_iterations},
          {"velocity_iterations", work.velocity_iterations},
          {"kernel_evaluations_far", static_cast<long>(kernel.far)},
          {"kernel_evaluations_near", static_cast<long>(kernel.near)},
          {"kernel_evaluations_self", static_cast<long>(kernel.self)}};
}

/// Next multiple of the snapshot interval after `time`, or the final time.
double next_stop(const Scene& scene, double time) {
  const double interval = scene.snapshot_interval();
  const double next = (std::floor(time / interval * (1 + 1e-12)) + 1) * interval;
  return next < scene.time.final_time * (1 - 1e-12) ? next : scene.time.final_time;
}

/// A run between its first and its last step.
class Run {
 public:
  Run(const Scene& scene, const RunRequest& request)
      : scene_(scene), request_(request), body_(std::make_unique<Body>(body(scene))), capsule_(capsule(scene, *body_, ranks_, phases_)),
        results_(scene, request, *body_, ranks_), scheme_(motion::integrator(scene.time)) {}

  int go() {
    if (ranks_.rank() == 0 && !request_.quiet) std::fputs(plan_text(scene_, ranks_.size()).c_str(), stdout);
    begin();
    output::Progress progress(state_.time, scene_.time.final_time, request_.quiet || ranks_.rank() != 0);
    std::string reason;
    while (reason.empty() && state_.time < scene_.time.final_time) {
      step();
      progress.show({state_.time, standing_.step, report_.iterations, entry(row_, "taylor_inertia")});
      reason = reason_to_stop();
      if (!reason.empty() || state_.time == stop_) save();
    }
    progress.close();
    if (results_.last_saved() != standing_.step) save();
    return end(reason);
  }

 private:
  void begin() {
    if (auto resumed = results_.resumed()) {
      state_ = resumed->state;
      standing_ = resumed->standing;
      if (resumed->body) settle(std::move(resumed->body));
      if (state_.frozen.size() > 0) capsule_->freeze(state_.frozen);
      capsule_->work() = standing_.work;
      watch_.add(standing_.wall_seconds);
      return;
    }
    state_.x = body_->rest;
    state_.history = {capsule_->velocity(state_.x)};
    state_.step = scene_.time.initial_step ? *scene_.time.initial_step : motion::first_step(*capsule_, state_, scene_.time);
    record();
    save();
  }

  /// Goes on with the particle on another mesh.
  void settle(std::unique_ptr<Body> body) {
    const coupling::Work work = capsule_->work();
    kernel_evaluations_ = kernel_evaluations();
    capsule_.reset();
    body_ = std::move(body);
    capsule_ = capsule(scene_, *body_, ranks_, phases_);
    capsule_->work() = work;
    results_.remesh(*body_);
  }

  /// Cuts or merges elements where the rule says so (P-37).
  void adapt() {
    if (!scene_.adaptation.enabled || standing_.step % scene_.adaptation.interval != 0) return;
    const auto clock = phases_.time("adaptation");
    auto change = adapted(scene_, *body_, state_, capsule_->load(state_.x), capsule_->measure() == stokes::Measure::reference);
    if (!change) return;
    if (change->finer && change->change > 1e-12) warn_of_change(change->change);
    state_ = std::move(change->state);
    settle(std::move(change->body));
    capsule_->restore_volume(state_.x);
    if (state_.frozen.size() > 0) capsule_->freeze(state_.frozen);
    (change->finer ? standing_.refinements : standing_.coarsenings) += 1;
    if (body_->space.n_points >= scene_.adaptation.largest_number_of_points && !warned_of_size_ && ranks_.rank() == 0)
      std::fprintf(stderr, "tanktread: refinement ends at %d control points, Adaptation/largest number of points\n", body_->space.n_points);
    warned_of_size_ = warned_of_size_ || body_->space.n_points >= scene_.adaptation.largest_number_of_points;
  }

  void warn_of_change(double change) {
    if (ranks_.rank() == 0)
      std::fprintf(stderr, "tanktread: refinement at time %.6g moved the surface by %.2g R_C: the space at extraordinary points is not nested\n",
                   state_.time, change);
  }

  stokes::Evaluations kernel_evaluations() const {
    const stokes::Evaluations now = capsule_->kernel_evaluations();
    return {kernel_evaluations_.far + now.far, kernel_evaluations_.near + now.near, kernel_evaluations_.self + now.self};
  }

  void step() {
    stop_ = next_stop(scene_, state_.time);
    try {
      report_ = scheme_->advance(*capsule_, state_, stop_);
    } catch (const RunFailure& failure) {
      if (results_.last_saved() != standing_.step) save();
      char where[300];
      std::snprintf(where, sizeof where, " at time %.6g, step %d; the checkpoint of the last good step is in %s", state_.time, standing_.step,
                    results_.directory().c_str());
      throw RunFailure(failure.what() + std::string(where));
    }
    ++standing_.step;
    adapt();
    record();
  }

  void record() {
    const auto clock = phases_.time("diagnostics");
    row_ = row(scene_, *body_, *capsule_, state_, report_, ranks_.first(watch_.seconds()));
    const auto output = phases_.time("output");
    results_.record(row_);
  }

  void save() {
    const auto clock = phases_.time("output");
    standing_.work = capsule_->work();
    standing_.wall_seconds = watch_.seconds();
    results_.save(state_, standing_, capsule_->load(state_.x), capsule_->membrane());
  }

  std::string reason_to_stop() {
    if (ranks_.any(asked_to_stop != 0)) return "stopped by a signal";
    const auto limit = scene_.output.wall_clock_limit;
    if (limit && ranks_.first(watch_.here()) > *limit) return "stopped at the wall-clock limit";
    const auto steady = scene_.time.steady_tolerance;
    if (steady && entry(row_, "normal_velocity") < *steady) return "steady";
    return {};
  }

  int end(const std::string& reason) {
    const output::Entries<long> work = counts(standing_, capsule_->work(), kernel_evaluations());
    const bool passed = results_.finish(plan(scene_, *body_, ranks_.size()), work, phases_);
    if (ranks_.rank() == 0) {
      if (!request_.quiet) std::fputs(output::closing_table(phases_, work, results_.directory()).c_str(), stdout);
      if (!reason.empty()) std::fprintf(stderr, "tanktread: %s at time %.6g\n", reason.c_str(), state_.time);
      if (!passed) std::fprintf(stderr, "tanktread: an Expect was missed; see %s\n", (results_.directory() / "summary.yaml").c_str());
    }
    return ranks_.any(!passed) ? 1 : 0;
  }

  const Scene& scene_;
  const RunRequest& request_;
  Watch watch_;
  Phases phases_;
  coupling::Ranks ranks_;
  std::unique_ptr<Body> body_;
  std::unique_ptr<coupling::Capsule> capsule_;
  stokes::Evaluations kernel_evaluations_;  // of capsules on earlier meshes
  bool warned_of_size_ = false;
  Results results_;
  std::unique_ptr<motion::Integrator> scheme_;
  motion::State state_;
  motion::StepReport report_;
  Standing standing_;
  std::vector<double> row_;
  double stop_ = 0;
};

}  // namespace

int simulate(const Scene& scene, const RunRequest& request) {
  heed_signals();
  return Run(scene, request).go();
}

std::string plan_text(const Scene& scene, int ranks) {
  std::ostringstream text;
  for (const auto& [what, how] : plan(scene, body(scene), ranks)) {
    text << "  " << what << std::string(12 - std::min<size_t>(11, what.size()), ' ') << how << "\n";
  }
  return "plan\n" + text.str();
}

std::string stored_deck(const std::string& directory) {
  const auto saved = output::newest_checkpoint(directory);
  if (!saved) throw UserError("--resume " + directory + ": there is no checkpoint in this directory");
  return saved->checkpoint.texts.at("deck");
}

}  // namespace tanktread
