// The capsule or drop in the time loop, on a mesh that may change.

#include <algorithm>
#include <iterator>
#include <utility>

#include "app/adaptation.hpp"
#include "app/drift.hpp"
#include "app/moving.hpp"
#include "app/tube.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "spline/locate.hpp"
#include "surface/geometry.hpp"
#include "surface/patch.hpp"

namespace tanktread {

namespace {

std::vector<Series> deforming_series(const Scene& scene) {
  std::vector<Series> all = series({"time", "time_step", "taylor_inertia", "taylor_surface", "inclination", "volume", "volume_error", "area",
                                    "energy", "smallest_tension", "compressed_area", "stresslet_11", "stresslet_22", "stresslet_33",
                                    "stresslet_12", "stresslet_13", "stresslet_23", "length_x1", "length_x2", "length_x3", "normal_velocity",
                                    "shape_velocity", "n_control_points", "step_error", "rejected_steps", "iterations", "evaluations", "assemblies",
                                    "solver_iterations", "velocity_iterations", "wall_seconds", "centroid_x1", "centroid_x2", "centroid_x3",
                                    "velocity_x1", "velocity_x2", "velocity_x3"});
  if (scene.tube.present) std::ranges::copy(series({"migration_velocity"}), std::back_inserter(all));
  std::ranges::copy(series({"tank_treading_velocity"}), std::back_inserter(all));
  if (scene.tube.present) std::ranges::copy(tube_series(), std::back_inserter(all));
  std::ranges::copy(series({"tank_treading_frequency", "phase", "axis_1", "axis_2", "axis_3", "axis_1_x1", "axis_1_x2", "axis_1_x3"}),
                    std::back_inserter(all));
  if (strains(scene)) std::ranges::copy(series({"intrinsic_viscosity"}), std::back_inserter(all));
  if (scene.adaptation.enabled) std::ranges::copy(series({"refit_error"}), std::back_inserter(all));
  return all;
}

}  // namespace

std::vector<Column> deforming_columns(const Scene& scene) { return columns(deforming_series(scene)); }

namespace {

class Deforming : public Moving {
 public:
  Deforming(const Scene& scene, coupling::Ranks& ranks, Phases& phases)
      : scene_(scene), ranks_(ranks), phases_(phases), body_(std::make_unique<Body>(tanktread::body(scene))),
        capsule_(capsule(scene, *body_, ranks, phases, tube(scene, *body_, phases))), series_(deforming_series(scene)),
        columns_(tanktread::columns(series_)) {
    const spline::Space& space = body_->nested();
    followed_ = site_ahead(space, body_->rest, capsule_->geometry().measures(body_->rest).centroid, body_->plane);
    place_ = spline::place(space, followed_);
  }

  coupling::Dynamics& dynamics() override { return *capsule_; }
  const Body& body() const override { return *body_; }
  Net start() const override { return body_->initial; }
  const surface::BezierMap& bezier() const override { return capsule_->geometry().bezier(); }

  void resume(Resumed& resumed) override {
    const bool another = resumed.volume != body_->volume || symmetry(scene_, *body_, resumed.state.x).order() != body_->symmetry.order();
    body_->volume = resumed.volume;
    if (resumed.body || another) settle(resumed.body ? std::move(resumed.body) : std::move(body_), resumed.state.x);
    if (resumed.state.frozen.size() > 0) capsule_->freeze(resumed.state.frozen);
    capsule_->work() = resumed.standing.work;
    turning_ = resumed.standing.turning;
  }

  /// Puts the centroid back where it is to be held; then cuts or merges elements where the rule says so.
  bool adapt(motion::State& state, Standing& standing) override {
    before_.reset();
    if (holds_centre_) hold_centre(capsule_->flow(), capsule_->geometry(), scene_.particle.shape.center, state);
    if (!scene_.adaptation.enabled || standing.step % scene_.adaptation.interval != 0) return false;
    const auto clock = phases_.time("adaptation");
    Adapted change = adapted(scene_, *body_, state, capsule_->load(state.x), capsule_->measure() == stokes::Measure::reference);
    remark_on(change, state.time);
    if (!change.body) return false;
    state = std::move(change.state);
    settle(std::move(change.body), state.x);
    capsule_->restore_volume(state.x);
    if (!state.x.allFinite()) throw RunFailure("the volume cannot be restored on the new mesh");
    if (state.frozen.size() > 0) capsule_->freeze(state.frozen);
    (change.finer ? standing.refinements : standing.coarsenings) += 1;
    return true;
  }

  void undo_adapt(const Net& x) override {
    if (!before_) return;
    capsule_.reset();
    body_ = std::move(before_);
    body_->symmetry = symmetry(scene_, *body_, x);
    capsule_ = capsule(scene_, *body_, ranks_, phases_, tube(scene_, *body_, phases_));
  }

  std::vector<Warning> remarks() override { return std::exchange(remarks_, {}); }

  coupling::Work work() const override { return capsule_->work(); }
  Turning turning() const override { return turning_; }

  stokes::Evaluations kernel_evaluations() const override {
    const stokes::Evaluations now = capsule_->kernel_evaluations();
    return {kernel_evaluations_.far + now.far, kernel_evaluations_.near + now.near, kernel_evaluations_.self + now.self};
  }

  const std::vector<Column>& columns() const override { return columns_; }

  std::vector<double> row(const motion::State& state, const motion::StepReport& report, double wall_seconds) override {
    Moment now = moment(scene_, *body_, *capsule_, state, report, ranks_);
    now.wall_seconds = wall_seconds;
    const Net v = material_velocity(state);
    add_treading(scene_, *body_, capsule_->geometry(), state.x, v, now);
    if (body_->wall) add_tube(*capsule_, state.x, v, now);
    std::optional<double> angle;
    if (!capsule_->slides()) angle = angle_in(body_->plane, surface::value(body_->nested(), state.x, followed_) - now.centre);
    turning_.advance(report.step, now.treading.frequency, angle);
    now.phase = turning_.degrees;
    return tanktread::row(series_, now);
  }

  Portrait portrait(const motion::State& state) override {
    const Net load = capsule_->load(state.x);
    const Net velocity = capsule_->slides() ? capsule_->fluid_velocity(state.x) : state.history.empty() ? Net() : state.history.front();
    return {state.x, [this, &state, load, velocity](const output::Nodes& nodes, output::NodeRange range) {
              return fields(nodes, range, state.x, load, velocity);
            }};
  }

 private:
  /// Of the fluids on the surface. In a tube it is asked for, as the slope carries what is left of the scheme's iteration, over the step.
  Net material_velocity(const motion::State& state) {
    if (body_->wall) return capsule_->fluid_velocity(state.x, state.history.front());
    return capsule_->slides() ? capsule_->fluid_velocity_about(state.x, scene_.time.tolerance) : state.history.front();
  }

  /// Goes on with the particle on another mesh, in the shape x.
  void settle(std::unique_ptr<Body> body, const Net& x) {
    body->symmetry = symmetry(scene_, *body, x);
    const coupling::Work work = capsule_->work();
    kernel_evaluations_ = kernel_evaluations();
    std::unique_ptr<coupling::Tube> tube;
    if (capsule_->tube()) tube = std::make_unique<coupling::Tube>(*capsule_->tube(), body->space);
    capsule_.reset();
    before_ = std::exchange(body_, std::move(body));
    capsule_ = capsule(scene_, *body_, ranks_, phases_, std::move(tube));
    capsule_->work() = work;
    if (scene_.adaptation.enabled) followed_ = spline::Locator(body_->nested())(place_);
  }

  /// What a change of the mesh lacks.
  void remark_on(const Adapted& change, double time) {
    const motion::AdaptationOptions& options = scene_.adaptation;
    const auto remark = [&](bool lacks, const char* kind, const std::string& sentence) {
      if (lacks) remarks_.push_back({kind, formatted("at time %.4g ", time) + sentence});
    };
    remark(change.refused > 0, "levels",
         formatted("elements above the limits of Adaptation stay whole: they have been halved as often as Adaptation/levels = %d allows",
                   options.levels));
    remark(change.full, "number of points",
         formatted("elements above the limits of Adaptation stay whole: Adaptation/largest number of points = %d leaves no room for all "
                   "their cuts",
                   options.largest_number_of_points));
    remark(change.body && change.finer && change.change > 1e-12, "moved surface",
         formatted(
             "refinement moved the surface by %.2g R_C, for the spaces are not nested: set Surface/extraordinary points to catmull-clark",
             change.change));
  }

  /// `velocity`: of the fluids, or empty.
  std::vector<output::Field> fields(const output::Nodes& nodes, output::NodeRange range, const Net& x, const Net& load,
                                    const Net& velocity) const {
    const std::vector<surface::Jet> before = nodes.jets(body_->unstressed, range), now = nodes.jets(x, range);
    const auto n = static_cast<Eigen::Index>(now.size());
    Net traction = nodes.values(load, range);
    std::vector<output::Field> fields{{"load", traction}};
    if (capsule_->measure() == stokes::Measure::reference)  // a load per unstressed area
      for (Eigen::Index i = 0; i < n; ++i)
        traction.row(i) *= surface::jacobian(before[static_cast<size_t>(i)]) / surface::jacobian(now[static_cast<size_t>(i)]);
    fields.push_back({"traction", traction});
    fields.push_back({"displacement", nodes.values(x - body_->unstressed, range)});
    if (velocity.size() > 0) fields.push_back({"velocity", nodes.values(velocity, range)});
    const Eigen::MatrixX2d tensions = membrane::tensions(body_->law, before, now);
    fields.push_back({"smallest tension", tensions.col(0)});
    fields.push_back({"largest tension", tensions.col(1)});
    Eigen::VectorXd curvature(n);
    for (Eigen::Index i = 0; i < n; ++i) curvature[i] = surface::mean_curvature(now[static_cast<size_t>(i)]);
    fields.push_back({"mean curvature", curvature});
    return fields;
  }

  const Scene& scene_;
  coupling::Ranks& ranks_;
  Phases& phases_;
  std::unique_ptr<Body> body_;
  std::unique_ptr<coupling::Capsule> capsule_;
  std::vector<Series> series_;
  std::vector<Column> columns_;
  spline::Place place_;    // of the material point whose phase is told, in the nested space
  spline::Site followed_;  // the same on the present mesh
  Turning turning_;
  stokes::Evaluations kernel_evaluations_;  // of capsules on earlier meshes
  std::unique_ptr<Body> before_;  // the latest change of mesh; until the next one
  std::vector<Warning> remarks_;
  bool holds_centre_ = holds_centre(scene_);
};

}  // namespace

std::unique_ptr<Moving> deforming(const Scene& scene, coupling::Ranks& ranks, Phases& phases) {
  return std::make_unique<Deforming>(scene, ranks, phases);
}

}  // namespace tanktread
