#pragma once
// A motion that can be stopped between two of its velocity evaluations: a step of a large scene takes minutes.

#include <functional>

#include "coupling/dynamics.hpp"

namespace tanktread {

/// What a velocity evaluation ends with that was told to stop. Not an error: no scheme takes it for one.
struct Stopped {};

/// Another motion, which throws Stopped before a velocity evaluation where `told` says so. Collective, as `told` is.
class Heeding : public coupling::Dynamics {
 public:
  Heeding(coupling::Dynamics& motion, std::function<bool()> told) : motion_(motion), told_(std::move(told)) {}

  Net velocity(const Net& x) override {
    if (told_()) throw Stopped();
    return motion_.velocity(x);
  }
  void at(double time, double start) override { motion_.at(time, start); }
  double next_kink(double time) const override { return motion_.next_kink(time); }
  void freeze(const Net& x) override { motion_.freeze(x); }
  double frozen_bytes() const override { return motion_.frozen_bytes(); }
  void linearise(const Net& x) override { motion_.linearise(x); }
  Net solve(double shift, const Net& r, double tolerance, const coupling::Secants& secants) override {
    return motion_.solve(shift, r, tolerance, secants);
  }
  Net missed(const Net& dv, const Net& delta) override { return motion_.missed(dv, delta); }
  Net derivative(const Net& x, const Net& v, const Net& delta) override { return motion_.derivative(x, v, delta); }
  void restore_volume(Net& x) override { motion_.restore_volume(x); }
  Net symmetric(Net rate) const override { return motion_.symmetric(std::move(rate)); }
  double norm(const Net& displacement) const override { return motion_.norm(displacement); }

 private:
  coupling::Dynamics& motion_;
  std::function<bool()> told_;
};

}  // namespace tanktread
