// A drop with surfactant in the time loop: the drop alone, and what its surfactant adds.

#include <algorithm>
#include <string_view>
#include <utility>

#include "app/particle_system.hpp"
#include "app/scene.hpp"
#include "app/series.hpp"
#include "coupling/surfactant_motion.hpp"
#include "output/nodes.hpp"

namespace tanktread {

namespace {

/// The state's nets are those of SurfactantMotion, of which the drop sees its own rows.
class SurfactantDrop : public ParticleSystem {
 public:
  SurfactantDrop(const Scene& scene, coupling::Ranks& ranks, Phases& phases)
      : scene_(scene), drop_(deforming(scene, ranks, phases)),
        surfactant_(body().space, body().initial, *scene.surfactant, scene.modulus(),
                    scene.surfactant->diffusivity_of(scene.flow.rate(), scene.radius())) {
    take_drop();
  }

  coupling::Dynamics& dynamics() override { return *motion_; }
  const coupling::Capsule* capsule() const override { return drop_->capsule(); }
  const Body& body() const override { return drop_->body(); }
  Net start() const override { return motion_->start(drop_->start()); }
  const surface::BezierMap& bezier() const override { return drop_->bezier(); }

  bool resume(Resumed& resumed) override {
    motion::State whole = std::exchange(resumed.state, of_drop(resumed.state));
    const bool another_mesh = drop_->resume(resumed);
    resumed.state = std::move(whole);
    take_drop();
    return another_mesh;
  }

  void store(output::Checkpoint& checkpoint) const override { drop_->store(checkpoint); }

  bool adapt(motion::State& state, RunTotals& totals) override {
    motion::State drop = of_drop(state);
    const bool another_mesh = drop_->adapt(drop, totals);
    state.x = motion_->with_shape(state.x, drop.x);
    for (std::size_t k = 0; k < state.history.size(); ++k) state.history[k] = motion_->with_shape(state.history[k], drop.history[k]);
    return another_mesh;
  }

  std::vector<Warning> remarks() override { return drop_->remarks(); }
  coupling::Work work() const override { return drop_->work(); }
  std::vector<PhaseAngle> phase_angle() const override { return drop_->phase_angle(); }
  stokes::Evaluations kernel_evaluations() const override { return drop_->kernel_evaluations(); }

  std::vector<double> row(const motion::State& state, const motion::StepReport& report, double wall_seconds) override {
    std::vector<double> row = drop_->row(of_drop(state), report, wall_seconds);
    const Eigen::VectorXd content = motion_->content(state.x);
    surfactant_.place(motion_->shape(state.x), content);
    row[energy_] += surfactant_.energy();
    row[smallest_tension_] = scene_.surfactant->tension(surfactant_.largest());
    Moment now;
    now.surfactant_mass = surfactant_.mass(content);
    now.smallest_concentration = surfactant_.smallest(), now.largest_concentration = surfactant_.largest();
    const std::vector<double> of_this = tanktread::row(series(scene_, of_surfactant), now);
    row.insert(row.end(), of_this.begin(), of_this.end());
    return row;
  }

  SurfacePicture picture(const motion::State& state) override {
    motion_->place(state.x);
    pictured_ = of_drop(state);
    SurfacePicture picture = drop_->picture(pictured_);
    const auto of_shape = picture.fields;
    picture.fields = [of_shape, options = *scene_.surfactant, concentration = surfactant_.concentration()](const output::Nodes& nodes) {
      std::vector<output::Field> fields = of_shape(nodes);
      const Eigen::VectorXd c = nodes.values(concentration.replicate(1, 3)).col(0);
      for (output::Field& field : fields)
        if (field.name == "smallest tension" || field.name == "largest tension")
          field.values = c.unaryExpr([&](double here) { return options.tension(here); });
      fields.push_back({"concentration", c});
      return fields;
    };
    return picture;
  }

 private:
  /// Of a row.
  std::size_t column(std::string_view name) const {
    const std::vector<Series> all = run_series(scene_);
    return static_cast<std::size_t>(std::ranges::find(all, name, &Series::name) - all.begin());
  }

  void take_drop() { motion_.emplace(static_cast<coupling::Capsule&>(drop_->dynamics()), surfactant_); }

  motion::State of_drop(const motion::State& state) const {
    motion::State drop = state;
    drop.x = motion_->shape(state.x);
    for (Net& slope : drop.history) slope = motion_->shape(slope);
    return drop;
  }

  const Scene& scene_;
  std::unique_ptr<ParticleSystem> drop_;
  membrane::Surfactant surfactant_;
  std::optional<coupling::SurfactantMotion> motion_;
  std::size_t energy_ = column("energy"), smallest_tension_ = column("smallest_tension");  // columns that are of the clean drop and the surfactant
  motion::State pictured_;  // which the latest picture's fields look at
};

}  // namespace

std::unique_ptr<ParticleSystem> surfactant_drop(const Scene& scene, coupling::Ranks& ranks, Phases& phases) {
  return std::make_unique<SurfactantDrop>(scene, ranks, phases);
}

}  // namespace tanktread
