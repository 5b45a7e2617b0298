#include <algorithm>
#include <cmath>

#include "motion/schemes.hpp"

namespace tanktread::motion {

namespace {

// largest step dt times stiffness rho for BS3; less than the stability limit 2.51, because the measured rho is a lower bound
constexpr double stable = 2.3;
// assumed work of a linear solve, in velocity evaluations; measured: 0.4 to 1.5, on meshes of 218 and 866 control points
constexpr double solve_share = 0.5;
constexpr double memory_of_work = 0.8;
constexpr int measured_every = 10, trial = 10, tried_again_after = 50;  // steps

constexpr double bs3 = 0, tr_bdf2 = 1, rkc2 = 2;  // values of Choice::scheme

}  // namespace

/// Memory of the automatic choice of schemes, at the front of TimeState::memory. The memory of the chosen scheme follows.
struct Automatic::Choice {
  double scheme = bs3;
  double stiffness = 0;
  double age = 0;         ///< steps since the stiffness was measured
  double size = 0;        ///< number of numbers of a state when the stiffness was measured; 0: not measured yet
  double work = 0;        ///< work of TR-BDF2 per unit of time, in velocity evaluations; 0: TR-BDF2 was not tried yet
  double since = 0;       ///< steps since the last change of scheme
  double then = 0;        ///< stiffness when the scheme was last changed
};

Scheme& Automatic::chosen(const Choice& choice) {
  if (choice.scheme == rkc2) return stabilised_;
  return choice.scheme == tr_bdf2 ? static_cast<Scheme&>(implicit_) : explicit_;
}

void Automatic::measure(coupling::Dynamics& dynamics, TimeState& state, Choice& choice) const {
  if (choice.size == static_cast<double>(state.x.numbers().size()) && choice.age < measured_every) return;
  if (state.frozen.empty()) freeze(dynamics, state, state.time);
  measure_stiffness(dynamics, state, choice);
}

/// Updates the choice of the scheme after an accepted step.
void Automatic::reconsider(const TimeState& state, const StepReport& report, Choice& choice) const {
  choice.age += 1;
  choice.since += 1;
  const double longest = stable / std::max(choice.stiffness, 1e-300);
  double next = choice.scheme;
  if (choice.scheme == bs3) {
    const bool bound = options_.fixed_step.value_or(state.step) > longest;
    const bool another = options_.fixed_step || choice.since >= tried_again_after || std::abs(std::log(choice.stiffness / choice.then)) > 0.3;
    if (bound && (choice.work == 0 || another)) next = tr_bdf2;
  } else {
    const double work = (1 + solve_share) * report.iterations / report.step;
    choice.work = choice.work == 0 ? work : memory_of_work * choice.work + (1 - memory_of_work) * work;
    const bool stable_step = !options_.fixed_step || *options_.fixed_step <= longest;
    if (stable_step && choice.since >= trial && choice.work > 1.5 * 3 / std::min(longest, report.step)) next = bs3;
  }
  if (next == choice.scheme) return;
  if (next == tr_bdf2) choice.work = 0;
  choice.scheme = next;
  choice.since = 0;
  choice.then = choice.stiffness;
}

StepReport Automatic::advance(coupling::Dynamics& dynamics, TimeState& state, double limit) {
  begin(dynamics, state);
  Choice choice = remembered<Choice>(state.memory);
  if (dynamics.frozen_bytes() > 1e9 * options_.largest_operator || choice.scheme == rkc2) {
    choice.scheme = rkc2;
  } else if (dynamics.defect_spares_system()) {
    choice.scheme = tr_bdf2;
  } else {
    const bool first = choice.size == 0;
    measure(dynamics, state, choice);
    if (first && choice.scheme == bs3 && state.step * choice.stiffness > stable) {  // the first step would exceed the stability limit of BS3
      choice.scheme = tr_bdf2;
      choice.then = choice.stiffness;
    }
  }

  // The chosen scheme receives only the part of TimeState::memory that belongs to it.
  TimeState inner = state;
  const std::size_t own = std::min(values_of(choice).size(), inner.memory.size());
  inner.memory.erase(inner.memory.begin(), inner.memory.begin() + static_cast<std::ptrdiff_t>(own));
  const double before = choice.scheme;
  if (before == bs3 && choice.stiffness > 0 && !options_.fixed_step) inner.step = std::min(inner.step, stable / choice.stiffness);
  const StepReport report = chosen(choice).advance(dynamics, inner, limit);
  if (choice.scheme != rkc2 && !dynamics.defect_spares_system()) {
    reconsider(inner, report, choice);
    if (choice.scheme != before) {
      inner.history.resize(1);
      inner.memory.clear();
    }
  }
  const std::vector<double> values = values_of(choice);
  inner.memory.insert(inner.memory.begin(), values.begin(), values.end());
  state = std::move(inner);
  return report;
}

}  // namespace tanktread::motion
