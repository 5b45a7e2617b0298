#pragma once

#include "motion/integrator.hpp"

namespace tanktread::motion {

/// TR-BDF2 (Hosea & Shampine 1996) with a quasi-Newton solve on the frozen-geometry Jacobian (4.3): L-stable, second order, one step.
///
///   d = 1 - 1/sqrt(2), w = sqrt(2)/4; stages at 0, 2d, 1; b = (w, w, d); embedded b^ = ((1 - w)/3, (3w + 1)/3, d/3)
///
/// The first slope is the last one of the step before; slopes are algebraic, never evaluated again. Stages start from a polynomial
/// through the slopes at hand. The contraction rate of the iteration is remembered across steps, so that one evaluation a stage can do;
/// above `Time/contraction limit` the layer operator is assembled anew.
class TrBdf2 : public Integrator {
 public:
  explicit TrBdf2(const TimeOptions& options) : options_(options) {}
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;

 private:
  TimeOptions options_;
};

}  // namespace tanktread::motion
