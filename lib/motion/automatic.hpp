#pragma once

#include <vector>

#include "motion/bs3.hpp"
#include "motion/integrator.hpp"
#include "motion/rkc2.hpp"
#include "motion/tr_bdf2.hpp"

namespace tanktread::motion {

/// Chooses the scheme from the measured stiffness rho (4.7), which the frozen operator gives for less than an evaluation:
///
///   BS3 as long as the step that the error allows, the first one too, is stable, dt < 2.3/rho; else TR-BDF2, whose work per unit of time is counted;
///   back to BS3 when that is above 1.5 times 3/min(dt, 2.3/rho), and once more to TR-BDF2 when rho has changed or fifty steps have passed.
///
/// Where the frozen operator would be larger than `Time/largest operator`, RKC2, which needs none.
class Automatic : public Integrator {
 public:
  explicit Automatic(const TimeOptions& options) : options_(options), explicit_(options), implicit_(options), stabilised_(options) {}
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;

 private:
  struct Choice;
  Integrator& chosen(const Choice& choice);
  void measure(coupling::Dynamics& dynamics, State& state, Choice& choice) const;
  void reconsider(const State& state, const StepReport& report, Choice& choice) const;

  TimeOptions options_;
  Bs3 explicit_;
  TrBdf2 implicit_;
  Rkc2 stabilised_;
};

}  // namespace tanktread::motion
