#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdio>
#include <deque>
#include <functional>
#include <optional>
#include <utility>

#include "app/runs.hpp"
#include "app/signals.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/document.hpp"
#include "deck/words.hpp"
#include "motion/approach.hpp"
#include "motion/guarded.hpp"
#include "motion/periodic.hpp"
#include "record/plan.hpp"
#include "record/results.hpp"
#include "scene/particles/particle_system.hpp"
#include "scene/particles/warnings.hpp"
#include "scene/searches.hpp"
#include "scene/series/run_totals.hpp"
#include "scene/series/series.hpp"
#include "scene/series/surface_fields.hpp"
#include "scene/steady_system.hpp"
#include "scene/tube.hpp"
#include "system/agreement.hpp"

namespace tanktread {

namespace {

/// A run that computes shapes one after another and records the results of each.
class SteadyRun {
 public:
  SteadyRun(const Scene& scene, const RunRequest& request)
      : scene_(scene), request_(request), system_(std::make_shared<System>(scene, ranks_, phases_, told_)),
        chosen_(plan(scene, system_->particle->body(), ranks_.size())),
        results_(scene, request, system_->particle->body(), system_->particle->bezier(), ranks_) {
    ranks_.measure(phases_);
    state_.x = system_->particle->start();
  }

  int go() {
    stop_where_told();
    if (ranks_.rank() == 0 && !request_.quiet) std::fputs(plan_text(chosen_).c_str(), stdout);
    for (const Warning& warning : first_warnings(scene_)) results_.warn(warning.sentence);
    clock_.emplace(phases_, "steady shape");
    try {
      failure_ = coupling::failure_of_any([this] { scene_.continuation.present ? follow() : look(); });
    } catch (const motion::Stopped&) {
      if (results_.last_saved() < 0) throw;
      stopped_ = reason_of_stop();
    }
    if (!failure_.empty() && results_.last_saved() < 0) throw RunFailure(failure_);
    clock_.reset();
    return close();
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// Computes and records the periodic or steady shape that the deck requests, starting from the initial shape. If the deck requests neither, records
  /// the initial shape.
  void look() {
    if (scene_.periodic.present) return shoot();
    if (!scene_.steady.present) {
      do system_->motion->restore_volume(state_.x);
      while (adapt());
      return write();
    }
    motion::SteadyReport found;
    do {
      const Net start = state_.x;
      found = motion::find_steady(*system_->equations, scene_.steady, scene_.solvers, state_.x);
      if (!found.converged) found = approach(system_, start, state_.x, found);
    } while (found.converged && adapt());
    report_.iterations = found.iterations, report_.error = found.rest;
    write();
    if (!found.converged)
      throw RunFailure(formatted("the steady shape was not found: after %d iterations the correction is %.2g; another Steady/step or Steady/method "
                                 "`newton-krylov` may help", found.iterations, found.rest));
  }

  /// Finds the steady shape of the system `of` by approach_steady(), after the search from `start` has failed with the report `failed` and the best
  /// iterate x. Returns `failed` and leaves x unchanged if the flow is zero or has a prescribed history, or if approach_steady() does not find it.
  motion::SteadyReport approach(const std::shared_ptr<System>& of, const Net& start, Net& x, const motion::SteadyReport& failed) {
    if (!(of->scene.particle_scenes().front().speed() > 0) || of->scene.flow.history) return failed;
    output::Checkpoint mesh;
    of->particle->store(mesh);
    Net reached = start;
    std::shared_ptr<System> latest;  // system for the latest flow with an amplitude below 1
    const motion::Approach way = motion::approach_steady([&](double amplitude) -> std::shared_ptr<motion::SteadyEquations> {
      if (amplitude == 1) return {of, &*of->equations};
      Scene weaker = of->scene;
      stokes::FlowHistory& constant = weaker.flow.history.emplace();
      constant.times = {0}, constant.amplitudes = {amplitude};
      if (latest) count_out(*latest);
      latest = std::make_shared<System>(std::move(weaker), ranks_, phases_, told_);
      carry_to(*latest, mesh);
      return {latest, &*latest->equations};
    }, scene_.steady, scene_.solvers, reached);
    if (latest) count_out(*latest);
    chosen_.emplace_back("search", way.text());
    if (ranks_.rank() == 0 && !request_.quiet) std::printf("  %s\n", way.text().c_str());
    if (way.arrived()) x = std::move(reached);
    return way.arrived() ? way.last : failed;
  }

  /// Computes a shape that repeats after a period.
  void shoot() {
    motion::PeriodicOptions options = scene_.periodic;
    const Body& body = system_->particle->body();
    options.drifts = free_motions(scene_, body.flow, body.radius, system_->particle->capsule()->particles(), 3);
    state_.x = motion::after_periods(*system_->motion, time_, scene_.solvers.nox, options, state_.x);
    motion::PeriodicReport found;
    do {
      returns_.emplace(*system_->motion, time_, scene_.solvers.nox, options, state_.x);
      found = motion::find_periodic(*returns_, scene_.solvers.nox, std::bind_front(&System::without_sliding, system_.get()), state_.x);
    } while (found.converged && adapt());
    report_.iterations = found.iterations, report_.error = found.rest;
    found_.period = returns_->period(), found_.mean_velocity = returns_->mean_velocity();
    write();
    if (!found.converged)
      throw RunFailure(formatted("no periodic motion was found: after %d periods the residual is %.2g", found.iterations, found.rest));
  }

  /// Adapts the mesh to the shape. Returns whether the mesh has changed. If the mesh has been coarsened at the same point of a branch, does nothing,
  /// because refinement and coarsening could alternate forever.
  bool adapt() {
    if (totals_.coarsenings > earlier_coarsenings_ || !system_->particle->adapt(state_, totals_)) return false;
    results_.remesh(system_->particle->body(), system_->particle->bezier());
    system_->begin(state_.x);
    return true;
  }

  /// Adapts the mesh at a point of a branch to the last of `shapes`, and transfers all `shapes` to the new mesh. Returns whether the mesh has
  /// changed.
  bool adapt_at(const Parameters& parameters, std::vector<Net>& shapes) {
    use(system_at(parameters));
    state_.history.clear(), state_.places.clear();
    for (Net& shape : shapes) state_.places.push_back({state_.time, std::move(shape)});
    state_.x = state_.places.back().x;
    const bool changed = adapt();
    for (std::size_t k = 0; k < shapes.size(); ++k) shapes[k] = std::move(state_.places[k].x);
    if (!changed) return false;
    mesh_.emplace();
    system_->particle->store(*mesh_);
    while (systems_.size() > 1) drop_oldest();
    return true;
  }

  /// Computes all shapes of a branch.
  void follow() {
    const Parameters first = first_parameters(scene_, request_.deck_text);
    const auto check = [&](const Parameters& parameters) { request_.changed(settings_of(scene_.continuation, parameters)); };
    check({scene_.continuation.to, first[1]});
    for (const double second : scene_.continuation.second_values.value_or(std::vector<double>())) check({first[0], second});
    systems_.emplace_front(first, system_);
    rest_ = system_->particle->body().rest, unstressed_ = system_->particle->body().unstressed;
    motion::Branch branch([this](double parameter, double second) { return equations_at({parameter, second}); },
                          [&](double parameter, std::vector<Net>& shapes) { return adapt_at({parameter, first[1]}, shapes); }, scene_.continuation,
                          scene_.steady, scene_.solvers, first[0], first[1], state_.x);
    branch.search([&](Net& x, const motion::SteadyReport& failed) { return approach(system_, Net(state_.x), x, failed); });
    for (int k = 0; const auto point = branch.next(); ++k) {
      stop_where_told();
      use(system_at({point->parameter, point->second}));
      state_.x = point->x, state_.time = k, totals_.step = k;
      report_.iterations = point->iterations, report_.error = point->rest, found_.point = *point;
      write();
      earlier_coarsenings_ = totals_.coarsenings;
      if (ranks_.rank() == 0 && !request_.quiet)
        std::printf("  %-11d %s%s\n", k, at({point->parameter, point->second}).c_str(), point->fold ? ", a fold" : "");
      if (const std::string remark = scene_.continuation.remark(*point); !remark.empty()) results_.warn(remark);
    }
    if (branch.cut_short()) results_.warn("Continuation/points ended the branch before its parameter reached Continuation/to: set more points");
  }

  /// Returns the parameters as text.
  std::string at(const Parameters& parameters) const { return scene_.continuation.text(parameters[0], parameters[1]); }

  /// Makes this system the current one. The results then refer to its mesh; the previous system and its mesh may be deleted.
  void use(std::shared_ptr<System> system) {
    system_ = std::move(system);
    results_.remesh(system_->particle->body(), system_->particle->bezier());
  }

  /// Returns the system for these parameters. Keeps the three systems used last in `systems_`, with the returned system in front. If the deck does
  /// not allow the parameters, throws RunFailure instead of UserError, so that the points of the branch computed so far are kept.
  std::shared_ptr<System> system_at(const Parameters& parameters) try {
    const auto known = std::ranges::find(systems_, parameters, &std::pair<Parameters, std::shared_ptr<System>>::first);
    if (known != systems_.end()) {
      std::rotate(systems_.begin(), known, known + 1);
      return systems_.front().second;
    }
    const auto clock = phases_.time("set-up");
    auto made = std::make_shared<System>(with_field_lengths_of(scene_, request_.changed(settings_of(scene_.continuation, parameters))), ranks_,
                                         phases_, told_);
    if (mesh_ && !(made->particle->body().rest == rest_ && made->particle->body().unstressed == unstressed_))
      throw UserError("the mesh has adapted, but the resting or unstressed shape depends on this key: set Adaptation/enabled to false");
    if (mesh_) carry_to(*made, *mesh_);
    const int points = made->particle->body().space.n_points, expected = system_->particle->body().space.n_points;
    if (points != expected)
      throw UserError("Continuation needs one mesh, but " + at(parameters) + formatted(" has %d control points, not %d.", points, expected));
    systems_.emplace_front(parameters, made);
    if (systems_.size() > 3) drop_oldest();
    return made;
  } catch (const UserError& error) {
    throw RunFailure(formatted("%s cannot be computed (%s)", at(parameters).c_str(), error.what()));
  }

  /// Transfers a system to the mesh of the checkpoint `mesh`, with the current shape.
  void carry_to(System& system, const output::Checkpoint& mesh) const {
    Resumed resumed;
    resumed.state.x = state_.x, resumed.totals.phase_angle = system.particle->phase_angle(), resumed.checkpoint = mesh;
    system.particle->resume(resumed);
    system.begin(state_.x);
  }

  /// Adds the operation counts of a system to the totals, before the system is deleted.
  void count_out(const System& system) {
    counts_ = counts_ + system.particle->counts(), kernel_ = kernel_ + system.particle->kernel_evaluations();
  }

  void drop_oldest() {
    count_out(*systems_.back().second);
    systems_.pop_back();
  }

  std::shared_ptr<motion::SteadyEquations> equations_at(const Parameters& parameters) {
    const std::shared_ptr<System> system = system_at(parameters);
    return {system, &*system->equations};
  }

  /// Computes the velocity and modes of the current shape, and records its row and snapshot.
  void write() {
    state_.history = {system_->motion->velocity(state_.x)};
    if (!state_.history.front().allFinite())
      throw RunFailure("the evaluation of the velocity of this shape failed: " + system_->motion->failure());
    if (scene_.spectrum.present) find_modes();
    record();
    save();
  }

  void find_modes() {
    const auto clock = phases_.time("spectrum");
    motion::SpectrumOptions options = scene_.spectrum;
    const surface::Symmetry& shape = system_->particle->body().symmetry;
    const coupling::CoupledMotion* on_it = system_->particle->fields();
    const bool apart = on_it && !on_it->knows_images(shape);
    if (apart && options.parity)
      throw UserError("Spectrum/parity needs surface fields with known images: remove the key to find modes of all parities.");
    const std::shared_ptr<System> system = options.parity || apart ? whole() : system_;
    const coupling::Capsule& capsule = *system->particle->capsule();
    const Body& body = system->particle->body();
    const Net x = state_.x.topRows(capsule.n_points());
    coupling::ShapeCoordinates shapes(body.space, capsule.particles(), options.parity ? shape : body.symmetry, x, capsule.projection(),
                                      options.parity.value_or(Vec3::Ones()));
    coupling::CoupledMotion* fields = system->particle->fields();
    if (fields) shapes.add_fields(*fields, state_.x);
    std::vector<motion::Conserved> kept = conserved_quantities(capsule, fields, x);
    if (const int n = static_cast<int>(shapes.size()); options.number > n)
      results_.warn_once("modes", formatted("Spectrum/number is %d, but the shape has only %d unknowns and modes", options.number, n));
    if (returns_) {
      std::optional<motion::ReturnMap> of_parity;
      if (system != system_) of_parity.emplace(*system->motion, time_, scene_.solvers.nox, returns_->options(), state_.x);
      motion::ReturnMap& returns = of_parity ? *of_parity : *returns_;
      std::erase_if(kept, [](const motion::Conserved& one) { return one.kind == motion::ModeKind::volume; });  // time steps restore the volume
      found_.modes = motion::recognised({*system->motion, shapes, state_.x, kept}, exponents(returns, shapes));
    } else {
      shapes.follow(*system->motion, state_.x);
      if (!options.shift) options.shift = system_->scene.rate();
      found_.modes = motion::spectrum({*system->motion, shapes, state_.x, kept}, options, scene_.solvers.of(scene_.solvers.spectrum));
    }
    if (system != system_) count_out(*system);
    system_->motion->velocity(state_.x);
  }

  /// Returns the Floquet exponents of the shape: the logarithms of the multipliers of the return map, divided by the period.
  std::vector<coupling::Eigenpair> exponents(motion::ReturnMap& returns, const coupling::ShapeCoordinates& shapes) {
    const auto derivative = [&](const auto& y) { return shapes.coordinates(returns.derivative(state_.x, shapes.displacement(y))); };
    std::vector<coupling::Eigenpair> pairs = motion::multipliers(derivative, shapes.size(), scene_.spectrum.number);
    const auto lost = [&](const coupling::Eigenpair& pair) { return std::abs(pair.value) < returns.resolution(); };
    if (std::erase_if(pairs, lost) > 0)
      results_.warn_once("multipliers", formatted("modes that decay within a period to less than %.2g (Time/tolerance / Periodic/difference) are not "
                                                  "reported, because errors of time steps hide them", returns.resolution()));
    for (coupling::Eigenpair& pair : pairs) pair.value = std::log(pair.value) / found_.period;
    return pairs;
  }

  /// Returns the current system without symmetry reduction: if a mode has another parity than the shape, the velocities of all points are needed.
  std::shared_ptr<System> whole() {
    if (system_->particle->body().symmetry.order() == 1)
      throw UserError("Spectrum/parity needs a symmetric scene, and this one has no symmetry: remove the key.");
    Scene scene = system_->scene;
    scene.symmetry.use = "none";
    auto made = std::make_shared<System>(std::move(scene), ranks_, phases_, told_);
    output::Checkpoint mesh;
    system_->particle->store(mesh);
    carry_to(*made, mesh);
    return made;
  }

  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  void count() {
    totals_.counts = counts_, totals_.kernel = kernel_;
    const auto add = [&](const ParticleSystem& one) {
      totals_.counts = totals_.counts + one.counts(), totals_.kernel = totals_.kernel + one.kernel_evaluations();
    };
    if (systems_.empty()) add(*system_->particle);
    for (const auto& [parameters, system] : systems_) add(*system->particle);
    totals_.kernel = ranks_.of_all(totals_.kernel);
    totals_.phase_angle = system_->particle->phase_angle();
  }

  void record() {
    const auto clock = phases_.time("diagnostics");
    count();
    Columns row = system_->particle->row(state_, {.step = report_, .wall_seconds = seconds(), .evaluations = totals_.counts.evaluations});
    found_.add_columns(scene_, row);
    row.check();
    results_.record(row);
    if (const std::string coarse = coarse_wall(scene_, system_->particle->body(), row); !coarse.empty()) results_.warn_once("coarse wall", coarse);
  }

  void save() {
    const auto clock = phases_.time("output");
    output::Checkpoint checkpoint;
    system_->particle->store(checkpoint);
    for (int k = 0; const motion::Mode& mode : found_.modes) checkpoint.arrays["mode " + std::to_string(++k)] = mode.real;
    SurfaceSnapshot snapshot = system_->particle->snapshot(state_);
    if (scene_.output.surface_text) results_.write_surface(snapshot.surface);
    snapshot.fields = [this, of_shape = snapshot.fields](const output::Nodes& nodes) {
      std::vector<output::Field> fields = of_shape(nodes);
      int k = 0;
      for (const motion::Mode& mode : found_.modes) {
        const std::string name = "mode " + std::to_string(++k);
        const Eigen::Index n = system_->particle->capsule()->n_points();
        fields.push_back({name, nodes.values(mode.real.topRows(n))});
        if (mode.rate.imag() != 0) fields.push_back({name + " imaginary", nodes.values(mode.imaginary.topRows(n))});
      }
      return fields;
    };
    results_.save(std::move(checkpoint), state_, totals_, results_.sample(snapshot, state_.time));
  }

  int close() {
    Account account;
    account.plan = chosen_;
    count();
    account.counts = counts(totals_);
    if (!failure_.empty()) account.status = "failed: " + failure_, account.whole = false;
    if (!stopped_.empty()) {
      account.status = stopped_, account.whole = false;
      account.remark = spoken(stopped_) + "; the results so far are in " + results_.directory().string();
    }
    int k = 0;
    for (const motion::Mode& mode : found_.modes) account.modes.emplace_back(std::to_string(++k), motion::name(mode.kind));
    const int code = results_.close(account, phases_);
    if (!failure_.empty()) throw RunFailure(failure_ + "; the results so far are in " + results_.directory().string());
    return stopped_.empty() ? code : stopped;
  }

  const Scene& scene_;
  const RunRequest& request_;
  const Clock::time_point start_ = Clock::now();
  // Function that returns whether this rank has received a stop signal or has passed the wall-clock limit.
  const std::function<bool()> told_ = [this] { return told_to_stop() || scene_.output.too_late(seconds()); };
  const motion::TimeOptions time_ = scene_.time_options();
  Phases phases_ = started();
  std::optional<Phases::Scope> clock_{std::in_place, phases_, "set-up"};
  coupling::Ranks ranks_;
  std::shared_ptr<System> system_;
  std::deque<std::pair<Parameters, std::shared_ptr<System>>> systems_;  // parameters and systems of a branch, last used first
  std::optional<output::Checkpoint> mesh_;                              // mesh of systems_; not set if it is the mesh of the deck
  Net rest_, unstressed_;                                               // resting and unstressed shapes of a branch on the mesh of the deck
  output::Entries<std::string> chosen_;
  Results results_;
  motion::State state_;
  motion::StepReport report_;
  RunTotals totals_;
  int earlier_coarsenings_ = 0;  // coarsenings up to the last recorded point of a branch
  coupling::OperationCounts counts_;  // operation counts of systems that were deleted
  stokes::Evaluations kernel_;  // kernel evaluations of systems that were deleted
  std::optional<motion::ReturnMap> returns_;
  SteadyRow found_;
  std::string failure_, stopped_;  // reasons for which the search failed or was stopped
};

}  // namespace

int find_steady(const Scene& scene, const RunRequest& request) {
  if (request.resume) throw UserError("--resume continues a run in time: Steady and Spectrum have no time steps to continue.");
  return SteadyRun(scene, request).go();
}

}  // namespace tanktread
