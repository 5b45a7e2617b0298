#include "app/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <optional>
#include <sstream>

#include "app/body.hpp"
#include "app/heeding.hpp"
#include "app/moving.hpp"
#include "app/prescribed.hpp"
#include "app/results.hpp"
#include "app/tube.hpp"
#include "app/warnings.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "coupling/kernel_count.hpp"
#include "motion/dense_output.hpp"
#include "motion/integrator.hpp"
#include "output/checkpoint.hpp"
#include "output/progress.hpp"

namespace tanktread {

namespace {

volatile std::sig_atomic_t asked_to_stop = 0;
constexpr const char* by_signal = "stopped by a signal";

/// A signal to end asks for a checkpoint first; the second of a kind ends at once. What is ignored stays so (nohup).
void heed_signals() {
  asked_to_stop = 0;
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    const auto before = std::signal(signal, [](int number) {
      asked_to_stop = 1;
      std::signal(number, SIG_DFL);
    });
    if (before == SIG_IGN) std::signal(signal, SIG_IGN);
  }
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
          {"velocity_solves", work.velocity_solves},
          {"most_velocity_iterations", work.most_velocity_iterations},
          {"kernel_evaluations_far", static_cast<long>(kernel.far)},
          {"kernel_evaluations_near", static_cast<long>(kernel.near)},
          {"kernel_evaluations_self", static_cast<long>(kernel.self)}};
}

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

/// A run between its first and its last step.
class Run {
 public:
  Run(const Scene& scene, const RunRequest& request)
      : scene_(scene), request_(request), particle_(moving(scene, ranks_, phases_)),
        results_(scene, request, particle_->body(), particle_->bezier(), particle_->columns(), ranks_),
        scheme_(motion::integrator(time_options(scene), scene.solvers.nox)) {
    ranks_.measure(phases_);
  }

  int go() {
    if (ranks_.rank() == 0 && !request_.quiet) std::fputs(plan_text(plan(scene_, particle_->body(), ranks_.size())).c_str(), stdout);
    begin();
    clock_.emplace(phases_, "time stepping");
    heed_signals();
    output::Progress progress(state_.time, scene_.time.final_time, request_.quiet || ranks_.rank() != 0);
    std::string reason;
    while (reason.empty() && state_.time < scene_.time.final_time) {
      step();
      if (stopped_) break;
      progress.show({state_.time, standing_.step, report_.iterations, entry("taylor_inertia")});
      reason = reason_to_stop();
      if (!reason.empty() || snapshot_due_) save();
    }
    progress.close();
    if (stopped_) reason = by_signal;
    if (results_.last_saved() != standing_.step) save();
    clock_.reset();
    return end(reason);
  }

 private:
  void begin() {
    if (auto resumed = results_.resumed()) {
      const bool adapted = resumed->body != nullptr;
      particle_->resume(*resumed);
      if (adapted) results_.remesh(particle_->body(), particle_->bezier());
      state_ = resumed->state;
      if (request_.another_scheme) motion::forget(state_);
      standing_ = resumed->standing;
      watch_.add(standing_.wall_seconds);
      return;
    }
    state_.x = particle_->start();
    motion::begin(particle_->dynamics(), state_);
    state_.step = scene_.time.initial_step ? *scene_.time.initial_step : motion::first_step(particle_->dynamics(), state_, scene_.time);
    record();
    save();
  }

  void step() {
    const double snapshot = next_snapshot(scene_, state_.time);
    const bool lands = scene_.lands_on_snapshots();
    motion::State before = state_;
    pictured_.reset();
    standing_.work = particle_->work();
    Heeding motion(particle_->dynamics(), [this] { return ranks_.any(asked_to_stop != 0); });
    try {
      if (motion::cross_kink(motion, state_)) before = state_;
      began_ = state_.time;
      report_ = scheme_->advance(motion, state_, lands ? snapshot : scene_.time.final_time);
      judge();
    } catch (const Stopped&) {
      state_ = before;
      stopped_ = true;
      return;
    } catch (const RunFailure& failure) {
      state_ = before;
      fail(failure.what());
    }
    ++standing_.step;
    snapshot_due_ = state_.time >= snapshot * (1 - 1e-12);
    if (!lands && snapshot_due_ && state_.time > snapshot) picture_within(before);
    if (particle_->adapt(state_, standing_)) results_.remesh(particle_->body(), particle_->bezier());
    for (const std::string& sentence : particle_->remarks()) results_.warn(sentence);
    record();
    if (!scene_.tube.present) return;
    const std::string reason = contact(scene_, entry("gap"));
    if (!reason.empty()) fail(reason);
    warn_of_coarse_wall(entry("gap"));
  }

  /// Across a gap that is narrower than 0.6 of the wall's elements its traction is off by more than 1e-4.
  void warn_of_coarse_wall(double gap) {
    const double widest = particle_->body().wall->widest;
    if (warned_of_wall_ || gap > 0.6 * widest) return;
    warned_of_wall_ = true;
    results_.warn(
        formatted("at time %.4g the gap to the wall (%.2g) is narrower than 0.6 of the wall's elements (%.2g): set more "
                  "Tube/azimuthal elements and Tube/axial elements",
                  state_.time, gap, widest));
  }

  [[noreturn]] void fail(const std::string& reason) {
    if (results_.last_saved() != standing_.step) save();
    throw RunFailure(reason + formatted(" at time %.6g, step %d; the checkpoint of the last good step is in %s", state_.time,
                                        standing_.step, results_.directory().c_str()));
  }

  /// The last snapshot's time within the step just made, and the state there.
  void picture_within(const motion::State& before) {
    double time = next_snapshot(scene_, before.time);
    for (double next = next_snapshot(scene_, time); next <= state_.time && next > time; next = next_snapshot(scene_, time)) time = next;
    const motion::DenseOutput dense(before, state_);
    pictured_ = motion::State{time, 0, dense.place(time), {dense.slope(time)}, {}, {}, {}};
  }

  void record() {
    const auto clock = phases_.time("diagnostics");
    particle_->dynamics().at(state_.time, began_);
    row_ = particle_->row(state_, report_, ranks_.first(watch_.seconds()));
    look();
    const auto output = phases_.time("output");
    results_.record(row_);
  }

  /// The mesh's quality, in every step once an element is in doubt, and now and then before. Throws RunFailure when one is folded.
  void judge() {
    const bool doubtful = quality_.jacobian_ratio < 0.25;
    if (scene_.particle.rigid() || (standing_.step % 4 != 0 && !doubtful)) return;
    const auto clock = phases_.time("soundness");
    quality_ = soundness(particle_->bezier(), state_.x, ranks_);
  }

  /// What the step has come near to.
  void look() {
    if (scene_.particle.rigid()) return;
    Signs signs;
    signs.time = state_.time;
    signs.step = report_.step;
    signs.smallest_tension = entry("smallest_tension");
    signs.compressed_area = entry("compressed_area");
    signs.volume_error = entry("volume_error");
    signs.jacobian_ratio = quality_.jacobian_ratio;
    signs.aspect_ratio = quality_.aspect_ratio;
    if (scene_.tube.present) signs.gap = entry("gap");
    signs.element = std::sqrt(entry("area") / static_cast<double>(particle_->body().space.elements.size()));
    for (const std::string& sentence : warnings_.look(signs)) results_.warn(sentence);
  }

  void save() {
    const auto clock = phases_.time("output");
    if (!stopped_) standing_.work = particle_->work();
    standing_.wall_seconds = watch_.seconds();
    const motion::State& pictured = pictured_ ? *pictured_ : state_;
    particle_->dynamics().at(pictured.time, began_);
    results_.save(state_, standing_, particle_->portrait(pictured), pictured.time);
  }

  std::string reason_to_stop() {
    if (ranks_.any(asked_to_stop != 0)) return by_signal;
    const auto limit = scene_.output.wall_clock_limit;
    if (limit && ranks_.first(watch_.here()) > *limit) return "stopped at the wall-clock limit";
    const auto steady = scene_.time.steady_tolerance;
    if (steady && entry("normal_velocity") < *steady) return "steady";
    return {};
  }

  int end(const std::string& reason) {
    if (scene_.output.surface_text) results_.write_surface(particle_->portrait(state_).surface);
    const output::Entries<long> work = counts(standing_, particle_->work(), coupling::of_all(particle_->kernel_evaluations(), ranks_));
    std::ostringstream remark;
    if (!reason.empty()) remark << reason << " at time " << state_.time;
    return results_.close(plan(scene_, particle_->body(), ranks_.size()), work, phases_, remark.str());
  }

  /// The value of one series in this step; zero for a series that this particle has not.
  double entry(const std::string& name) const {
    const std::vector<Column>& columns = particle_->columns();
    const auto at = std::ranges::find(columns, name, &Column::name);
    return at == columns.end() ? 0.0 : row_[static_cast<size_t>(at - columns.begin())];
  }

  const Scene& scene_;
  const RunRequest& request_;
  Watch watch_;
  Phases phases_ = started();
  std::optional<Phases::Scope> clock_{std::in_place, phases_, "set-up"};  // of what no other phase counts
  coupling::Ranks ranks_;
  std::unique_ptr<Moving> particle_;
  Results results_;
  std::unique_ptr<motion::Integrator> scheme_;
  motion::State state_;
  motion::StepReport report_;
  double began_ = 0;  // the last step
  Standing standing_;
  std::vector<double> row_;
  bool warned_of_wall_ = false;
  bool snapshot_due_ = false;
  bool stopped_ = false;  // within a step, of which nothing is kept
  std::optional<motion::State> pictured_;  // where a snapshot is due within the last step
  surface::Quality quality_;
  Warnings warnings_{scene_};
};

}  // namespace

std::vector<std::string> check_expectations(const Scene& scene) {
  const bool prescribed = scene.particle.motion == "prescribed";
  const std::vector<Column> series = prescribed                       ? prescribed_columns()
                                     : scene.particle.motion == "free" ? free_columns(scene)
                                                                       : deforming_columns(scene);
  std::vector<std::string> names;
  for (const Column& column : series) names.push_back(column.name);
  deck::check_series(scene.expect.all, names);
  return deck::too_late(scene.expect.all, prescribed ? 0 : scene.time.final_time);
}

int simulate(const Scene& scene, const RunRequest& request) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit is then an error like any other of writing
  if (scene.particle.motion == "prescribed") return resist(scene, request);
  return Run(scene, request).go();
}

std::unique_ptr<Moving> moving(const Scene& scene, coupling::Ranks& ranks, Phases& phases) {
  return scene.particle.motion == "free" ? free_body(scene, ranks, phases) : deforming(scene, ranks, phases);
}

std::string plan_text(const Scene& scene, int ranks) { return plan_text(plan(scene, body(scene), ranks)); }

std::string plan_text(const output::Entries<std::string>& plan) {
  std::ostringstream text;
  for (const auto& [what, how] : plan) {
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
