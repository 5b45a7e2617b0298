#pragma once
// States of one block of points, and model motions of them that are written with nets.

#include <memory>
#include <vector>

#include "system/coupled_motion.hpp"

namespace tanktread {

/// Returns a state with one block "shape".
inline coupling::State state_of(const Net& x) {
  coupling::State state(std::make_shared<coupling::Layout>(std::vector<coupling::Block>{{"shape", 0, x.rows()}}));
  state(coupling::BlockId{0}) = x;
  return state;
}

/// Returns the points of a state with one block.
inline Eigen::Map<const Net> net(const coupling::State& state) { return {state.numbers().data(), state.numbers().size() / 3, 3}; }

/// Returns the solution of an implicit step of the shapes, see Dynamics::solve.
inline Net implicit_step(coupling::Capsule& capsule, double shift, const Net& r, double tolerance) {
  coupling::CoupledMotion motion(capsule);
  const coupling::State delta = motion.solve(shift, motion.state_of(r), tolerance, {});
  return motion.shape(delta);
}

/// Returns the derivative of the velocity of the shapes along `delta`, see Dynamics::derivative.
inline Net derivative_along(coupling::Capsule& capsule, const Net& x, const Net& v, const Net& delta) {
  coupling::CoupledMotion motion(capsule);
  const coupling::State change = motion.derivative(motion.state_of(x), motion.state_of(v), motion.state_of(delta));
  return motion.shape(change);
}

/// A motion of points without stiffness. Models override the functions of nets.
class PointMotion : public coupling::Dynamics {
 public:
  virtual Net velocity(const Net& x) = 0;
  virtual void linearise(const Net&) {}
  virtual Net solve(double, const Net& r, double, const coupling::Secants&) { return r; }
  virtual Net jacobian_error(const Net& change, const Net&, double) { return 0 * change; }
  virtual double norm(const Net& displacement) const = 0;

  coupling::State velocity(const coupling::State& x) final { return like(x, velocity(Net(net(x)))); }
  void linearise(const coupling::State& x) final { linearise(Net(net(x))); }
  coupling::State solve(double shift, const coupling::State& r, double tolerance, const coupling::Secants& secants) final {
    return like(r, solve(shift, Net(net(r)), tolerance, secants));
  }
  coupling::State jacobian_error(const coupling::State& change, const coupling::State& delta, double shift) final {
    return like(change, jacobian_error(Net(net(change)), Net(net(delta)), shift));
  }
  void restore_constraints(coupling::State&) override {}
  double norm(const coupling::State& displacement) const final { return norm(Net(net(displacement))); }

 private:
  static coupling::State like(coupling::State x, const Net& numbers) {
    x(coupling::BlockId{0}) = numbers;
    return x;
  }
};

}  // namespace tanktread
