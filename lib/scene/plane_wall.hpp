#pragma once
// Gaps between particles and the plane wall of a scene.

#include <limits>
#include <vector>

#include "base/columns.hpp"
#include "scene/member.hpp"

namespace tanktread {

/// Throws UserError, with the distances, if the body does not start in front of the scene's wall with a gap of at least `Wall/contact gap`.
void check_in_front(const Scene& scene, const Body& body);

/// Data of the plane wall for one row: the gap, the nearest particle (numbered from 1 in the order of the deck), and its point nearest to the wall.
struct WallRow {
  double gap = std::numeric_limits<double>::infinity();
  int particle = 0;
  Vec3 place = Vec3::Zero();
  void add_columns(const Scene& scene, Columns& to) const;
};

/// Returns the data of the plane wall for the shapes x of all particles, or for the shape of one body.
WallRow wall_row(const stokes::PlaneWall& wall, const std::vector<Member>& members, const Net& x);
WallRow wall_row(const stokes::PlaneWall& wall, const Body& body, const Net& x);

}  // namespace tanktread
