#pragma once
// A capsule or drop in the time loop whose surface carries something along: what is the same whatever that is.

#include <optional>
#include <string_view>

#include "app/particle_system.hpp"
#include "app/scene.hpp"
#include "coupling/carried_motion.hpp"

namespace tanktread {

/// The state's nets are those of CarriedMotion, of which the particle sees its own rows. What is carried belongs to a derived class, which says it to
/// `carry` when it is made.
class CarryingParticle : public ParticleSystem {
 public:
  coupling::Dynamics& dynamics() override { return *motion_; }
  const coupling::Capsule* capsule() const override { return particle_->capsule(); }
  const Body& body() const override { return particle_->body(); }
  Net start() const override { return motion_->start(particle_->start()); }
  const surface::BezierMap& bezier() const override { return particle_->bezier(); }
  bool resume(Resumed& resumed) override;
  void store(output::Checkpoint& checkpoint) const override { particle_->store(checkpoint); }
  void forget_recycled() override { particle_->forget_recycled(); }
  bool adapt(motion::State& state, RunTotals& totals) override;
  std::vector<Warning> remarks() override { return particle_->remarks(); }
  coupling::Work work() const override { return particle_->work(); }
  std::vector<PhaseAngle> phase_angle() const override { return particle_->phase_angle(); }
  stokes::Evaluations kernel_evaluations() const override { return particle_->kernel_evaluations(); }

  /// The particle's own, with what `complete` makes of it.
  std::vector<double> row(const motion::State& state, const motion::StepReport& report, double wall_seconds) override;
  SurfacePicture picture(const motion::State& state) override;

 protected:
  CarryingParticle(const Scene& scene, coupling::Ranks& ranks, Phases& phases) : scene_(scene), particle_(deforming(scene, ranks, phases)) {}

  void carry(membrane::Carried& carried);
  const Scene& scene() const { return scene_; }

  std::size_t column(std::string_view name) const;  ///< of a row, by the name of its series

  /// With what is of this kind alone, at the place that what is carried was told last; `q` there.
  virtual void complete(std::vector<double>& row, const Eigen::VectorXd& q) = 0;
  virtual void complete(SurfacePicture&) {}

 private:
  void take_particle();
  void own_power(std::vector<double>& row, const motion::State& own);
  motion::State of_particle(const motion::State& state) const;

  const Scene& scene_;
  std::unique_ptr<ParticleSystem> particle_;
  membrane::Carried* carried_ = nullptr;
  std::optional<coupling::CarriedMotion> motion_;
  motion::State pictured_;  // which the latest picture's fields look at
};

}  // namespace tanktread
