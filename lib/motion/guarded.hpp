#pragma once
// Wrapper of a motion whose evaluations have the same outcome on all ranks.

#include <functional>
#include <string>

#include "system/dynamics.hpp"

namespace tanktread::motion {

using coupling::State;

/// Wraps another motion for the integrators. An evaluation at a trial shape may fail on some ranks, because a solver does not converge, the surface
/// is folded or open, or values are not finite. The result is then NaN on all ranks, and every scheme shortens its step. If memory runs out, all
/// ranks throw RunFailure. If a rank is to stop, all ranks throw Stopped at the next velocity evaluation. The decisions of a scheme depend on norms.
/// Every rank uses the norms of the first rank, so that all decisions are equal. Collective, like the motion.
class GuardedDynamics : public coupling::Dynamics {
 public:
  explicit GuardedDynamics(coupling::Dynamics& motion) : motion_(motion) {}

  void set_time(double time, double start) override { motion_.set_time(time, start); }
  double next_kink(double time) const override { return motion_.next_kink(time); }
  State velocity(const State& x) override;
  std::string why_undefined() const override { return motion_.why_undefined(); }
  void freeze(const State& x) override;
  bool lattice_moves() const override { return motion_.lattice_moves(); }
  double frozen_bytes() const override { return motion_.frozen_bytes(); }
  void linearise(const State& x) override;
  State solve(double shift, const State& r, double tolerance, const coupling::Secants& secants) override;
  State defect(const State& x, const State& u) override;
  State correction(double shift, const State& defect, double tolerance, const coupling::Secants& secants) override;
  State jacobian_error(const State& change, const State& delta, double shift) override;
  State derivative(const State& x, const State& v, const State& delta) override;
  bool defect_spares_system() const override { return motion_.defect_spares_system(); }
  State mesh_motion(const State& delta) override { return motion_.mesh_motion(delta); }
  void restore_constraints(State& x) override;
  void improve_start(State& y, const State& before, double shift) override;
  std::vector<State> relabellings(const State& x) override { return motion_.relabellings(x); }
  State symmetric(State rate) const override { return motion_.symmetric(std::move(rate)); }
  double distance(const State& from, const State& to) const override;
  double norm(const State& displacement) const override;

  /// Returns the reason of the latest failed evaluation; empty if none has failed.
  const std::string& failure() const { return failure_; }

 private:
  bool done(const std::function<bool()>& act);
  State tried(const State& like, const std::function<State()>& evaluate);

  coupling::Dynamics& motion_;
  std::string failure_;
  bool linearised_ = false;
};

}  // namespace tanktread::motion
