// Free rigid body in the time loop.

#include <utility>

#include "scene/member.hpp"
#include "scene/particles/adaptation.hpp"
#include "scene/particles/particle_system.hpp"
#include "scene/particles/prescribed.hpp"
#include "scene/series/run_row.hpp"
#include "surface/geometry.hpp"
#include "system/solids/bodies/bounded_free_body.hpp"

namespace tanktread {

namespace {

class Free : public ParticleSystem {
 public:
  Free(const Scene& scene, coupling::Ranks& ranks, Phases& phases)
      : scene_(scene), particle_scene_(scene.first()), ranks_(ranks), body_(make_refined_body(particle_scene_, ranks, phases, remarks_)),
        geometry_(body_.space), tube_(make_tube(particle_scene_, body_, phases)),
        tractions_(make_tractions(particle_scene_, body_, ranks, tube_.get())), free_(make_driven_body(particle_scene_, body_, tractions_)) {}

  coupling::Dynamics& dynamics() override { return *free_; }
  const Body& body() const override { return body_; }
  coupling::State start() const override { return coupling::placed(free_->centre()); }
  Net surface(const coupling::State& x) const override { return free_->surface(x); }
  bool resume(Resumed& resumed) override {
    output::read_vectors(resumed.checkpoint, start().layout(), resumed.state);
    phase_angle_ = resumed.totals.phase_angle.at(0);
    if (const auto start = resumed.checkpoint.arrays.find("start unknowns"); start != resumed.checkpoint.arrays.end())
      free_->start_from(start->second);
    return false;
  }
  void store(output::Checkpoint& checkpoint) const override {
    checkpoint.arrays["unstressed"] = body_.unstressed;
    checkpoint.arrays[stored_rest] = body_.rest;
    if (const Eigen::VectorXd start = free_->unknowns(); start.size() > 0) checkpoint.arrays["start unknowns"] = start;
  }
  bool adapt(motion::TimeState&, RunTotals&) override { return false; }
  const surface::BezierMap& bezier() const override { return geometry_.bezier(); }
  stokes::Evaluations kernel_evaluations() const override { return tractions_.kernel_evaluations(); }

  coupling::OperationCounts counts() const override {
    coupling::OperationCounts sum = before_;
    sum.evaluations += free_->evaluations();
    sum.assemblies += 1;
    sum.solves += free_->linear_solves();
    sum.solver_iterations += free_->solver_iterations();
    return sum;
  }

  void set_counts(const coupling::OperationCounts& all) override {
    before_ = {};
    const coupling::OperationCounts here = counts();
    before_ = all;
    before_.evaluations -= here.evaluations;
    before_.assemblies -= here.assemblies;
    before_.solves -= here.solves;
    before_.solver_iterations -= here.solver_iterations;
  }

  std::vector<PhaseAngle> phase_angle() const override { return {phase_angle_}; }
  std::vector<Warning> remarks() override { return std::exchange(remarks_, {}); }

  Columns next_row(const motion::TimeState& state, const ProgressRow& progress) override {
    const Eigen::Quaterniond turn = coupling::orientation_of(state.x);
    RunRow row;
    RigidRow now = rigid_row(particle_scene_, body_, free_->flow(), geometry_, free_->surface(state.x), free_->motion(state.x), turn,
                             free_->stresslet(state.x), ranks_);
    now.centre = coupling::centre_of(state.x);
    if (tube_) {
      const double pressure_drop = free_->pressure_drop(state.x);
      row.tube = tube_row(*tube_, free_->flow(), free_->force_density(state.x), pressure_drop);
    }
    if (scene_.wall.present) row.wall = wall_row(scene_.wall.planes(), body_, free_->surface(state.x));
    advance_phase(state.x, progress.step.step, now);
    row.progress = progress;
    row.progress.time = state.time, row.progress.counts = counts();
    Columns columns;
    row.add_columns(scene_, columns);
    now.add_columns(particle_scene_, columns);
    finish(columns);
    return columns;
  }

  SurfaceSnapshot snapshot(const motion::TimeState& state) override {
    const Net x = free_->surface(state.x), f = free_->force_density(state.x),
              v = coupling::rigid_velocity(x, free_->motion(state.x), coupling::centre_of(state.x));
    return {x, [f, v](const output::Nodes& nodes) {
              return std::vector<output::Field>{{"traction", nodes.values(-f)}, {"velocity", nodes.values(v)}};
            }};
  }

 private:
  static Body make_refined_body(const ParticleScene& particle_scene, coupling::Ranks& ranks, Phases& phases, std::vector<Warning>& remarks) {
    Body body = make_body(particle_scene);
    remarks = refine_isolated_body(particle_scene, body, [&](const Body& on) {
      const std::unique_ptr<coupling::Tube> wall = make_tube(particle_scene, on, phases);
      coupling::RigidTractions tractions = make_tractions(particle_scene, on, ranks, wall.get());
      const auto free = make_driven_body(particle_scene, on, tractions);
      return free->force_density(coupling::placed(free->centre()));
    });
    return body;
  }

  /// Returns the free body with the given equation for its traction, in a tube or a medium if the scene has one.
  static std::unique_ptr<coupling::LoneRigidBody> make_driven_body(const ParticleScene& particle_scene, const Body& body,
                                                                   coupling::RigidTractions& tractions) {
    const Vec3& centre = particle_scene.particle.shape.center;
    const coupling::RigidDrive driven = drive_of(particle_scene, body);
    if (particle_scene.tube.present)
      return std::make_unique<coupling::FreeBodyInTube>(tractions, body.rest, centre, body.radius, body.flow, particle_scene.flow.viscosity, driven);
    if (particle_scene.medium())
      return std::make_unique<coupling::FreeBodyInMedium>(tractions, body.rest, centre, body.radius, body.flow, driven);
    return std::make_unique<coupling::FreeBody>(tractions, body.rest, centre, body.radius, body.flow, driven);
  }

  /// Advances the phase of the rigid body by `step`. Sets in the row the phase, and the tank-treading velocity and frequency in the plane of the flow
  /// (Body::plane). The frequency (6.6) is the angular velocity about the normal of this plane.
  void advance_phase(const coupling::State& place, double step, RigidRow& now) {
    const FlowPlane& plane = body_.plane;
    const Net x = free_->surface(place), v = coupling::rigid_velocity(x, {now.velocity, now.angular_velocity}, now.centre);
    const Vec3 centre = plane.components(now.measures.centroid), moves = plane.components(now.velocity);
    now.treading.velocity = surface::tank_treading(geometry_.bezier(), plane.turned(x), plane.turned(v), nullptr, centre, moves).velocity;
    now.treading.frequency = plane.components(now.angular_velocity)[1];
    phase_angle_.advance(step, now.treading.frequency, angle_in(plane, coupling::rotation_of(place) * plane.axes.row(0).transpose()));
    now.phase = phase_angle_.degrees;
  }

  const Scene& scene_;
  const ParticleScene particle_scene_;
  const coupling::Ranks& ranks_;
  std::vector<Warning> remarks_;
  Body body_;
  surface::Geometry geometry_;
  std::unique_ptr<coupling::Tube> tube_;
  coupling::RigidTractions tractions_;
  std::unique_ptr<coupling::LoneRigidBody> free_;
  PhaseAngle phase_angle_;
  coupling::OperationCounts before_;  // work of earlier parts of a resumed run
};

}  // namespace

std::unique_ptr<ParticleSystem> make_free_body(const Scene& scene, coupling::Ranks& ranks, Phases& phases) {
  return std::make_unique<Free>(scene, ranks, phases);
}

}  // namespace tanktread
