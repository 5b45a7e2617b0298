#pragma once
// The steady problem of a rigid body that moves as the deck says.

#include "app/body.hpp"
#include "app/scene.hpp"
#include "app/simulation.hpp"

namespace tanktread {

/// Solves for the traction on the body, records one row and one picture. Exit code as of `simulate`. Collective.
int resist(const Scene& scene, const RunRequest& request);

/// The plan of a rigid particle, prescribed or free.
output::Entries<std::string> rigid_plan(const Scene& scene, const Body& body, int ranks);

}  // namespace tanktread
