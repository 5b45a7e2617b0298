#pragma once
// Wrapper of a motion whose evaluations have the same outcome on all ranks.

#include <functional>
#include <string>

#include "system/dynamics.hpp"

namespace tanktread::motion {

/// Wraps another motion for the integrators. An evaluation at a trial shape may fail on some ranks, because a solver does not converge, the surface
/// is folded or open, or values are not finite. The result is then NaN on all ranks, and every scheme shortens its step. If memory runs out, all
/// ranks throw RunFailure. If a rank is to stop, all ranks throw Stopped at the next velocity evaluation. The decisions of a scheme depend on norms.
/// Every rank uses the norms of the first rank, so that all decisions are equal. Collective, like the motion.
class GuardedDynamics : public coupling::Dynamics {
 public:
  explicit GuardedDynamics(coupling::Dynamics& motion) : motion_(motion) {}

  void set_time(double time, double start) override { motion_.set_time(time, start); }
  double next_kink(double time) const override { return motion_.next_kink(time); }
  Net velocity(const Net& x) override;
  std::string why_undefined() const override { return motion_.why_undefined(); }
  void freeze(const Net& x) override;
  bool lattice_moves() const override { return motion_.lattice_moves(); }
  double frozen_bytes() const override { return motion_.frozen_bytes(); }
  void linearise(const Net& x) override;
  Net solve(double shift, const Net& r, double tolerance, const coupling::Secants& secants) override;
  Net defect(const Net& x, const Net& u) override;
  Net correction(double shift, const Net& defect, double tolerance, const coupling::Secants& secants) override;
  Net jacobian_error(const Net& change, const Net& delta, double shift) override;
  Net derivative(const Net& x, const Net& v, const Net& delta) override;
  bool defect_spares_system() const override { return motion_.defect_spares_system(); }
  Net mesh_motion(const Net& delta) override { return motion_.mesh_motion(delta); }
  void restore_constraints(Net& x) override;
  void improve_start(Net& y, const Net& before, double shift) override;
  std::vector<Net> relabellings(const Net& x) override { return motion_.relabellings(x); }
  Net turned(const Net& x, const Mat3& rotation) const override { return motion_.turned(x, rotation); }
  Net moved(const Net& x, const coupling::RigidMotion& motion) const override { return motion_.moved(x, motion); }
  Net symmetric(Net rate) const override { return motion_.symmetric(std::move(rate)); }
  double distance(const Net& from, const Net& to) const override;
  double norm(const Net& displacement) const override;

  /// Returns the reason of the latest failed evaluation; empty if none has failed.
  const std::string& failure() const { return failure_; }

 private:
  bool done(const std::function<bool()>& act);
  Net tried(const Net& like, const std::function<Net()>& evaluate);

  coupling::Dynamics& motion_;
  std::string failure_;
  bool linearised_ = false;
};

}  // namespace tanktread::motion
