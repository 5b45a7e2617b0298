#pragma once

#include "motion/integrator.hpp"

namespace tanktread::motion {

/// Bogacki & Shampine 1989, explicit, third order with an embedded second: three velocity evaluations a step, the last slope is the
/// first one of the next. Stable for dt rho <= 2.51 with rho the stiffness (4.5).
class Bs3 : public Integrator {
 public:
  explicit Bs3(const TimeOptions& options) : options_(options) {}
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;

 private:
  TimeOptions options_;
};

}  // namespace tanktread::motion
