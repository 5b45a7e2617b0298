#pragma once
// Steady shapes that a search from the initial shape does not find: shorter steps, and weaker flows.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "motion/steady.hpp"

namespace tanktread::motion {

/// Result of approach_steady: whether shorter steps led to the steady shape, or for which weaker flows one was found on the way to the full flow.
struct Approach {
  std::vector<double> amplitudes;  ///< flow amplitudes at which a steady shape was found, ascending; 1 is the amplitude of the scene
  bool by_shorter_steps = false;   ///< true if the shape was found at the full flow with a tenth of Steady/step
  SteadyReport last;               ///< report of the last search, which was either at the full flow (amplitude 1) or failed; without the iterations
                                   ///< of earlier searches

  bool arrived() const { return !amplitudes.empty() && amplitudes.back() == 1; }
  std::string text() const;  ///< returns a sentence about what led to the steady shape, or how far the search came
};

/// Finds a steady shape that a search from x does not find. First searches with a tenth of Steady/step, because long steps excite short waves on
/// compressed membranes. If this fails, continues steady shapes in the amplitude a of the flow (natural continuation), from a first a <= 1/2 at
/// which the search from x succeeds, to a = 1. Each search starts at the linear extrapolation of the two latest shapes. The step of a is increased
/// after a search with few iterations, and halved after a failed search. The continuation ends if the step falls to 1/512. The tolerance of these
/// searches is at least 1e-6. At a = 1, up to three further searches must reach Steady/tolerance; otherwise the continuation ends. Sets x to the
/// shape at the last amplitude for which a search succeeded, and `last.why` to the obstacle there. `family`: function that returns the equations at
/// an amplitude. Collective.
Approach approach_steady(const std::function<std::shared_ptr<SteadyEquations>(double amplitude)>& family, const SteadyOptions& options,
                         const coupling::SolverOptions& solvers, State& x);

}  // namespace tanktread::motion
