// The free rigid body in the time loop.

#include <algorithm>
#include <cmath>
#include <iterator>

#include "app/moving.hpp"
#include "app/tube.hpp"
#include "coupling/rigid_body.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

namespace {

std::vector<Column> rigid_columns() {
  std::vector<Column> all = named(columns(), {"time", "time_step", "inclination"});
  all.insert(all.end(), {{"center_x1", "length", "centre of the body, component 1"},
                         {"center_x2", "length", "centre of the body, component 2"},
                         {"center_x3", "length", "centre of the body, component 3"},
                         {"velocity_x1", "length/time", "of the centre, component 1"},
                         {"velocity_x2", "length/time", "of the centre, component 2"},
                         {"velocity_x3", "length/time", "of the centre, component 3"},
                         {"angular_velocity_x1", "1/time", "component 1"},
                         {"angular_velocity_x2", "1/time", "component 2"},
                         {"angular_velocity_x3", "1/time", "component 3"},
                         {"quaternion_0", "1", "scalar part of the turn from the initial place"},
                         {"quaternion_1", "1", "vector part, component 1"},
                         {"quaternion_2", "1", "vector part, component 2"},
                         {"quaternion_3", "1", "vector part, component 3"}});
  std::ranges::copy(
      named(columns(), {"stresslet_11", "stresslet_22", "stresslet_33", "stresslet_12", "stresslet_13", "stresslet_23", "length_x1",
                        "length_x2", "length_x3", "n_control_points", "step_error", "rejected_steps", "evaluations", "wall_seconds"}),
      std::back_inserter(all));
  return all;
}

/// Further ones in a tube.
std::vector<Column> rigid_tube_columns() {
  std::vector<Column> all = named(tube_columns(), {"migration_velocity", "disturbed_pressure_drop", "gap"});
  std::ranges::copy(named(columns(), {"solver_iterations"}), std::back_inserter(all));
  return all;
}

}  // namespace

std::vector<Column> free_columns(const Scene& scene) {
  std::vector<Column> all = rigid_columns();
  if (scene.tube.present) std::ranges::copy(rigid_tube_columns(), std::back_inserter(all));
  return all;
}

namespace {

class Free : public Moving {
 public:
  Free(const Scene& scene, coupling::Ranks& ranks, Phases& phases)
      : body_(tanktread::body(scene)), geometry_(body_.space), tube_(tube(scene, body_, phases)),
        resistance_(body_.space, body_.rest, scene.flow.viscosity, scene.quadrature, scene.solvers, ranks, phases, tube_.get()),
        columns_(free_columns(scene)) {
    const Vec3& centre = scene.particle.shape.center;
    if (tube_)
      free_ = std::make_unique<coupling::FreeBodyInTube>(resistance_, centre, body_.radius, body_.flow, scene.flow.viscosity, scene.solvers);
    else
      free_ = std::make_unique<coupling::FreeBody>(resistance_, centre, body_.radius, body_.flow);
  }

  coupling::Dynamics& dynamics() override { return *free_; }
  const Body& body() const override { return body_; }
  Net start() const override { return coupling::placed(free_->centre()); }
  /// Counts go on as if the set-up had been done once.
  void resume(Resumed& resumed) override {
    const coupling::Work again = work();
    before_ = resumed.standing.work;
    before_.assemblies -= again.assemblies;
    before_.solves -= again.solves;
    before_.solver_iterations -= again.solver_iterations;
  }
  bool adapt(motion::State&, Standing&) override { return false; }
  const surface::BezierMap& bezier() const override { return geometry_.bezier(); }
  stokes::Evaluations kernel_evaluations() const override { return resistance_.kernel_evaluations(); }
  const std::vector<Column>& columns() const override { return columns_; }

  coupling::Work work() const override {
    coupling::Work work = before_;
    work.evaluations += free_->evaluations();
    work.assemblies += 1;
    work.solves += tube_ ? free_->evaluations() : 11;
    work.solver_iterations += iterations();
    return work;
  }

  std::vector<double> row(const motion::State& state, const motion::StepReport& report, double wall_seconds) override {
    const surface::Deformation shape = geometry_.deformation(free_->surface(state.x));
    const coupling::RigidMotion motion = free_->motion(state.x);
    const Mat3 s = free_->stresslet(state.x);
    const Net& x = state.x;
    const Vec3 &v = motion.velocity, &w = motion.angular_velocity;
    std::vector<double> row = {
            state.time,
            report.step,
            shape.inclination,
            x(0, 0), x(0, 1), x(0, 2),
            v[0], v[1], v[2],
            w[0], w[1], w[2],
            x(2, 0), x(1, 0), x(1, 1), x(1, 2),
            s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2),
            shape.lengths[0], shape.lengths[1], shape.lengths[2],
            static_cast<double>(body_.space.n_points),
            report.error,
            static_cast<double>(report.rejected),
            static_cast<double>(work().evaluations),
            wall_seconds};
    if (!tube_) return row;
    const Eigen::Vector2d across(x(0, 1), x(0, 2)), moves = v.tail<2>();
    const double sense = across.dot(moves) > 0 ? -1 : 1;
    row.insert(row.end(), {sense * moves.norm(), free_->pressure_drop(x), tube_->gap(), static_cast<double>(work().solver_iterations)});
    return row;
  }

  Portrait portrait(const motion::State& state) override {
    const Net x = free_->surface(state.x), f = free_->force_density(state.x),
              v = coupling::rigid_velocity(x, free_->motion(state.x), coupling::centre_of(state.x));
    return {x, [f, v](const output::Nodes& nodes, output::NodeRange range) {
              return std::vector<output::Field>{{"traction", nodes.values(-f, range)}, {"velocity", nodes.values(v, range)}};
            }};
  }

 private:
  long iterations() const {
    const auto* in_tube = dynamic_cast<const coupling::FreeBodyInTube*>(free_.get());
    return resistance_.solver_iterations() + (in_tube ? in_tube->solver_iterations() : 0);
  }

  Body body_;
  surface::Geometry geometry_;
  std::unique_ptr<coupling::Tube> tube_;
  coupling::Resistance resistance_;
  std::unique_ptr<coupling::RigidParticle> free_;
  std::vector<Column> columns_;
  coupling::Work before_;  // of earlier parts of a resumed run
};

}  // namespace

std::unique_ptr<Moving> free_body(const Scene& scene, coupling::Ranks& ranks, Phases& phases) {
  return std::make_unique<Free>(scene, ranks, phases);
}

}  // namespace tanktread
