#pragma once
// The numbers of a deck along which a branch of steady shapes is followed.

#include <array>
#include <string>

#include "scene/scene.hpp"

namespace tanktread {

/// The value of Continuation/parameter, and that of the second parameter, 0 where there is none.
using Parameters = std::array<double, 2>;

/// The scene with other values of the parameters of its branch. `deck`: the effective one.
Scene at_parameters(const Scene& scene, const std::string& deck, const Parameters& values);

/// With which the branch begins. Throws UserError where a parameter is no number of the deck.
Parameters first_parameters(const Scene& scene, const std::string& deck);

}  // namespace tanktread
