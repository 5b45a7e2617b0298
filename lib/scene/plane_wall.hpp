#pragma once
// Gaps between particles and the plane walls of a scene.

#include <limits>
#include <span>
#include <vector>

#include "base/columns.hpp"
#include "scene/member.hpp"

namespace tanktread {

/// Throws NoRoom, with the distances, if the body does not start in front of the scene's wall with a gap of at least `Wall/contact gap`.
void check_in_front(const ParticleScene& particle_scene, const Body& body);

/// Data of the plane walls for one row of the results: the smallest gap, the nearest particle (numbered from 1 in the order of the deck), and its
/// point nearest to the wall.
struct WallRow {
  double gap = std::numeric_limits<double>::infinity();
  int particle = 0;
  Vec3 place = Vec3::Zero();
  void add_columns(const Scene& scene, Columns& to) const;
};

/// Returns the smallest gap to the walls and its position, for the shapes x of all particles or of one body.
WallRow wall_row(std::span<const stokes::PlaneWall> walls, const std::vector<Member>& members, const Net& x);
WallRow wall_row(std::span<const stokes::PlaneWall> walls, const Body& body, const Net& x);

}  // namespace tanktread
