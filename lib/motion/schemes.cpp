#include "motion/schemes.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "base/errors.hpp"
#include "base/formatted.hpp"

namespace tanktread::motion {

double step_factor(double error, double previous, int power) {
  const double e = std::max(error, 1e-3), old = previous > 0 ? std::max(previous, 1e-3) : e;
  return std::clamp(0.9 * std::pow(1 / e, 0.7 / power) * std::pow(old / e, 0.4 / power), 0.3, 2.0);
}

double step_share(double tolerance, int order) { return std::min(1.0, std::pow(tolerance / 1e-3, 1.0 / order)); }

double Attempts::next(double longest) {
  proposed_ = std::min(proposed_, longest);
  if (!options_.fixed_step && !(proposed_ >= options_.least_step()) && !(state_.time + proposed_ >= limit_))
    throw RunFailure(formatted("the step fell to %g, below Time/minimum step %g", proposed_, options_.least_step()));
  return size_ = step_towards(state_.time, limit_, proposed_);
}

bool Attempts::accepts(double error, const char* kind) const {
  const bool finite = std::isfinite(error);
  if (!finite && options_.fixed_step)
    throw RunFailure(std::string("the ") + kind + " step of fixed length gave values that are not finite: set a smaller Time/fixed step");
  return finite && (error <= 1 || options_.fixed_step);
}

void Attempts::reject(double part, double error) {
  const bool known = std::isfinite(error) && error > 1;
  if (known && rejected_error_ > error) {
    const double power = std::max(0.5, std::log(rejected_error_ / error) / std::log(rejected_size_ / size_));
    part = std::min(part, std::max(0.1, 0.9 * std::pow(error, -1 / power)));
  }
  rejected_size_ = size_, rejected_error_ = known ? error : 0;
  proposed_ = size_ * part;
  ++report.rejected;
}

StepReport Attempts::accept(const coupling::Dynamics& dynamics, State y, double error, double factor, double share) {
  report.step = size_;
  report.error = error * share * options_.tolerance;
  report.displacement = dynamics.norm(y - state_.x);
  state_.x = std::move(y);
  state_.time = size_ == limit_ - state_.time ? limit_ : state_.time + size_;
  state_.step = std::min(size_ < proposed_ ? std::max(proposed_, size_ * factor) : size_ * factor, options_.maximum_step.value_or(1e300));
  return report;
}

StepReport Bs3::advance(coupling::Dynamics& dynamics, TimeState& state, double limit) {
  begin(dynamics, state);
  for (Attempts attempts(options_, state, limit);;) {
    const double dt = attempts.next();
    const State& k1 = state.history.front();
    const auto slope = [&](double part, const State& x) {
      dynamics.set_time(state.time + part * dt, state.time);
      return dynamics.velocity(x);
    };
    const State k2 = slope(0.5, state.x + dt / 2 * k1);
    const State k3 = slope(0.75, state.x + 3 * dt / 4 * k2);
    State y = state.x + dt * (2. / 9 * k1 + 1. / 3 * k2 + 4. / 9 * k3);
    dynamics.restore_constraints(y);
    const State k4 = slope(1, y);
    attempts.report.iterations += 3;

    const double error = dynamics.norm(dt * (-5. / 72 * k1 + 1. / 12 * k2 + 1. / 9 * k3 - 1. / 8 * k4)) / options_.tolerance;
    const double factor = std::isfinite(error) ? std::clamp(0.9 * std::pow(std::max(error, 1e-6), -1. / 3), 0.3, 2.0) : 0.3;
    if (attempts.accepts(error, "explicit")) {
      state.history = {k4};
      state.slope_error = 0;
      return attempts.accept(dynamics, std::move(y), error, factor);
    }
    attempts.reject(std::min(factor, 0.9), error);
  }
}

double stiffness(coupling::Dynamics& dynamics, const State& x, const State& v, State& direction, int iterations) {
  if (direction.numbers().size() != x.numbers().size()) {  // start from random numbers, so that the direction contains every mode
    std::minstd_rand generator(1);                         // a generator that gives equal numbers with every standard library
    direction = State(x.layout());
    for (double& number : direction.numbers()) number = static_cast<double>(generator()) / std::minstd_rand::max() - 0.5;
  }
  direction = direction / dynamics.norm(direction);
  double rho = 0;
  for (int k = 0; k < iterations; ++k) {
    const State image = dynamics.derivative(x, v, direction);
    rho = dynamics.norm(image);
    if (!(rho > 0) || !std::isfinite(rho)) return rho;
    direction = image / rho;
  }
  return rho;
}

}  // namespace tanktread::motion
