#pragma once

#include "motion/integrator.hpp"

namespace tanktread::motion {

/// Runge-Kutta-Chebyshev of second order (Sommeijer, Shampine & Verwer 1998), explicit and stabilised: as many stages as the step needs,
///
///   s = 1 + sqrt(1 + 1.54 dt rho),   stable for dt rho <= 0.653 (s^2 - 1)                                                  (4.8)
///
/// so the work of a long step grows with the root of the stiffness (4.7) only. Nothing is assembled and no system is solved. The stiffness
/// is measured by differences of velocities, at the start, every 25 steps, and after an attempt that failed.
class Rkc2 : public Integrator {
 public:
  explicit Rkc2(const TimeOptions& options) : options_(options) {}
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;

 private:
  TimeOptions options_;
};

/// Stages that a step dt needs at the stiffness rho (4.8).
int rkc2_stages(double dt, double rho);

}  // namespace tanktread::motion
