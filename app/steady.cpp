#include "app/steady.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <optional>

#include <Eigen/SVD>

#include "app/particle_system.hpp"
#include "app/plan.hpp"
#include "app/results.hpp"
#include "app/run_totals.hpp"
#include "app/series.hpp"
#include "app/signals.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "coupling/agreement.hpp"
#include "coupling/kernel_count.hpp"
#include "motion/guarded.hpp"

namespace tanktread {

namespace {

output::Entries<long> counts(const RunTotals& totals) {
  output::Entries<long> all;
  each_count(totals, [&](const char* name, auto, auto, const auto& count) { all.emplace_back(name, static_cast<long>(count)); });
  return all;
}

/// The rigid motions about the origin that change nothing of flow, weight and walls: those whose Lie derivative of the flow vanishes.
std::vector<coupling::RigidMotion> free_motions(const Scene& scene, const Body& body) {
  if (body.wall) return {coupling::unit_motion(0)};
  const double size = body.radius;
  Net places(4, 3);
  places << size, 0, 0, 0, size, 0, 0, 0, size, size, size, size;
  const Net v = body.flow.velocities(places);
  const std::vector<Mat3> gradients = body.flow.gradients(places);
  Eigen::Matrix<double, 15, 6> change;
  for (int k = 0; k < 6; ++k) {
    const coupling::RigidMotion motion = coupling::unit_motion(k);
    const double unit = k < 3 ? 1 : 1 / size;
    const Net moved = coupling::rigid_velocity(places, motion, Vec3::Zero());
    for (int i = 0; i < 4; ++i)
      change.block<3, 1>(3 * i, k) =
          unit * (gradients[static_cast<std::size_t>(i)] * moved.row(i).transpose() - motion.angular_velocity.cross(Vec3(v.row(i).transpose())));
    change.block<3, 1>(12, k) = motion.angular_velocity.cross(scene.body_force());
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(change, Eigen::ComputeFullV);
  std::vector<coupling::RigidMotion> free;
  for (int k = 0; k < 6; ++k) {
    if (svd.singularValues()[k] > 1e-9 * std::max(scene.rate(), svd.singularValues()[0])) continue;
    const Eigen::VectorXd motion = svd.matrixV().col(k);
    free.push_back({motion.head<3>(), motion.tail<3>() / size});
  }
  return free;
}

/// The shapes that are looked at, one after another, and what is written of each.
class SteadyRun {
 public:
  SteadyRun(const Scene& scene, const RunRequest& request)
      : scene_(scene), request_(request), particle_(deforming(scene, ranks_, phases_)),
        results_(scene, request, particle_->body(), particle_->bezier(), ranks_) {
    ranks_.measure(phases_);
  }

  int go() {
    stop_where_told();
    if (ranks_.rank() == 0 && !request_.quiet) std::fputs(plan_text(chosen_).c_str(), stdout);
    clock_.emplace(phases_, "steady shape");
    state_.x = particle_->start();
    motion().restore_volume(state_.x);
    state_.history = {motion().velocity(state_.x)};
    if (!state_.history.front().allFinite()) throw RunFailure("the velocity of the initial shape cannot be had: " + motion().failure());
    if (scene_.steady.present) find_shape();
    if (scene_.spectrum.present) find_modes();
    record();
    save();
    clock_.reset();
    return close();
  }

 private:
  using Clock = std::chrono::steady_clock;
  motion::GuardedDynamics& motion() { return motion_; }

  void find_shape() {
    motion::SteadyOptions options = scene_.steady;
    if (!options.step) options.step = 0.5 / scene_.rate();
    const motion::SteadyReport found = motion::find_steady(motion(), free_motions(scene_, particle_->body()), options, scene_.solvers, state_.x);
    report_.iterations = found.iterations;
    report_.error = found.rest;
    state_.history = {motion().velocity(state_.x)};
    if (!found.converged)
      failure_ = formatted("the steady shape was not found: after %d iterations the correction is %.2g", found.iterations, found.rest);
  }

  void find_modes() {
    const auto clock = phases_.time("spectrum");
    const coupling::Capsule& capsule = *particle_->capsule();
    const Body& body = particle_->body();
    const coupling::ShapeCoordinates shapes(body.space, capsule.particles(), body.symmetry, state_.x);
    if (scene_.spectrum.number > shapes.size())
      throw UserError(formatted("Spectrum/number must be at most %ld, the number of unknowns, but is %d.", static_cast<long>(shapes.size()),
                                scene_.spectrum.number));
    motion::SpectrumOptions options = scene_.spectrum;
    if (!options.shift) options.shift = scene_.rate();
    modes_ = motion::spectrum(motion(), shapes, state_.x, capsule.geometry().volume_gradient(state_.x), options,
                              scene_.solvers.of(scene_.solvers.spectrum));
    motion().velocity(state_.x);
  }

  void record() {
    const auto clock = phases_.time("diagnostics");
    totals_.work = particle_->work();
    totals_.kernel = coupling::of_all(particle_->kernel_evaluations(), ranks_);
    totals_.phase_angle = particle_->phase_angle();
    std::vector<double> row = particle_->row(state_, report_, std::chrono::duration<double>(Clock::now() - start_).count());
    const std::vector<Series> of_one = series(scene_, of_mode);
    for (const motion::Mode& mode : modes_) {
      Moment now;
      now.rate = mode.rate;
      std::ranges::copy(tanktread::row(of_one, now), std::back_inserter(row));
    }
    coupling::take_first(row);
    results_.record(row);
  }

  void save() {
    const auto clock = phases_.time("output");
    output::Checkpoint checkpoint;
    particle_->store(checkpoint);
    SurfacePicture picture = particle_->picture(state_);
    picture.fields = [this, of_shape = picture.fields](const output::Nodes& nodes) {
      std::vector<output::Field> fields = of_shape(nodes);
      int k = 0;
      for (const motion::Mode& mode : modes_) {
        const std::string name = "mode " + std::to_string(++k);
        fields.push_back({name, nodes.values(mode.real)});
        if (mode.rate.imag() != 0) fields.push_back({name + " imaginary", nodes.values(mode.imaginary)});
      }
      return fields;
    };
    results_.save(std::move(checkpoint), state_, totals_, picture, state_.time);
  }

  int close() {
    Account account;
    account.plan = chosen_;
    if (!failure_.empty()) account.status = "failed: " + failure_, account.whole = false;
    account.counts = counts(totals_);
    int k = 0;
    for (const motion::Mode& mode : modes_) account.modes.emplace_back(std::to_string(++k), motion::name(mode.kind));
    const int code = results_.close(account, phases_);
    if (!failure_.empty()) throw RunFailure(failure_ + "; what was reached is in " + results_.directory().string());
    return code;
  }

  const Scene& scene_;
  const RunRequest& request_;
  const Clock::time_point start_ = Clock::now();
  Phases phases_ = started();
  std::optional<Phases::Scope> clock_{std::in_place, phases_, "set-up"};
  coupling::Ranks ranks_;
  std::unique_ptr<ParticleSystem> particle_;
  output::Entries<std::string> chosen_ = plan(scene_, particle_->body(), ranks_.size());
  Results results_;
  motion::GuardedDynamics motion_{particle_->dynamics(), told_to_stop};
  motion::State state_;
  motion::StepReport report_;
  RunTotals totals_;
  std::vector<motion::Mode> modes_;
  std::string failure_;
};

}  // namespace

int find_steady(const Scene& scene, const RunRequest& request) {
  if (request.resume) throw UserError("--resume and Spectrum contradict each other: a steady problem has nothing to go on with.");
  return SteadyRun(scene, request).go();
}

}  // namespace tanktread
