#pragma once

#include "motion/integrator.hpp"

namespace tanktread::motion {

/// The motion within a step: the cubic that has the places and slopes of both ends (Hermite), fourth order in the step at no evaluation.
class DenseOutput {
 public:
  /// Both states with their slopes in history.front(), on one mesh, `after` later than `before`.
  DenseOutput(const State& before, const State& after);

  Net place(double time) const;
  Net slope(double time) const;  ///< the derivative of `place`, third order

 private:
  double start_, step_;
  Net x0_, x1_, v0_, v1_;
};

}  // namespace tanktread::motion
