#pragma once
// Particles beside the plane wall of a scene.

#include <string>
#include <vector>

#include "app/member.hpp"
#include "app/series.hpp"

namespace tanktread {

/// Throws UserError, with the numbers, where the body does not start in front of the scene's wall, `Wall/contact gap` at least away from it.
void check_in_front(const Scene& scene, const Body& body);

/// What the series beside a wall are taken from: the particles at x, or one alone.
void add_wall(const stokes::PlaneWall& wall, const std::vector<Member>& members, const Net& x, Moment& now);
void add_wall(const stokes::PlaneWall& wall, const Body& body, const Net& x, Moment& now);

}  // namespace tanktread
