#include "motion/integrator.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/errors.hpp"
#include "motion/schemes.hpp"

namespace tanktread::motion {

namespace {

constexpr double same_time = 1e-12;  // two times count as equal if their relative difference is below this round-off tolerance

std::unique_ptr<Integrator> smooth_integrator(const TimeOptions& options, const std::shared_ptr<Teuchos::ParameterList>& nox) {
  if (options.scheme == "tr-bdf2") return std::make_unique<TrBdf2>(options);
  if (options.scheme == "bs3") return std::make_unique<Bs3>(options);
  if (options.scheme == "crank-nicolson") return std::make_unique<CrankNicolson>(options, nox);
  if (options.scheme == "auto") return std::make_unique<Automatic>(options);
  if (options.scheme == "bdf3") return std::make_unique<Bdf3>(options);
  if (options.scheme == "rkc2") return std::make_unique<Rkc2>(options);
  throw UserError("Time/scheme: '" + options.scheme + "' is not a scheme that this program has");
}

/// Wrapper of a scheme. It ends steps at kinks of the motion (times at which the motion is not smooth in time), and restarts the scheme there.
class PiecewiseSmooth : public Integrator {
 public:
  explicit PiecewiseSmooth(std::unique_ptr<Integrator> scheme) : scheme_(std::move(scheme)) {}

  StepReport advance(coupling::Dynamics& dynamics, TimeState& state, double limit) override {
    const double kink = dynamics.next_kink(state.time * (1 + same_time));
    const double end = kink < limit * (1 - same_time) ? kink : limit;
    cross_kink(dynamics, state);
    return scheme_->advance(dynamics, state, end);
  }

 private:
  std::unique_ptr<Integrator> scheme_;
};

}  // namespace

std::unique_ptr<Integrator> integrator(const TimeOptions& options, const std::shared_ptr<Teuchos::ParameterList>& nox) {
  return std::make_unique<PiecewiseSmooth>(smooth_integrator(options, nox));
}

bool cross_kink(coupling::Dynamics& dynamics, TimeState& state) {
  if (dynamics.next_kink(state.time * (1 - same_time)) > state.time * (1 + same_time)) return false;
  TimeState after = state;
  forget(after);
  after.history.clear();
  begin(dynamics, after);
  state = std::move(after);
  return true;
}

void begin(coupling::Dynamics& dynamics, TimeState& state) {
  if (!state.history.empty()) return;
  dynamics.set_time(state.time, state.time);
  state.history = {dynamics.velocity(state.x)};
  state.slope_error = 0;
}

void freeze(coupling::Dynamics& dynamics, TimeState& state, double time) {
  state.frozen = state.x, state.frozen_time = state.time;
  refreeze(dynamics, state, time);
}

void refreeze(coupling::Dynamics& dynamics, const TimeState& state, double time) {
  if (state.frozen.empty()) return;
  const bool moves = dynamics.lattice_moves();
  if (moves) dynamics.set_time(state.frozen_time, state.frozen_time);
  dynamics.freeze(state.frozen);
  if (moves) dynamics.set_time(time, state.time);
}

void forget(TimeState& state) {
  state.history.resize(std::min<std::size_t>(state.history.size(), 1));
  state.places.clear();
  state.direction = {};
  state.memory.clear();
  state.secants = {};
}

void each_vector(TimeState& state, const std::function<void(const std::string& name, State& vector)>& act) {
  const auto each = [&](const char* name, std::vector<State>& all) {
    for (std::size_t k = 0; k < all.size(); ++k) act(name + std::to_string(k), all[k]);
  };
  std::vector<State> pairs = state.secants.pairs();
  act("x", state.x), act("frozen", state.frozen), act("direction", state.direction);
  each("slope_", state.history), each("secant_", pairs);
  for (std::size_t k = 0; k < state.places.size(); ++k) act("place_" + std::to_string(k), state.places[k].x);
  state.secants = coupling::Secants(std::move(pairs));
}

double first_step(coupling::Dynamics& dynamics, const TimeState& state, const TimeOptions& options) {
  if (options.fixed_step) return *options.fixed_step;
  const State& slope = state.history.front();
  const double speed = dynamics.norm(slope);
  if (speed == 0) return std::min(1e-3 * options.final_time, options.maximum_step.value_or(1e300));
  const double longest = std::min(options.final_time, options.maximum_step.value_or(1e300));
  const double trial = std::min(1e-3 / speed, longest);  // `longest` limits it if `speed` is only round-off, as for a steady shape
  dynamics.set_time(state.time + trial, state.time);
  const double change = dynamics.norm(dynamics.velocity(state.x + trial * slope) - slope) / trial;
  const double step = std::cbrt(0.1 * options.tolerance / (speed * std::max(speed * speed, change)));  // std::max ignores `change` if NaN
  return std::min(std::max(step, options.least_step()), longest);
}

double step_towards(double time, double limit, double step) {
  const double rest = limit - time;
  if (step >= rest * (1 - 1e-9)) return rest;
  return step > 0.5 * rest ? 0.5 * rest : step;
}

DenseOutput::DenseOutput(const TimeState& before, const TimeState& after)
    : start_(before.time), step_(after.time - before.time), x0_(before.x), x1_(after.x), v0_(before.history.front()), v1_(after.history.front()) {}

State DenseOutput::state(double time) const {
  const double s = (time - start_) / step_, r = 1 - s;
  return r * r * (1 + 2 * s) * x0_ + s * s * (1 + 2 * r) * x1_ + step_ * s * r * (r * v0_ - s * v1_);
}

State DenseOutput::slope(double time) const {
  const double s = (time - start_) / step_, r = 1 - s;
  return 6 * s * r / step_ * (x1_ - x0_) + r * (r - 2 * s) * v0_ + s * (s - 2 * r) * v1_;
}

}  // namespace tanktread::motion
