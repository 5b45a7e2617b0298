#include "motion/approach.hpp"

#include <algorithm>
#include <utility>

#include "base/formatted.hpp"

namespace tanktread::motion {

std::string Approach::text() const {
  if (by_shorter_steps) return "no steady shape was found from the initial shape with Steady/step; one was found with a tenth of this step";
  if (amplitudes.empty()) return "no steady shape was found: not from the initial shape, not with shorter steps, and not in weaker flows";
  std::string all;
  for (const double amplitude : amplitudes) all += (all.empty() ? "" : ", ") + formatted("%.4g", amplitude);
  return "no steady shape was found from the initial shape; steady shapes of the flow times " + all +
         (arrived() ? " led to it" : " were found, but none of the full flow");
}

Approach approach_steady(const std::function<std::shared_ptr<SteadyEquations>(double amplitude)>& family, const SteadyOptions& options,
                         const coupling::SolverOptions& solvers, State& x) {
  // The full flow is reached by continuation in its amplitude, from 0 to 1. At each amplitude, a steady shape is searched for.
  // least_step: smallest step of the amplitude. coarse: tolerance of each search, unless Steady/tolerance is larger. far: largest distance between
  // the first and the last shape of a search, divided by the particle radius. few: a search with fewer iterations makes the next step of the
  // amplitude longer. most_searches: largest number of searches. most_polishes: largest number of repeated searches in the full flow with
  // Steady/tolerance; each starts at the shape found by the previous search, with a new Jacobian. most_short_searches: number of searches in the
  // full flow, with a tenth of Steady/step, that are tried before the continuation. in_vain: see find_steady(); the last of these searches does not
  // end early, because it can converge after many iterations without a better iterate.
  constexpr double least_step = 1. / 512, coarse = 1e-6, far = 0.5;
  constexpr int few = 25, most_searches = 60, most_polishes = 3, most_short_searches = 2, in_vain = 20;
  Approach way;
  const std::shared_ptr<SteadyEquations> full = family(1);
  SteadyEquations shorter = full->with_step(0.1 * full->step());
  State found = x;
  for (int k = 0; k < most_short_searches && !way.last.converged; ++k)
    way.last = find_steady(shorter, options, solvers, found, k + 1 < most_short_searches ? in_vain : options.iterations);
  if (way.last.converged && full->dynamics().norm(full->residual(found)) < largest_motion) {
    x = std::move(found);
    way.amplitudes = {1}, way.by_shorter_steps = true;
    return way;
  }
  bool exhausted = false;  // true if the full flow was solved to the coarse tolerance but not to Steady/tolerance
  const auto found_at = [&](double amplitude, State& y) {
    SteadyOptions here = options;
    here.tolerance = std::max(options.tolerance, coarse);
    const State from = y;
    const std::shared_ptr<SteadyEquations> equations = family(amplitude);
    way.last = find_steady(*equations, here, solvers, y);
    if (!way.last.converged || !(equations->dynamics().norm(y - from) < far)) return false;
    if (amplitude < 1) return true;
    for (int k = 0; k < most_polishes && !(way.last.converged && way.last.rest <= options.tolerance); ++k)
      way.last = find_steady(*equations, options, solvers, y);
    exhausted = !way.last.converged;
    return !exhausted;
  };
  double amplitude = 0, step = 0.5;
  State before;  // shape at the previous amplitude
  for (int k = 0; k < most_searches && amplitude < 1 && step > least_step && !exhausted; ++k) {
    const double next = std::min(1., amplitude + step);
    State y = x;
    if (way.amplitudes.size() > 1) {
      const double last = way.amplitudes[way.amplitudes.size() - 2];
      y += (next - amplitude) / (amplitude - last) * (x - before);
    }
    if (!found_at(next, y)) {
      step *= 0.5;
      continue;
    }
    if (way.amplitudes.empty()) step *= 0.5;
    else if (way.last.iterations < few) step *= 1.5;
    before = std::exchange(x, std::move(y));
    amplitude = next;
    way.amplitudes.push_back(next);
  }
  way.last.why = full->obstacle(x);
  return way;
}

}  // namespace tanktread::motion
