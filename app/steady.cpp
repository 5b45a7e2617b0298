// Searches for steady and periodic shapes, branches of steady shapes, and spectra.

#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "app/runs.hpp"
#include "app/signals.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/stop.hpp"
#include "motion/approach.hpp"
#include "motion/guarded.hpp"
#include "motion/periodic.hpp"
#include "record/plan.hpp"
#include "record/results.hpp"
#include "scene/particles/particle_system.hpp"
#include "scene/particles/warnings.hpp"
#include "scene/searches/searches.hpp"
#include "scene/searches/shape_modes.hpp"
#include "scene/searches/steady_system.hpp"
#include "scene/searches/system_pool.hpp"
#include "scene/series/run_totals.hpp"
#include "scene/series/series.hpp"
#include "scene/tube.hpp"
#include "system/parallel/agreement.hpp"
#include "system/parallel/stop_together.hpp"

namespace tanktread {

namespace {

/// A run that computes shapes one after another and records the results of each. Derived classes search for the shapes. Every call is collective.
class SteadyRun : protected AnyRun {
 public:
  SteadyRun(const Scene& scene, const RunRequest& request)
      : AnyRun(scene, request),
        pool_(scene, request.changed, ranks_, phases_),
        system_(pool_.latest()),
        chosen_(plan(scene, system_->particles->body(), ranks_.size())),
        results_(scene, request, system_->particles->body(), system_->particles->bezier(), ranks_) {
    ranks_.measure(phases_);
    state_.x = system_->particles->start();
  }
  virtual ~SteadyRun() = default;

  /// Computes and records all shapes. Returns the exit code.
  int go() {
    coupling::stop_together();
    print(chosen_);
    for (const Warning& warning : first_warnings(scene_)) results_.warn(warning);
    check_parity(*system_);
    clock_.emplace(phases_, "steady shape");
    try {
      failure_ = coupling::failure_of_any([this] { search(); });
    } catch (const Stopped&) {
      if (results_.last_saved() < 0) throw;
      stopped_ = reason_of_stop();
    }
    if (!failure_.empty() && results_.last_saved() < 0) throw RunFailure(failure_);
    clock_.reset();
    return close();
  }

 protected:
  /// Computes the shapes of the run, beginning with the initial shape state_.x, and calls write() for each of them.
  virtual void search() = 0;

  /// Returns the modes of the current shape.
  virtual std::vector<motion::Mode> modes() { return shape_modes(pool_, system_, state_.x, nullptr, warn_once_); }

  /// Adapts the mesh to the shape. Returns whether the mesh has changed. If the mesh has been coarsened at the same point of a branch, does nothing,
  /// because refinement and coarsening could alternate forever.
  bool adapt() {
    if (totals_.coarsenings > earlier_coarsenings_) return false;
    const bool changed = system_->particles->adapt(state_, totals_);
    for (const Warning& remark : system_->particles->remarks()) warn_once_(remark);
    if (!changed) return false;
    results_.remesh(system_->particles->body(), system_->particles->bezier());
    system_->begin(state_.x);
    return true;
  }

  /// Makes this system the current one. The results then refer to its mesh; the previous system and its mesh may be deleted.
  void use(std::shared_ptr<SteadySystem> system) {
    system_ = std::move(system);
    results_.remesh(system_->particles->body(), system_->particles->bezier());
  }

  /// Finds the steady shape of the current system by approach_steady(), after the search from `start` has failed with the report `failed` and the
  /// best iterate x. Returns `failed` and leaves x unchanged if the flow is zero or has a history, or if approach_steady() does not find it.
  motion::SteadyReport approach(const coupling::State& start, coupling::State& x, const motion::SteadyReport& failed) {
    if (!(scene_.particle_scenes().front().speed() > 0) || scene_.varies_in_time()) return failed;
    coupling::State reached = start;
    const auto equations = [&](double amplitude) {
      if (amplitude == 1) return equations_of(system_);
      Scene weaker = system_->scene;
      stokes::FlowHistory& constant = weaker.flow.history.emplace();
      constant.times = {0}, constant.amplitudes = {amplitude};
      return equations_of(pool_.variant(*system_, std::move(weaker), state_.x));
    };
    const motion::Approach way = motion::approach_steady(equations, scene_.steady, scene_.solvers, reached);
    chosen_.emplace_back("search", way.text());
    if (prints()) std::printf("  %s\n", way.text().c_str());
    if (way.arrived()) {
      x = std::move(reached);
      return way.last;
    }
    motion::SteadyReport lost = failed;
    if (!way.amplitudes.empty() && way.last.why.empty()) lost.why.clear();  // the obstacle is only on the way of the search, as beyond a fold
    return lost;
  }

  /// Computes the velocity of the current shape and, if it was found, its modes, and records its row and snapshot. If the computation of the modes
  /// fails or is stopped, records the shape without modes before it throws.
  void write(bool found = true) {
    state_.history = {system_->motion->velocity(state_.x)};
    if (!state_.history.front().allFinite())
      throw RunFailure("the evaluation of the velocity of this shape failed: " + system_->motion->failure());
    found_.modes.clear();
    const std::exception_ptr lost = scene_.spectrum.present && found ? error_of_modes() : nullptr;
    record();
    save();
    earlier_coarsenings_ = totals_.coarsenings;
    if (lost) std::rethrow_exception(lost);
  }

 private:
  /// Computes the modes of the current shape. Returns the failure or stop if there is one.
  std::exception_ptr error_of_modes() {
    const auto clock = phases_.time("spectrum");
    std::exception_ptr lost;
    try {
      found_.modes = modes();
    } catch (const RunFailure&) {
      lost = std::current_exception();
    } catch (const Stopped&) {
      lost = std::current_exception();
    }
    if (lost) system_->motion->set_time(0, 0);  // a return map may have set another time
    return lost;
  }

  void record() {
    const auto clock = phases_.time("diagnostics");
    pool_.count(totals_);
    totals_.phase_angle = system_->particles->phase_angle();
    Columns row = system_->particles->next_row(state_, {.step = report_, .wall_seconds = seconds_here(), .evaluations = totals_.counts.evaluations});
    found_.add_columns(scene_, row);
    row.check();
    results_.record(row);
    if (const std::string coarse = coarse_wall(scene_, system_->particles->body(), row); !coarse.empty()) warn_once_({"coarse wall", coarse});
  }

  void save() {
    const Meanwhile complete(stop_rules().answers, false);
    const auto clock = phases_.time("output");
    output::Checkpoint checkpoint;
    system_->particles->store(checkpoint);
    const ParticleSystem& particles = *system_->particles;
    for (int k = 0; const motion::Mode& mode : found_.modes) checkpoint.arrays["mode " + std::to_string(++k)] = particles.surface(mode.real);
    SurfaceSnapshot snapshot = system_->particles->snapshot(state_);
    if (scene_.output.surface_text) results_.write_surface(snapshot.surface);
    snapshot.fields = [this, of_shape = snapshot.fields](const output::Nodes& nodes) {
      std::vector<output::Field> fields = of_shape(nodes);
      int k = 0;
      for (const motion::Mode& mode : found_.modes) {
        const std::string name = "mode " + std::to_string(++k);
        fields.push_back({name, nodes.values(system_->particles->surface(mode.real))});
        if (mode.rate.imag() != 0) fields.push_back({name + " imaginary", nodes.values(system_->particles->surface(mode.imaginary))});
      }
      return fields;
    };
    results_.save(std::move(checkpoint), state_, totals_, results_.sample(snapshot, state_.time));
  }

  int close() {
    Account account;
    account.summary.plan = chosen_;
    pool_.count(totals_);
    account.summary.counts = counts(totals_);
    if (!failure_.empty()) account.summary.status = output::run_status::failed + failure_;
    if (!stopped_.empty()) {
      account.summary.status = stopped_;
      account.remark = spoken(stopped_) + "; the results so far are in " + results_.directory().string();
    }
    int k = 0;
    for (const motion::Mode& mode : found_.modes) account.summary.modes.emplace_back(std::to_string(++k), motion::name(mode.kind));
    const int code = results_.close(account, phases_);
    if (!failure_.empty()) throw RunFailure(failure_ + "; the results so far are in " + results_.directory().string());
    return stopped_.empty() ? code : Exit::stopped;
  }

  int earlier_coarsenings_ = 0;  // coarsenings up to the last recorded shape
  std::string failure_, stopped_;  // reasons for which the search failed or was stopped

 protected:
  SystemPool pool_;
  std::shared_ptr<SteadySystem> system_;  // system of the current shape; results_ refers to its mesh
  output::Entries<std::string> chosen_;
  Results results_;
  Warnings warnings_{scene_};
  const Warn warn_once_ = [this](const Warning& warning) {
    if (warnings_.fresh(warning)) results_.warn(warning);
  };
  motion::TimeState state_;
  motion::StepReport report_;
  RunTotals totals_;
  SteadyRow found_;
};

/// Records the initial shape, on a mesh that is adapted to it.
class InitialShape : public SteadyRun {
  using SteadyRun::SteadyRun;

  void search() override {
    do system_->motion->restore_constraints(state_.x);
    while (adapt());
    write();
  }
};

/// Finds a steady shape, on a mesh that is adapted to it.
class SteadySearch : public SteadyRun {
  using SteadyRun::SteadyRun;

  void search() override {
    motion::SteadyReport found;
    do {
      const coupling::State start = state_.x;
      found = motion::find_steady(*system_->equations, scene_.steady, scene_.solvers, state_.x);
      if (!found.converged) found = approach(start, state_.x, found);
    } while (found.converged && adapt());
    report_.iterations = found.iterations, report_.error = found.rest;
    write(found.converged);
    if (!found.converged && !found.why.empty()) throw RunFailure("the steady shape was not found, because " + found.why);
    if (!found.converged)
      throw RunFailure(formatted("the steady shape was not found: after %d iterations the correction is %.2g; another Steady/step or Steady/method "
                                 "`%s` may help", found.iterations, found.rest,
                                 scene_.steady.method == "anderson" ? "newton-krylov" : "anderson"));
  }
};

/// Finds a shape that repeats after a period, on a mesh that is adapted to it.
class PeriodicSearch : public SteadyRun {
  using SteadyRun::SteadyRun;

  void search() override {
    motion::PeriodicOptions options = scene_.periodic;
    const Body& body = system_->particles->body();
    options.drifts = free_motions(scene_, body.flow, body.radius, system_->particles->capsule()->particles(), 3);
    state_.x = motion::after_periods(*system_->motion, time_, scene_.solvers.nox, options, state_.x);
    motion::PeriodicReport found;
    do {
      returns_.emplace(*system_->motion, time_, scene_.solvers.nox, options, state_.x);
      found = motion::find_periodic(*returns_, scene_.solvers.nox, std::bind_front(&SteadySystem::without_sliding, system_.get()), state_.x);
    } while (found.converged && adapt());
    report_.iterations = found.iterations, report_.error = found.rest;
    found_.period = returns_->period(), found_.mean_velocity = returns_->mean_velocity();
    write(found.converged);
    if (!found.converged)
      throw RunFailure(formatted("no periodic motion was found: after %d periods the residual is %.2g", found.iterations, found.rest));
  }

  std::vector<motion::Mode> modes() override { return shape_modes(pool_, system_, state_.x, &*returns_, warn_once_); }

  const motion::TimeOptions time_ = scene_.time_options();
  std::optional<motion::ReturnMap> returns_;
};

/// Follows a branch of steady shapes, on meshes that are adapted to its points.
class BranchSearch : public SteadyRun {
 public:
  /// `first`: see SystemPool::begin_branch().
  BranchSearch(const Scene& scene, const RunRequest& request, const Parameters& first) : SteadyRun(scene, request), first_(first) {}

 private:
  void search() override {
    pool_.begin_branch(first_);
    motion::Branch branch([this](double parameter, double second) { return equations_of(pool_.at({parameter, second}, state_.x)); },
                          [this](double parameter, std::vector<coupling::State>& states) { return adapt_at({parameter, first_[1]}, states); },
                          scene_.continuation, scene_.steady, scene_.solvers, first_[0], first_[1], state_.x);
    branch.search([&](coupling::State& x, const motion::SteadyReport& failed) { return approach(state_.x, x, failed); });
    for (int k = 0; const auto point = branch.next(); ++k) {
      coupling::stop_together();
      use(pool_.at({point->parameter, point->second}, state_.x));
      state_.x = point->x, state_.time = k, totals_.step = k;
      system_->motion->restore_constraints(state_.x);
      report_.iterations = point->iterations, report_.error = point->rest, found_.point = *point;
      write();
      if (prints())
        std::printf("  %-11d %s%s\n", k, scene_.continuation.text(point->parameter, point->second).c_str(), point->fold ? ", a fold" : "");
      if (const std::string remark = scene_.continuation.remark(*point); !remark.empty()) results_.warn(remark);
    }
    if (branch.cut_short()) results_.warn("Continuation/points ended the branch before its parameter reached Continuation/to: set more points");
  }

  /// Adapts the mesh at a point of the branch to the last of `states`, and transfers all `states` to the new mesh. Returns whether the mesh has
  /// changed.
  bool adapt_at(const Parameters& parameters, std::vector<coupling::State>& states) {
    use(pool_.at(parameters, state_.x));
    state_.history.clear(), state_.places.clear();
    for (coupling::State& one : states) state_.places.push_back({state_.time, std::move(one)});
    state_.x = state_.places.back().x;
    const bool changed = adapt();
    for (std::size_t k = 0; k < states.size(); ++k) states[k] = std::move(state_.places[k].x);
    if (changed) pool_.adapted();
    return changed;
  }

  const Parameters first_;
};

}  // namespace

void check_search(const Scene& scene, const RunRequest& request) {
  if (scene.runs_in_time()) return;
  if (scene.continuation.present) first_parameters(scene, request.deck_text, request.changed);
  if (!scene.spectrum.parity) return;
  coupling::Ranks ranks;
  Phases phases;
  check_parity(*SystemPool(scene, request.changed, ranks, phases).latest());
}

int find_steady(const Scene& scene, const RunRequest& request) {
  if (request.resume) throw UserError("--resume continues a run in time: " + scene.sought().here + " has no time steps to continue.");
  switch (scene.search()) {
    case Search::steady:
      return scene.continuation.present ? BranchSearch(scene, request, first_parameters(scene, request.deck_text, request.changed)).go()
                                        : SteadySearch(scene, request).go();
    case Search::periodic: return PeriodicSearch(scene, request).go();
    case Search::spectrum: return InitialShape(scene, request).go();
    case Search::none: break;
  }
  throw std::logic_error("a run in time is not a search");
}

}  // namespace tanktread
