#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "motion/quasi_newton.hpp"

namespace tanktread::motion {

namespace {
const double d = 1 - 1 / std::sqrt(2.0);
const double w = std::sqrt(2.0) / 4;
constexpr double worth_an_order = 0.7;  // a higher order of prediction is chosen only if its error is below this factor times the best error so far
// the error estimate contains |e1|/accuracy, because |e1| (4.4) is the error of the second-order result, and the result (4.30) is more accurate
constexpr double accuracy = 4;

/// Orders of extrapolation that would have given the best predictions of the slopes of the second and the third stage of a step.
struct Orders {
  double second = 1, third = 1;
};

/// Content of TimeState::memory. `step` is the first member, because Bdf3 reads it from the front of the memory.
struct Remembered {
  Memory step;
  Orders orders;
};

/// Extrapolates the slope dx/dt in time by a polynomial through the latest slopes. Times are relative to the start of the step.
class Prediction {
 public:
  Prediction(const TimeState& state, const Memory& memory, std::size_t most) : times_{0, (2 * d - 1) * memory.step, -memory.step}, most_(most) {
    for (const State& slope : state.history) slopes_.push_back(&slope);
  }

  void add(double time, const State& slope) { times_.insert(times_.begin(), time), slopes_.insert(slopes_.begin(), &slope); }

  State at(double time, double order) const {
    const std::size_t n = std::min({slopes_.size(), most_ + 1, static_cast<std::size_t>(order) + 1});
    return interpolated(times_, std::span(slopes_).first(n), time);
  }

  /// Returns the order of extrapolation that would have given the best prediction of this slope.
  double best_order(const coupling::Dynamics& dynamics, double time, const State& slope) const {
    double least = std::numeric_limits<double>::infinity(), best = 0;
    for (std::size_t order = 0; order < slopes_.size(); ++order)
      if (const double miss = dynamics.norm(at(time, static_cast<double>(order)) - slope); miss < worth_an_order * least)
        least = miss, best = static_cast<double>(order);
    return best;
  }

 private:
  std::vector<double> times_;
  std::vector<const State*> slopes_;
  std::size_t most_;
};

}  // namespace

StepReport TrBdf2::advance(coupling::Dynamics& dynamics, TimeState& state, double limit) {
  begin(dynamics, state);
  if (state.frozen.empty()) freeze(dynamics, state, state.time);
  const auto [memory, known] = remembered<Remembered>(state.memory);
  coupling::Secants secants = state.secants;
  Attempts attempts(options_, state, limit);

  for (;;) {
    const double dt = attempts.next(), shift = d * dt;
    const State& k1 = state.history.front();
    Prediction prediction(state, memory, static_cast<std::size_t>(options_.predictor_order));
    Orders orders;

    Stage second, third;
    third.time = state.time + dt;
    const State rhs2 = state.x + shift * k1;
    second.y = rhs2 + shift * prediction.at(2 * d * dt, known.second);
    dynamics.improve_start(second.y, state.x, shift);
    dynamics.set_time(state.time + 2 * d * dt, state.time);
    solve(dynamics, options_, rhs2, shift, secants, second);
    const State& k2 = second.slope;
    if (second.solved) {
      orders.second = prediction.best_order(dynamics, 2 * d * dt, k2);
      prediction.add(2 * d * dt, k2);
      const State rhs3 = state.x + dt * w * (k1 + k2);
      third.rate = second.rate;
      third.y = rhs3 + shift * prediction.at(dt, known.third);
      dynamics.improve_start(third.y, second.y, shift);
      dynamics.set_time(third.time, state.time);
      solve(dynamics, options_, rhs3, shift, secants, third);
    }
    attempts.report.iterations += second.iterations + third.iterations;
    double error = 0, slope_error = 0;
    if (third.solved) {
      orders.third = prediction.best_order(dynamics, dt, third.slope);
      const State raw = dt * ((4 * w - 1) / 3 * k1 - k2 / 3 + 2 * d / 3 * third.slope);
      const State once = dynamics.solve(shift, raw, options_.linear_tolerance, {});
      const State twice = dynamics.solve(shift, once, options_.linear_tolerance, {});
      error = (dynamics.norm(once) / accuracy + second.error + third.error) / options_.tolerance;
      third.y -= twice;
      third.slope -= (twice - once) / shift;
      slope_error = (third.error + third.rate_or_assumed() * dynamics.norm(twice)) / shift;
    }
    const auto [accepted, factor] = judge(dynamics, options_, state, secants, third, error, 3, memory);
    if (accepted) {
      state.history = {third.slope, k2, k1};
      state.secants = std::move(secants);
      state.memory = values_of(Remembered{{error, dt}, orders});
      state.slope_error = slope_error;
      return attempts.accept(dynamics, std::move(third.y), error, factor);
    }
    attempts.reject(std::min(factor, 0.8), error);
  }
}

}  // namespace tanktread::motion
