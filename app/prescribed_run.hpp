#pragma once
// The run of a rigid body that moves as the deck says.

#include "record/results.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Solves for the traction on the body, records one row and one picture. Exit code as of `simulate`. Collective.
int resist(const Scene& scene, const RunRequest& request);

}  // namespace tanktread
