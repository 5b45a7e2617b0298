#pragma once
// The schemes of `Time/scheme`, and what the steps of all of them have in common.

#include <array>
#include <cstring>
#include <vector>

#include "motion/integrator.hpp"
#include "system/solvers/nonlinear.hpp"

namespace tanktread::motion {

/// A struct of doubles as the front of State::memory keeps it; as it is made where that is shorter.
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

/// Factor for the next step of a PI controller: the error over the tolerance, that of the accepted step before (0: none), and the power of the
/// step that the error goes with. Between 0.3 and 2. Gustafsson 1991.
double step_factor(double error, double previous, int power);

/// Returns the share of the tolerance by which a step may err, for a scheme of this order whose error estimate is of the order of its own result. The
/// error of a run is the sum of those of its steps, whose number grows like tolerance^(-1/(order + 1)); with this share the sum stays proportional to
/// the tolerance (Soderlind & Wang 2006):
///
///   min(1, (tolerance/1e-3)^(1/order))                                                                                            (4.31)
double step_share(double tolerance, int order);

/// The attempts at one step towards `limit`: their sizes, and what is reported of them.
class Attempts {
 public:
  Attempts(const TimeOptions& options, State& state, double limit)
      : options_(options), state_(state), limit_(limit), proposed_(options.fixed_step.value_or(state.step)) {}

  /// The size of the next attempt, `longest` at most. Throws RunFailure when the controller asks for a step below `Time/minimum step`, unless only
  /// a sliver before the limit is left.
  double next(double longest = 1e300);

  /// Whether an attempt of this error over the tolerance is a step. Throws RunFailure where the error of a fixed step, of this `kind`, is not finite.
  bool holds(double error, const char* kind) const;

  /// Gives the attempt up, which erred by `error` over the tolerance (0: not known). The next one is `part` of it. Where two attempts were given up,
  /// their errors tell the power of the step that the error goes with, and the next one is no longer than this power says, but a tenth at least: what
  /// a refined mesh relaxes goes with less than the first power, and not by a power below a half. Gustafsson 1994.
  void reject(double part, double error = 0);

  /// Ends the step at y: place, time and next step of the state, `factor` times this one, and the report. A step cut short to meet the limit says
  /// nothing against the longer one. The scheme's history and memory are its own.
  /// `error`: over the tolerance times `share` (4.31).
  StepReport accept(const coupling::Dynamics& dynamics, Net y, double error, double factor, double share = 1);

  StepReport report;  ///< the scheme counts `iterations`

 private:
  const TimeOptions& options_;
  State& state_;
  double limit_, proposed_, size_ = 0;
  double rejected_size_ = 0, rejected_error_ = 0;  // of the attempt before
};

class Scheme : public Integrator {
 public:
  explicit Scheme(const TimeOptions& options) : options_(options) {}

 protected:
  TimeOptions options_;
};

/// Bogacki & Shampine 1989, explicit, third order with an embedded second: three velocity evaluations a step, the last slope is the
/// first one of the next. Stable for dt rho <= 2.51 with rho the stiffness (4.5).
class Bs3 : public Scheme {
 public:
  using Scheme::Scheme;
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;
};

/// Runge-Kutta-Chebyshev of second order (Sommeijer, Shampine & Verwer 1998), explicit and stabilised: as many stages as the step needs,
///
///   s = 1 + sqrt(1 + 1.54 dt rho),   stable for dt rho <= 0.653 (s^2 - 1)                                                  (4.8)
///
/// so the work of a long step grows with the root of the stiffness (4.7) only. Nothing is assembled and no system is solved. The stiffness
/// is measured by differences of velocities, at the start, every 25 steps, and after an attempt that failed.
class Rkc2 : public Scheme {
 public:
  using Scheme::Scheme;
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;
};

/// Stages that a step dt of RKC2 needs at the stiffness rho (4.8).
int rkc2_stages(double dt, double rho);

/// The stiffness rho of the system at x, where the velocity is v: the spectral radius of J by power iteration (4.7). It approaches rho from
/// below: from a random direction eight iterations find 0.9 of it or more, two from the direction of an earlier call as much.
/// `direction` is where the iteration starts and ends, of norm 1; of another size than x: it starts at random, the same on every run.
/// An iteration costs one product with the frozen operator, or one velocity evaluation where nothing is assembled.
double stiffness(coupling::Dynamics& dynamics, const Net& x, const Net& v, Net& direction, int iterations);

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
class CrankNicolson : public Scheme {
 public:
  CrankNicolson(const TimeOptions& options, const std::shared_ptr<Teuchos::ParameterList>& nox);
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;

 private:
  struct Iteration {
    Net y;
    int count = 0;
    bool converged = false;
  };
  Iteration iterate(coupling::Dynamics& dynamics, const State& state, double dt, const Net& start) const;

  bool by_error_;
  std::unique_ptr<coupling::FixedPoint> solver_;  // none: plain
};

/// TR-BDF2 (Hosea & Shampine 1996) with local extrapolation: one step, third order, L-stable for the exact Jacobian.
///
///   d = 1 - 1/sqrt(2), w = sqrt(2)/4; stages at 0, 2d, 1; b = (w, w, d); embedded b^ = ((1 - w)/3, (3w + 1)/3, d/3)               (4.4)
///   e1 = (I - d dt J)^-1 dt sum (b_i - b^_i) k_i,   e2 = (I - d dt J)^-1 e1,   x_(n+1) = x_n + dt sum b_i k_i - e2                 (4.30)
///
/// b^ is of third order but not stable; e2 is its difference to b without the stiff part. With z = dt J the step multiplies a mode by
/// R(z) + (R^ - R)/(1 - d z)^2, at most 1 in the left half plane and 0 at infinity. The frozen Jacobian (4.3) changes the error of fourth order only,
/// so its secants are left out of e1 and e2. The local error is a quarter of |e1|, which bounds the error of the extrapolated result, plus the errors
/// of the two stages (4.28).
///
/// The first slope is the last one of the previous step. Slopes follow from the stage equations and are not evaluated again. Stages start from a
/// polynomial through the known slopes.
class TrBdf2 : public Scheme {
 public:
  using Scheme::Scheme;
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;
};

/// Third-order backward differentiation with variable steps and the quasi-Newton solve on the frozen-geometry Jacobian (4.3): the derivative
/// at t_{n+1} of the cubic through x_{n+1}, x_n, x_{n-1}, x_{n-2} is v(x_{n+1}),
///
///   x_{n+1} - shift v(x_{n+1}) = -shift (a_0 x_n + a_1 x_{n-1} + a_2 x_{n-2}),   1/shift = sum 1/(t_{n+1} - t_{n-i})              (4.9)
///
/// One stage per step, started from the cubic through the last four positions; the difference to it, times shift/(t_{n+1} - t_{n-3}), is the local
/// error, of which a step may have its share (4.31). Steps grow by no more than 1.5 at a time (zero-stable below 1.53; Hairer, Norsett & Wanner,
/// Solving ODEs I, III.5). The first three steps, and the ones after an iteration that failed repeatedly, are TR-BDF2's.
class Bdf3 : public Scheme {
 public:
  explicit Bdf3(const TimeOptions& options) : Scheme(options), starter_(options) {}
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;

 private:
  StepReport start(coupling::Dynamics& dynamics, State& state, double limit);
  TrBdf2 starter_;
};

/// Chooses the scheme from the measured stiffness rho (4.7), which the frozen operator gives for less than an evaluation:
///
///   TR-BDF2 if a velocity, which explicit schemes need, takes a linear system that the defect of a stage does not (3.14); otherwise
///   BS3 as long as the step that the error allows, the first one too, is stable, dt < 2.3/rho; else TR-BDF2, whose work per unit of time is counted;
///   back to BS3 when that is above 1.5 times 3/min(dt, 2.3/rho), and once more to TR-BDF2 when rho has changed or fifty steps have passed.
///
/// Where the frozen operator would be larger than `Time/largest operator`, RKC2, which needs none.
class Automatic : public Scheme {
 public:
  explicit Automatic(const TimeOptions& options) : Scheme(options), explicit_(options), implicit_(options), stabilised_(options) {}
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;

 private:
  struct Choice;
  Scheme& chosen(const Choice& choice);
  void measure(coupling::Dynamics& dynamics, State& state, Choice& choice) const;
  void reconsider(const State& state, const StepReport& report, Choice& choice) const;

  Bs3 explicit_;
  TrBdf2 implicit_;
  Rkc2 stabilised_;
};

}  // namespace tanktread::motion
