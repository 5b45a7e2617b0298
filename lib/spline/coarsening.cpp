#include "spline/refinement.hpp"

#include <algorithm>
#include <bit>

#include "spline/extended_mesh.hpp"

namespace tanktread::spline {

namespace {

/// Returns whether the edge belongs to the uniform rings of elements around the extraordinary point at `corner`. This is the case if, for at least
/// one spacing H = h, 2 h, 4 h, ... below the spacing of the initial mesh, the edge is on the lattice of spacing H and within 3 H of the point. h:
/// current spacing at the point.
bool in_rings(const Lattice& l, const PlacedEdge& e, int corner, int h) {
  for (; h < l.base; h *= 2)
    if (e.line() % h == 0 && distances(l, e, corner)[1] <= 3 * h) return true;
  return false;
}

/// Returns whether the edge must not be removed: it is on a line of the initial mesh, or close to an extraordinary point, where the mesh must remain
/// uniform (see in_rings).
bool is_kept(const TMesh& mesh, const PlacedEdge& e) {
  const Lattice& l = *mesh.lattice;
  if ((e.horizontal ? l.height(e.y) : e.x) % l.base == 0) return true;
  for (int corner = 0; corner < 4; ++corner)
    if (const int point = l.point_at[e.face][corner]; point >= 0 && in_rings(l, e, corner, mesh.spacing[point])) return true;
  return false;
}

struct Remover {
  TMesh mesh;
  std::vector<std::uint8_t> removable;
  const std::vector<LatticeMap>& images;

  const Lattice& lattice() const { return *mesh.lattice; }
  bool may_go(Ray e) const { return removable[e.vertex] >> e.slot & 1; }

  /// Returns the edges on a mesh line from the vertex of `start` to the next vertex with a perpendicular edge. The result is empty if one of the
  /// edges must not be removed. It is also empty if one of the two end vertices does not have perpendicular edges on both sides of the line, because
  /// the removal would leave an element there that is not a rectangle.
  std::vector<Ray> removable_bay(Ray start) const {
    const Lattice& l = lattice();
    auto both_sides = [&](Ray r) { return (mesh.edges[r.vertex] & (r.slot & 1 ? 5 : 10)) == (r.slot & 1 ? 5 : 10); };
    std::vector<Ray> path;
    if (l.valence(start.vertex) == 3 || !both_sides(start) || l.ends(start.vertex, start.slot)) return path;
    Ray r = start;
    do {
      if (!mesh.edge(r.vertex, r.slot) || !may_go(r) || is_kept(mesh, placed(l, r))) return {};
      path.push_back(r);
      r = step(l, r);
      if (l.valence(r.vertex) == 3) return {};
    } while (!touches(mesh, r));
    if (!both_sides(r)) return {};
    return path;
  }

  /// Sets the edges across each row of zero height (repeated end knots at a pole): an edge is present if it continues a mesh line that ends at the
  /// row, otherwise absent.
  void restore_ends() {
    const Lattice& l = lattice();
    for (int c = 0; c < l.cells(); ++c) {
      if (!l.is_flat(c)) continue;
      const bool south = l.y_of(c) == 0;
      const Ray end = south ? Ray{l.corners[c][3], 3} : Ray{l.corners[c][0], 1};
      mesh.set(end, mesh.edge(end.vertex, end.slot ^ 2));
    }
  }

  /// Removes the edges from `start` to the next perpendicular edge, and their images under all symmetries. If one of these edges must stay, removes
  /// nothing. Returns whether edges were removed.
  bool remove_images(Ray start) {
    std::vector<Ray> starts{start}, gone;
    for (const LatticeMap& map : images) starts.push_back(image(lattice(), map, start));
    for (Ray s : starts) {
      if (!mesh.edge(s.vertex, s.slot)) continue;  // already removed, because two symmetries map `start` to the same edge
      const auto bay = removable_bay(s);
      for (Ray e : bay) mesh.set(e, false);
      gone.insert(gone.end(), bay.begin(), bay.end());
      if (!bay.empty()) continue;
      for (Ray e : gone) mesh.set(e, true);
      return false;
    }
    return !gone.empty();
  }

  /// Removes edges in one pass. The edges between two successive perpendicular edges (a bay) are removed together, the shortest bays first. Returns
  /// whether any edge was removed.
  bool remove_bays() {
    const Lattice& l = lattice();
    std::vector<std::pair<std::size_t, Ray>> found;
    for (int v = 0; v < l.vertices(); ++v)
      for (int k = 0; k < l.valence(v); ++k)
        if (mesh.edge(v, k) && may_go({v, k}))
          if (const auto bay = removable_bay({v, k}); !bay.empty() && v < step(l, bay.back()).vertex) found.push_back({bay.size(), {v, k}});
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
      return std::tuple(a.first, a.second.vertex, a.second.slot) < std::tuple(b.first, b.second.vertex, b.second.slot);
    });
    bool any = false;
    for (const auto& [length, start] : found) any = remove_images(start) || any;
    return any;
  }

  /// Returns the edges that must be removed to double the spacing h at an extraordinary point: in each of its three faces, all edges within the
  /// distance 6 h that are not on the lattice of spacing 2 h.
  std::vector<Ray> ring_edges(int point) const {
    const Lattice& l = lattice();
    const int P = l.extraordinary[point], h = mesh.spacing[point];
    std::vector<Ray> out;
    for (int s = 0; s < 3; ++s) {
      const Walker corner{l.cell[P][s], l.corner[P][s]};
      for (int j = 0; j < 6 * h; ++j)
        for (int i = 0; i < 6 * h; ++i) {
          const int c = left(l, forward(l, corner, i), j).cell;
          for (int k = 0; k < 4; ++k) {
            const Ray e = l.side(c, k);
            if (mesh.edge(e.vertex, e.slot) && placed(l, e).line() % (2 * h) != 0) out.push_back(e);
          }
        }
    }
    return out;
  }

  /// Returns the extraordinary points, including `first`, whose spacings h can be doubled only together, because their rings (the uniform layers of
  /// elements around them) share edges to be removed. Empty if one of these edges must stay.
  std::vector<int> doubling_group(int first) const {
    const Lattice& l = lattice();
    std::vector<int> group{first};
    for (std::size_t i = 0; i < group.size(); ++i) {
      if (mesh.spacing[group[i]] >= l.base) return {};
      for (Ray e : ring_edges(group[i])) {
        if (!may_go(e)) return {};
        const PlacedEdge at = placed(l, e);
        for (int corner = 0; corner < 4; ++corner) {
          const int other = l.point_at[at.face][corner];
          if (other < 0 || std::find(group.begin(), group.end(), other) != group.end()) continue;
          if (in_rings(l, at, corner, 2 * mesh.spacing[other])) return {};
          if (in_rings(l, at, corner, mesh.spacing[other])) group.push_back(other);
        }
      }
    }
    return group;
  }

  /// Doubles the spacing h of the elements around each extraordinary point where this is possible (see doubling_group). Returns whether any spacing
  /// was doubled.
  bool double_rings() {
    bool any = false;
    for (int point = 0; point < int(lattice().extraordinary.size()); ++point) {
      const auto group = doubling_group(point);
      std::vector<Ray> edges;
      for (int p : group)
        for (Ray e : ring_edges(p)) edges.push_back(e);
      for (Ray e : edges) mesh.set(e, false);
      for (int p : group) mesh.spacing[p] *= 2;
      any = any || !group.empty();
    }
    return any;
  }
};

}  // namespace

TMesh take_out(const TMesh& mesh, const std::vector<std::uint8_t>& removable, const RepairRules& rules) {
  Remover r{mesh, removable, rules.images};
  while (r.remove_bays() || r.double_rings()) continue;
  r.restore_ends();
  ExtendedMesh extended(std::move(r.mesh));
  repair(extended, rules);
  return std::move(extended).take();
}

TMesh coarsen(const TMesh& mesh, const std::vector<Merge>& merges, const RepairRules& rules) {
  const Lattice& l = *mesh.lattice;
  const Tiling tiling = elements(mesh);
  // Largest width and height to which an element may grow, in lattice cells. Both are powers of two. A mesh line is not removed if its coordinate is
  // a multiple of the smaller limit of the two elements at the line.
  std::vector<std::array<int, 2>> limit(tiling.tiles.size(), {1, 1});
  for (const Merge& m : merges) {
    const Rectangle& r = tiling.tiles[m.element];
    auto grown = [&](int size, int doublings) { return std::min(int(std::bit_floor(unsigned(size))) << std::min(doublings, 16), l.base); };
    limit[m.element] = {m.s > 0 ? grown(r.width, m.s) : 1, m.t > 0 ? grown(r.height, m.t) : 1};
  }
  for (const LatticeMap& map : rules.images)
    for (int tile = 0; tile < int(tiling.tiles.size()); ++tile) {
      const auto [other, exchanged] = image(l, map, tiling, tile);
      for (int a : {0, 1}) limit[tile][a] = std::min(limit[tile][a], limit[other][a != exchanged]);
    }
  std::vector<std::uint8_t> removable(l.vertices(), 0);
  for (int c = 0; c < l.cells(); ++c)
    for (int k : {1, 2}) {  // right and upper edge of each cell
      const bool vertical = k == 1;
      const int row = l.y_of(c), line = vertical ? l.x_of(c) + 1 : l.height(row + 1);
      if (line % l.base == 0 || !mesh.edge_of_cell(c, k)) continue;  // keeps all lines of the initial mesh, including the cube's edges
      if (l.is_flat(c)) continue;
      const int before = tiling.tile_of_cell[c], after = tiling.tile_of_cell[vertical ? c + 1 : c + l.units];
      if (line % std::min(limit[before][!vertical], limit[after][!vertical]) == 0) continue;
      const Ray edge = l.side(c, k);
      l.set(removable, edge, true);
      if (!vertical || !l.pad) continue;  // at a pole, a vertical line has one more edge, across the row of zero height; it is marked here
      if (l.height(row) == 0) l.set(removable, {edge.vertex, 3}, true);
      if (l.height(row) != 0 && l.height(row + 1) == l.rows - 2 * l.pad) l.set(removable, {l.neighbour[edge.vertex][1], 1}, true);
    }
  return take_out(mesh, removable, rules);
}

}  // namespace tanktread::spline
