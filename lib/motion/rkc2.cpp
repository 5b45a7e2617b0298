#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/schemes.hpp"

namespace tanktread::motion {

namespace {

constexpr double margin = 1.1;    // safety factor on the stiffness rho, because power iteration gives a lower bound of it
constexpr int lasting_steps = 25;  // number of steps for which a measured stiffness is used
constexpr int most_stages = 200;

/// Content of TimeState::memory.
struct StiffnessMemory {
  double stiffness = 0;  ///< measured stiffness
  double age = 0;        ///< number of steps since the stiffness was measured
  double error = 0;      ///< error of the last accepted step divided by the tolerance
  double size = 0;       ///< number of numbers of a state when the stiffness was measured
};

/// Values T_j(w), T_j'(w) and T_j''(w) of the Chebyshev polynomials of degree j = 0 … s at the point w.
struct Chebyshev {
  std::vector<double> t, d, dd;
  Chebyshev(int s, double w) : t{1, w}, d{0, 1}, dd{0, 0} {
    for (int j = 2; j <= s; ++j) {
      t.push_back(2 * w * t[j - 1] - t[j - 2]);
      d.push_back(2 * t[j - 1] + 2 * w * d[j - 1] - d[j - 2]);
      dd.push_back(4 * d[j - 1] + 2 * w * dd[j - 1] - dd[j - 2]);
    }
  }
};

/// Computes one RKC2 step of s stages (4.8) from x with slope v at the time `start` to start + dt. Evaluates s - 1 velocities, at the times start +
/// c_j dt of the stages j.
State step(coupling::Dynamics& dynamics, const State& x, const State& v, double start, double dt, int s) {
  const double w0 = 1 + 2. / 13 / (s * s);  // damping parameter 2/13
  const Chebyshev c(s, w0);
  const double w1 = c.d[s] / c.dd[s];
  std::vector<double> b(s + 1);
  for (int j = 2; j <= s; ++j) b[j] = c.dd[j] / (c.d[j] * c.d[j]);
  b[0] = b[1] = b[2];

  State before = x, y = x + b[1] * w1 * dt * v;
  double c_before = 0, c_y = b[1] * w1;
  for (int j = 2; j <= s; ++j) {
    const double mu = 2 * b[j] * w0 / b[j - 1], nu = -b[j] / b[j - 2], weight = 2 * b[j] * w1 / b[j - 1];
    const double first = -(1 - b[j - 1] * c.t[j - 1]) * weight;
    dynamics.set_time(start + c_y * dt, start);
    State next = (1 - mu - nu) * x + mu * y + nu * before + dt * (weight * dynamics.velocity(y) + first * v);
    before = std::move(y);
    y = std::move(next);
    c_before = std::exchange(c_y, mu * c_y + nu * c_before + weight + first);
  }
  return y;
}

}  // namespace

int rkc2_stages(double dt, double rho) { return std::max(2, 1 + static_cast<int>(std::sqrt(1 + 1.54 * dt * rho))); }

StepReport Rkc2::advance(coupling::Dynamics& dynamics, TimeState& state, double limit) {
  begin(dynamics, state);
  StiffnessMemory memory = remembered<StiffnessMemory>(state.memory);
  Attempts attempts(options_, state, limit);
  const auto measure = [&] { attempts.report.iterations += measure_stiffness(dynamics, state, memory); };
  if (memory.age >= lasting_steps || memory.size != static_cast<double>(state.x.numbers().size())) measure();

  for (;;) {
    const double rho = margin * memory.stiffness;
    const double dt = attempts.next(rho > 0 ? (most_stages * most_stages - 1) / (1.54 * rho) : 1e300);
    const State& v = state.history.front();
    const int stages = rkc2_stages(dt, rho);
    State y = step(dynamics, state.x, v, state.time, dt, stages);
    dynamics.restore_constraints(y);
    dynamics.set_time(state.time + dt, state.time);
    const State slope = dynamics.velocity(y);
    attempts.report.iterations += stages;

    const double error = dynamics.norm(0.8 * (state.x - y) + 0.4 * dt * (v + slope)) / (options_.tolerance * step_share(options_.tolerance, 2));
    const bool accepted = attempts.accepts(error, "stabilised");
    const double factor = std::isfinite(error) ? step_factor(error, accepted ? memory.error : 0, 3) : 0.3;
    if (accepted) {
      memory.age += 1;
      memory.error = error;
      state.memory = values_of(memory);
      state.history = {slope};
      state.slope_error = 0;
      return attempts.accept(dynamics, std::move(y), error, factor, step_share(options_.tolerance, 2));
    }
    attempts.reject(std::min(factor, 0.8), error);
    if (memory.age > 0) measure();
  }
}

}  // namespace tanktread::motion
