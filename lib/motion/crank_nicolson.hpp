#pragma once

#include <memory>

#include "coupling/nonlinear.hpp"
#include "motion/integrator.hpp"

namespace tanktread::motion {

/// The paper's Crank-Nicolson (P-38), by default with its sub-iteration and its step rule (4.1):
///
///   x^{k+1} = x_n + dt/2 (v(x_n) + v(x^k))   until  |x^{k+1} - x^k|_2 / (R_C sqrt(m_C)) <= 1e-7;
///   more than 8 sub-iterations: dt x 0.75 and the step again; fewer than 4: dt x 1.33 for the next.
///
/// The first sub-iteration, from x^1 = x_n, is the Euler step. It costs no velocity evaluation; read to the letter it counts, and steps then
/// stay near the first one; not counted, the mean step is that of the paper's Table 3. Contracts only for dt rho < 2.
///
/// `Time/nonlinear solver` accelerates the same fixed point (Anderson) or finds it by Newton's method without a matrix, both by NOX.
/// `Time/step control: error` chooses steps by the distance to the explicit formula of the same order (Gresho, Lee & Sani 1980):
///
///   error = |x_{n+1} - x_AB2| / (3 (1 + dt_{n-1}/dt)),   x_AB2 = x_n + dt/2 ((2 + r) v_n - r v_{n-1}),  r = dt/dt_{n-1}        (4.10)
class CrankNicolson : public Integrator {
 public:
  CrankNicolson(const TimeOptions& options, const std::shared_ptr<Teuchos::ParameterList>& nox);
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;

 private:
  struct Attempt {
    Net y;
    int iterations = 0;
    bool converged = false;
  };
  void iterate(coupling::Dynamics& dynamics, const State& state, double dt, Attempt& attempt) const;

  TimeOptions options_;
  bool by_error_;
  std::unique_ptr<coupling::FixedPoint> solver_;  // none: plain
};

}  // namespace tanktread::motion
