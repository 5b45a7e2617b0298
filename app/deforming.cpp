// The capsule or drop in the time loop, on a mesh that may change.

#include <utility>

#include "app/adaptation.hpp"
#include "app/drift.hpp"
#include "app/moving.hpp"
#include "app/tube.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "surface/geometry.hpp"
#include "surface/patch.hpp"

namespace tanktread {

std::vector<Column> deforming_columns(const Scene& scene) {
  std::vector<Column> all = columns();
  if (scene.tube.present) all.insert(all.end(), tube_columns().begin(), tube_columns().end());
  if (scene.adaptation.enabled)
    all.push_back({"refit_error", "1", "sum of what changes of the mesh have moved the present and the unstressed surface by so far, over R_C"});
  return all;
}

namespace {

class Deforming : public Moving {
 public:
  Deforming(const Scene& scene, coupling::Ranks& ranks, Phases& phases)
      : scene_(scene), ranks_(ranks), phases_(phases), body_(std::make_unique<Body>(tanktread::body(scene))),
        capsule_(capsule(scene, *body_, ranks, phases, tube(scene, *body_, phases))), columns_(deforming_columns(scene)) {}

  coupling::Dynamics& dynamics() override { return *capsule_; }
  const Body& body() const override { return *body_; }
  Net start() const override { return body_->rest; }
  const surface::BezierMap& bezier() const override { return capsule_->geometry().bezier(); }

  void resume(Resumed& resumed) override {
    if (resumed.body || symmetry(scene_, *body_, resumed.state.x).order() != body_->symmetry.order())
      settle(resumed.body ? std::move(resumed.body) : std::move(body_), resumed.state.x);
    if (resumed.state.frozen.size() > 0) capsule_->freeze(resumed.state.frozen);
    capsule_->work() = resumed.standing.work;
  }

  /// Puts the centroid back where it is to be held; then cuts or merges elements where the rule says so.
  bool adapt(motion::State& state, Standing& standing) override {
    before_.reset();
    if (holds_centre_) hold_centre(body_->flow, capsule_->geometry(), scene_.particle.shape.center, state);
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

  stokes::Evaluations kernel_evaluations() const override {
    const stokes::Evaluations now = capsule_->kernel_evaluations();
    return {kernel_evaluations_.far + now.far, kernel_evaluations_.near + now.near, kernel_evaluations_.self + now.self};
  }

  const std::vector<Column>& columns() const override { return columns_; }

  std::vector<double> row(const motion::State& state, const motion::StepReport& report, double wall_seconds) override {
    std::vector<double> row = tanktread::row(scene_, *body_, *capsule_, state, report, wall_seconds, ranks_);
    if (body_->wall) {
      const std::vector<double> more = tube_row(*body_, *capsule_, state);
      row.insert(row.end(), more.begin(), more.end());
    }
    if (scene_.adaptation.enabled) row.push_back(body_->refit_error);
    return row;
  }

  Portrait portrait(const motion::State& state) override {
    const Net load = capsule_->load(state.x);
    const Net velocity = capsule_->slides() ? capsule_->fluid_velocity(state.x) : state.history.empty() ? Net() : state.history.front();
    return {state.x, [this, &state, load, velocity](const output::Nodes& nodes, output::NodeRange range) {
              return fields(nodes, range, state.x, load, velocity);
            }};
  }

 private:
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
  std::vector<Column> columns_;
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
