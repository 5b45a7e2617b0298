#pragma once
// Maps of a lattice onto itself: the symmetries that a T-mesh may have.

#include <optional>
#include <span>

#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// A map of the vertices onto themselves that keeps neighbours: slot k at v goes to slot turn[v] + k at vertex[v], or to turn[v] - k when the map is
/// mirrored (counted modulo the valence).
struct LatticeMap {
  std::vector<int> vertex;
  std::vector<std::uint8_t> turn;
  bool mirrored = false;
};

Ray image(const Lattice& lattice, const LatticeMap& map, Ray ray);

/// Each ray of a path.
std::vector<Ray> image(const Lattice& lattice, const LatticeMap& map, const std::vector<Ray>& path);

/// The element of a tiling that the map takes another one to, and whether s and t change places. The tiling has to have the symmetry.
struct TileImage {
  int tile;
  bool exchanged;
};
TileImage image(const Lattice& lattice, const LatticeMap& map, const Tiling& tiling, int tile);

/// The only map that takes one ray to another, mirrored or not; none where the lattice has no such symmetry.
std::optional<LatticeMap> lattice_map(const Lattice& lattice, Ray from, Ray to, bool mirrored);

/// The map that takes the T-mesh elements under Bezier element e to that under element[e], for all of them; none where there is none.
std::optional<LatticeMap> lattice_map(const TMesh& mesh, const Space& space, std::span<const int> element, bool mirrored);

}  // namespace tanktread::spline
