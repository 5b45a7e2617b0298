#pragma once
// Publications that a user should cite, by the features that a scene uses.

#include <string>

#include "scene/scene.hpp"

namespace tanktread {

/// Returns the text of `tanktread --cite`: the program in this version, and one line for each publication with the feature that it belongs to.
/// `scene`: a checked scene; null for the publications of all features.
std::string citations(const Scene* scene, const std::string& version);

}  // namespace tanktread
