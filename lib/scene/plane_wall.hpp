#pragma once
// Particles beside the plane wall of a scene.

#include <limits>
#include <string>
#include <vector>

#include "base/columns.hpp"
#include "scene/member.hpp"

namespace tanktread {

/// Throws UserError, with the numbers, where the body does not start in front of the scene's wall, `Wall/contact gap` at least away from it.
void check_in_front(const Scene& scene, const Body& body);

/// Data of the plane wall for one row: the nearest particle, by its number from 1 in the order of the deck, and the point of it that is nearest.
struct WallRow {
  double gap = std::numeric_limits<double>::infinity();
  int particle = 0;
  Vec3 place = Vec3::Zero();
  void add_columns(const Scene& scene, Columns& to) const;
};

/// Returns the row's part for the particles at x, or for one body.
WallRow wall_row(const stokes::PlaneWall& wall, const std::vector<Member>& members, const Net& x);
WallRow wall_row(const stokes::PlaneWall& wall, const Body& body, const Net& x);

}  // namespace tanktread
