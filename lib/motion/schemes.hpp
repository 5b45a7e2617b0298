#pragma once
// The schemes of `Time/scheme`, and the step control that they share.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "motion/integrator.hpp"
#include "system/solvers/nonlinear.hpp"

namespace tanktread::motion {

/// Returns a struct of doubles from the front of TimeState::memory, or a default-constructed one if the memory is shorter; inverse of values_of().
template <class Memory>
Memory remembered(const std::vector<double>& values) {
  Memory memory;
  if (values.size() * sizeof(double) >= sizeof memory) std::memcpy(static_cast<void*>(&memory), values.data(), sizeof memory);
  return memory;
}
template <class Memory>
std::vector<double> values_of(const Memory& memory) {
  std::vector<double> values(sizeof memory / sizeof(double));
  std::memcpy(values.data(), &memory, sizeof memory);
  return values;
}

/// Returns the factor between 0.3 and 2 by which a PI controller multiplies the step. `error`: error of the step divided by the tolerance.
/// `previous`: this ratio for the previous accepted step, 0 if there is none. The error is proportional to the step to the power `power`. Source:
/// Gustafsson 1991.
double step_factor(double error, double previous, int power);

/// Returns the largest allowed error of a step divided by the tolerance, for a scheme of this order whose error estimate has the same order as its
/// result. The error of a run is the sum of the errors of its steps, whose number grows like tolerance^(-1/(order + 1)). With this fraction the sum
/// stays proportional to the tolerance (Soderlind & Wang 2006):
///
///   min(1, (tolerance/1e-3)^(1/order))                                                                                            (4.31)
double step_share(double tolerance, int order);

/// Chooses the sizes of the attempts at one step towards `limit`, and prepares the report of the step.
class Attempts {
 public:
  Attempts(const TimeOptions& options, TimeState& state, double limit)
      : options_(options), state_(state), limit_(limit),
        proposed_(options.fixed_step.value_or(std::min(state.step, options.maximum_step.value_or(1e300)))) {}

  /// Returns the size of the next attempt, at most `longest`. Throws RunFailure if the controller requests a step below `Time/minimum step`, unless
  /// this step reaches the time `limit`.
  double next(double longest = 1e300);

  /// Returns whether an attempt with this error, divided by the tolerance, is accepted. Throws RunFailure if a step of fixed size has an error that
  /// is not finite; `kind` names the scheme in the message.
  bool accepts(double error, const char* kind) const;

  /// Rejects the attempt. The next attempt is `part` times as large. `error`: error of the attempt divided by the tolerance; 0 if unknown. If the
  /// previous attempt was rejected with a larger error, the two errors give the power p of error ~ dt^p, at least 1/2. The size is then also limited
  /// to the size that p predicts for an acceptable error, or to a tenth of the rejected size if this is larger. (p is below 1 while a shape relaxes
  /// after mesh refinement.) Source: Gustafsson 1994.
  void reject(double part, double error = 0);

  /// Ends the step at y and returns the report. Sets the position and time of the state. Sets the size of the next step to `factor` times the size of
  /// this step. If this step was shortened, for example to end at the time `limit`, the next step is at least as long as this step before it was
  /// shortened. `error`: error of the step divided by the allowed error, which is the tolerance times `share` (4.31). The scheme updates its history
  /// and memory itself.
  StepReport accept(const coupling::Dynamics& dynamics, State y, double error, double factor, double share = 1);

  StepReport report;  ///< the scheme counts `iterations`

 private:
  const TimeOptions& options_;
  TimeState& state_;
  double limit_, proposed_, size_ = 0;
  double rejected_size_ = 0, rejected_error_ = 0;  // size and error of the previous rejected attempt
};

class Scheme : public Integrator {
 public:
  explicit Scheme(const TimeOptions& options) : options_(options) {}

 protected:
  TimeOptions options_;
};

/// The explicit scheme of Bogacki & Shampine (1989), of third order with an embedded second-order result. It needs three velocity evaluations per
/// step, because the last slope of a step is the first slope of the next step. It is stable for dt rho <= 2.51 with rho the stiffness (4.5).
class Bs3 : public Scheme {
 public:
  using Scheme::Scheme;
  StepReport advance(coupling::Dynamics& dynamics, TimeState& state, double limit) override;
};

/// Runge-Kutta-Chebyshev of second order (Sommeijer, Shampine & Verwer 1998), explicit and stabilised. The number of stages depends on the step:
///
///   s = 1 + sqrt(1 + 1.54 dt rho),   stable for dt rho <= 0.653 (s^2 - 1)                                                  (4.8)
///
/// The work of a long step therefore grows only with the square root of the stiffness (4.7). Nothing is assembled, and no system is solved. The
/// stiffness is measured by differences of velocities at the start, every 25 steps, and after a failed attempt.
class Rkc2 : public Scheme {
 public:
  using Scheme::Scheme;
  StepReport advance(coupling::Dynamics& dynamics, TimeState& state, double limit) override;
};

/// Returns the number of stages that a step dt of RKC2 needs at the stiffness rho (4.8).
int rkc2_stages(double dt, double rho);

/// Returns the stiffness rho of the system at x, where the velocity is v. rho is the spectral radius of the Jacobian J = dv/dx, computed by power
/// iteration (4.7). The result is a lower bound: eight iterations from a random direction, or two from the direction of an earlier call, give at
/// least 0.9 rho. The iteration starts from `direction` and stores its last direction there, normalised to 1. If `direction` and x differ in size,
/// the iteration starts from pseudo-random numbers that are the same in every run. An iteration costs one product with the frozen operator, or one
/// velocity evaluation if nothing is assembled.
double stiffness(coupling::Dynamics& dynamics, const State& x, const State& v, State& direction, int iterations);

/// Measures the stiffness (4.7) at the state, with three iterations if the direction of an earlier measurement on the same mesh is known, otherwise
/// with eight. Sets `stiffness`, unless the result is not finite, `age` (0) and `size` in the memory of a scheme. Returns the number of iterations.
template <class Memory>
int measure_stiffness(coupling::Dynamics& dynamics, TimeState& state, Memory& memory) {
  const auto size = static_cast<double>(state.x.numbers().size());
  const int iterations = memory.size == size && state.direction.numbers().size() == state.x.numbers().size() ? 3 : 8;
  dynamics.set_time(state.time, state.time);
  const double found = stiffness(dynamics, state.x, state.history.front(), state.direction, iterations);
  if (std::isfinite(found)) memory.stiffness = found;
  memory.age = 0, memory.size = size;
  return iterations;
}

/// The Crank-Nicolson scheme of the paper by Maestre et al. (2017), equation 38, by default with its sub-iteration and its step rule (4.1):
///
///   x^{k+1} = x_n + dt/2 (v(x_n) + v(x^k))   until  |x^{k+1} - x^k|_2 / (R_C sqrt(m_C)) <= 1e-7;
///   after more than 8 sub-iterations, the step is repeated with 0.75 dt; after fewer than 4, the next step is 1.33 dt.
///
/// Here m_C is the number of control points. The first sub-iteration, from x^1 = x_n, is the Euler step, which costs no velocity evaluation. By
/// default it counts as a sub-iteration, as the paper describes, and all steps stay near the size of the first step. With `Time/count euler step:
/// false` it does not count, and the mean step agrees with Table 3 of the paper. The sub-iteration contracts only if dt rho < 2, with rho the
/// stiffness (4.7).
///
/// `Time/nonlinear solver` accelerates this fixed-point iteration (Anderson) or replaces it by matrix-free Newton-Krylov iteration, both by NOX.
/// `Time/step control: error` chooses steps by the difference to the explicit formula of the same order (Gresho, Lee & Sani 1980):
///
///   error = |x_{n+1} - x_AB2| / (3 (1 + dt_{n-1}/dt)),   x_AB2 = x_n + dt/2 ((2 + r) v_n - r v_{n-1}),  r = dt/dt_{n-1}        (4.10)
class CrankNicolson : public Scheme {
 public:
  CrankNicolson(const TimeOptions& options, const std::shared_ptr<Teuchos::ParameterList>& nox);
  StepReport advance(coupling::Dynamics& dynamics, TimeState& state, double limit) override;

 private:
  struct Iteration {
    State y;
    int count = 0;
    bool converged = false;
  };
  Iteration iterate(coupling::Dynamics& dynamics, const TimeState& state, double dt, const State& start) const;

  bool by_error_;
  std::unique_ptr<coupling::FixedPoint> solver_;  // NOX solver of the step; null for the fixed-point iteration (4.1) without acceleration
};

/// TR-BDF2 (Hosea & Shampine 1996) with local extrapolation: a one-step method of third order, L-stable with the exact Jacobian J.
///
///   d = 1 - 1/sqrt(2), w = sqrt(2)/4; stages at 0, 2d, 1; b = (w, w, d); embedded b^ = ((1 - w)/3, (3w + 1)/3, d/3)               (4.4)
///   e1 = (I - d dt J)^-1 dt sum (b_i - b^_i) k_i,   e2 = (I - d dt J)^-1 e1,   x_(n+1) = x_n + dt sum b_i k_i - e2                 (4.30)
///
/// Here k_i are the slopes of the three stages. The formula b^ is of third order but not stable. e2 is the difference between the results of b and
/// b^, after two solves that damp its stiff modes. A step multiplies a mode with z = dt J by R(z) + (R^ - R)/(1 - d z)^2, where R and R^ are the
/// stability functions of b and b^. The modulus of this factor is at most 1 in the left half plane and 0 at infinity. In e1 and e2, J is the frozen
/// Jacobian (4.3) without secants (4.13), because an error of J changes the result only at fourth order. The local error is a quarter of |e1|, which
/// bounds the error of the extrapolated result, plus the errors of the two stages (4.28).
///
/// The first slope is the last slope of the previous step. The other slopes are computed from the stage equations, without further evaluations of the
/// velocity. The initial guess of a stage is extrapolated by a polynomial through the known slopes.
class TrBdf2 : public Scheme {
 public:
  using Scheme::Scheme;
  StepReport advance(coupling::Dynamics& dynamics, TimeState& state, double limit) override;
};

/// Third-order backward differentiation with variable steps. The derivative at t_{n+1} of the cubic through x_{n+1}, x_n, x_{n-1}, x_{n-2} is
/// v(x_{n+1}); a_i are the weights of the earlier positions in this derivative:
///
///   x_{n+1} - shift v(x_{n+1}) = -shift (a_0 x_n + a_1 x_{n-1} + a_2 x_{n-2}),   1/shift = sum 1/(t_{n+1} - t_{n-i})              (4.9)
///
/// This single stage is solved by quasi-Newton iteration with the frozen-geometry Jacobian (4.3). The start value is the prediction by the cubic
/// through the last four positions. The local error is the difference between result and prediction times shift/(t_{n+1} - t_{n-3}). Its limit is
/// reduced by (4.31). Steps grow by at most a factor of 1.5 (zero-stable below 1.53; Hairer, Norsett & Wanner, Solving ODEs I, III.5). The first
/// three steps, and three steps after repeated failures of the iteration, are TR-BDF2 steps.
class Bdf3 : public Scheme {
 public:
  explicit Bdf3(const TimeOptions& options) : Scheme(options), starter_(options) {}
  StepReport advance(coupling::Dynamics& dynamics, TimeState& state, double limit) override;

 private:
  StepReport start(coupling::Dynamics& dynamics, TimeState& state, double limit);
  TrBdf2 starter_;
};

/// Chooses the scheme of each step from the stiffness rho (4.7). With the frozen operator (4.3), measuring rho costs less than one velocity
/// evaluation.
///
/// If the frozen operator would be larger than `Time/largest operator`, every step uses RKC2, which needs no frozen operator. If the velocity is the
/// solution of a linear system but the residual of a stage is computed without a solve (3.14), every step uses TR-BDF2. Otherwise:
///
///   BS3 is used as long as the step that the error allows is stable, dt < 2.3/rho. This includes the first step.
///   If the error allows a longer step, TR-BDF2 is used. Its work per unit of time is measured, in velocity evaluations.
///   If this work exceeds 1.5 times the work of BS3, BS3 is used again. BS3 takes three evaluations per step min(dt, 2.3/rho).
///   TR-BDF2 is tried again when rho has changed by a third or fifty steps have passed.
class Automatic : public Scheme {
 public:
  explicit Automatic(const TimeOptions& options) : Scheme(options), explicit_(options), implicit_(options), stabilised_(options) {}
  StepReport advance(coupling::Dynamics& dynamics, TimeState& state, double limit) override;

 private:
  struct Choice;
  Scheme& chosen(const Choice& choice);
  void measure(coupling::Dynamics& dynamics, TimeState& state, Choice& choice) const;
  void reconsider(const TimeState& state, const StepReport& report, Choice& choice) const;

  Bs3 explicit_;
  TrBdf2 implicit_;
  Rkc2 stabilised_;
};

}  // namespace tanktread::motion
