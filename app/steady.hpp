#pragma once
// Steady shapes and their modes, in place of a run in time.

#include "app/simulation.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Does what Spectrum asks for. One row and one snapshot. Exit code and errors as of `simulate`. Collective.
int find_steady(const Scene& scene, const RunRequest& request);

}  // namespace tanktread
