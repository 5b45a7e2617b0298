#pragma once
// Cost of one velocity evaluation of a scene, measured before a run.

#include "record/files/summary.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Returns lines for the plan with the memory, the kernel evaluations and the seconds of one velocity evaluation of a scene in its initial shape. If
/// an evaluation would take longer than five seconds, returns only its seconds, extrapolated from a coarser mesh in proportion to the square of the
/// number of elements. Returns no lines if the scene has no velocity to evaluate, as in the resistance problem of a body with prescribed motion.
/// Collective.
output::Entries<std::string> evaluation_cost(const Scene& scene);

}  // namespace tanktread
