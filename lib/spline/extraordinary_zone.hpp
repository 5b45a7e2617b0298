#pragma once
// The uniform rings around an extraordinary point.

#include "spline/extended_mesh.hpp"

namespace tanktread::spline {

/// Extraordinary points (numbers) whose zone a path breaks: within `rings` h of the point, measured in the faces at it by the larger coordinate,
/// the mesh must be the uniform h lattice, and the path has a unit edge off that lattice there. Three rings are what nestedness needs.
std::vector<int> broken_zones(const TMesh& mesh, const std::vector<Ray>& path, int rings);

/// Mid lines of the twelve elements of the two rings at an extraordinary point; with them the zone is whole again for h / 2.
std::vector<std::vector<Ray>> two_ring_cuts(const TMesh& mesh, int point);

/// Halves h of every point whose zone one of the paths breaks, and goes on with the lines that this adds until all zones are whole.
/// Returns the number of halvings.
int restore_zones(ExtendedMesh& extended, std::vector<std::vector<Ray>> paths, int rings);

}  // namespace tanktread::spline
