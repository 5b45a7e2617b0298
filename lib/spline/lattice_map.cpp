#include "spline/refinement.hpp"

#include "spline/locate.hpp"

namespace tanktread::spline {

Ray image(const Lattice& l, const LatticeMap& map, Ray r) {
  const int n = l.valence(r.vertex), turn = map.turn[r.vertex];
  return {map.vertex[r.vertex], (map.mirrored ? turn - r.slot + n : turn + r.slot) % n};
}

std::vector<Ray> image(const Lattice& l, const LatticeMap& map, const std::vector<Ray>& path) {
  std::vector<Ray> out;
  for (Ray r : path) out.push_back(image(l, map, r));
  return out;
}

TileImage image(const Lattice& l, const LatticeMap& map, const Tiling& tiling, int tile) {
  const Rectangle& r = tiling.tiles[tile];
  const Ray side = image(l, map, sides(l, r)[0]);  // the image of the element is on the left of this ray, or on its right if mirrored
  const int slot = map.mirrored ? (side.slot + l.valence(side.vertex) - 1) % l.valence(side.vertex) : side.slot;
  return {tiling.tile_of_cell[l.cell[side.vertex][slot]], (l.corner[side.vertex][slot] % 2 == 1) != map.mirrored};
}

std::optional<LatticeMap> lattice_map(const Lattice& l, Ray from, Ray to, bool mirrored) {
  LatticeMap map{std::vector<int>(l.vertices(), -1), std::vector<std::uint8_t>(l.vertices()), mirrored};
  std::vector<int> reached;
  const auto agree = [&](Ray a, Ray b) {
    const int n = l.valence(a.vertex);
    if (n != l.valence(b.vertex)) return false;
    const int turn = (mirrored ? b.slot + a.slot : b.slot - a.slot + n) % n;
    if (map.vertex[a.vertex] >= 0) return map.vertex[a.vertex] == b.vertex && map.turn[a.vertex] == turn;
    map.vertex[a.vertex] = b.vertex;
    map.turn[a.vertex] = std::uint8_t(turn);
    reached.push_back(a.vertex);
    return true;
  };
  if (!agree(from, to)) return {};
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (int k = 0; k < l.valence(reached[i]); ++k) {
      const Ray a{reached[i], k}, b = image(l, map, a);
      if (l.ends(a.vertex, a.slot) != l.ends(b.vertex, b.slot)) return {};
      if (l.ends(a.vertex, a.slot)) continue;
      if (!agree(l.reverse(a), l.reverse(b))) return {};
    }
  return map;
}

std::optional<LatticeMap> lattice_map(const TMesh& mesh, const Space& space, std::span<const int> element, bool mirrored) {
  const Lattice& l = *mesh.lattice;
  const Tiling tiling = elements(mesh);
  const std::vector<int> tile = mesh_elements(mesh, space);
  const Ray from = sides(l, tiling.tiles[tile[0]])[0];
  for (const auto [vertex, slot] : sides(l, tiling.tiles[tile[element[0]]])) {
    const auto map = lattice_map(l, from, {vertex, (slot + mirrored) % l.valence(vertex)}, mirrored);
    if (!map) continue;
    bool agrees = true;
    for (std::size_t e = 0; e < element.size() && agrees; ++e) agrees = image(l, *map, tiling, tile[e]).tile == tile[element[e]];
    if (agrees) return map;
  }
  return {};
}

}  // namespace tanktread::spline
