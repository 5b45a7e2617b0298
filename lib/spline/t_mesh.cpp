#include "spline/t_mesh.hpp"

#include <algorithm>
#include <string>

#include "base/errors.hpp"
#include "spline/extension.hpp"

namespace tanktread::spline {

namespace {

Tiling tiling(const Lattice& l, const std::vector<std::uint8_t>& edges) {
  auto present = [&](int c, int k) { return edges[l.corners[c][k]] >> l.slot[c][k] & 1; };
  Tiling t;
  t.tile_of_cell.assign(l.cells(), -1);
  for (int c = 0; c < l.cells(); ++c) {
    if (t.tile_of_cell[c] >= 0 || l.is_flat(c)) continue;
    int width = 1, height = 1;
    while (!present(c + width - 1, 1)) ++width;
    while (!present(c + (height - 1) * l.units, 2)) ++height;
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) t.tile_of_cell[c + j * l.units + i] = int(t.tiles.size());
    t.tiles.push_back({l.face_of(c), l.x_of(c), l.y_of(c), width, height});
  }
  return t;
}

/// All lines of the base mesh.
TMesh uniform(Lattice lattice) {
  TMesh mesh;
  mesh.lattice = std::make_shared<Lattice>(std::move(lattice));
  const Lattice& l = *mesh.lattice;
  mesh.edges.assign(l.vertices(), 0);
  for (int c = 0; c < l.cells(); ++c)
    for (int k = 0; k < 4; ++k) {
      const int line = k % 2 ? l.x_of(c) + (k == 1) : l.height(l.y_of(c) + (k == 2));
      if (line % l.base) continue;
      const int v = l.corners[c][k], s = l.slot[c][k];
      mesh.edges[v] |= std::uint8_t(1 << s);
      mesh.edges[l.neighbour[v][s]] |= std::uint8_t(1 << l.back[v][s]);
    }
  mesh.spacing.assign(l.extraordinary.size(), l.base);
  return mesh;
}

}  // namespace

TMesh cube(int elements_per_side, int levels) {
  if (elements_per_side < 3)
    throw UserError("A cube mesh needs at least 3 elements per side, " + std::to_string(elements_per_side) + " were asked for.");
  if (levels < 0 || levels > 12 || double(elements_per_side) * (1 << levels) > 1536)
    throw UserError("A cube mesh of " + std::to_string(elements_per_side) + " elements per side with " + std::to_string(levels) +
                    " levels of refinement is too fine: elements per side times 2^levels may be at most 1536.");
  return uniform(cube_lattice(elements_per_side, levels));
}

TMesh polar(int azimuthal_elements, int meridional_elements, int levels) {
  if (azimuthal_elements < 4 || meridional_elements < 4)
    throw UserError("A polar mesh needs at least 4 elements in azimuth and 4 along the meridian, " + std::to_string(azimuthal_elements) +
                    " and " + std::to_string(meridional_elements) + " were asked for.");
  if (levels < 0 || levels > 12 || double(std::max(azimuthal_elements, meridional_elements)) * (1 << levels) > 4096)
    throw UserError("A polar mesh of " + std::to_string(azimuthal_elements) + " by " + std::to_string(meridional_elements) +
                    " elements with " + std::to_string(levels) +
                    " levels of refinement is too fine: elements times 2^levels may be at most 4096.");
  return uniform(polar_lattice(azimuthal_elements, meridional_elements, levels));
}
bool is_anchor(const TMesh& mesh, int v) { return (mesh.edges[v] & 5) && (mesh.edges[v] & 10); }

std::vector<int> anchors(const TMesh& mesh) {
  std::vector<int> out;
  for (int v = 0; v < mesh.lattice->vertices(); ++v)
    if (is_anchor(mesh, v)) out.push_back(v);
  return out;
}

std::vector<int> control_points(const TMesh& mesh) {
  std::vector<int> out(mesh.lattice->vertices(), -1);
  int n = 0;
  for (int v = 0; v < mesh.lattice->vertices(); ++v)
    if (is_anchor(mesh, v)) out[v] = n++;
  return out;
}

std::array<int, 4> corners(const Lattice& l, const Rectangle& r) {
  auto at = [&](int i, int j, int k) { return l.corners[l.cell_at(r.face, r.x + i, r.y + j)][k]; };
  return {at(0, 0, 0), at(r.width - 1, 0, 1), at(r.width - 1, r.height - 1, 2), at(0, r.height - 1, 3)};
}

bool is_degenerate(const Lattice& l, const Rectangle& r) {
  return l.pad > 0 && (l.height(r.y) == 0 || l.height(r.y + r.height) == l.height(l.rows));
}

Tiling elements(const TMesh& mesh) { return tiling(*mesh.lattice, mesh.edges); }

Tiling bezier_mesh(const TMesh& mesh) {
  auto edges = mesh.edges;
  for (const TJunction& t : t_junctions(mesh))
    for (const Ray& r : face_extension(mesh, t)) {
      edges[r.vertex] |= std::uint8_t(1 << r.slot);
      edges[mesh.lattice->neighbour[r.vertex][r.slot]] |= std::uint8_t(1 << mesh.lattice->back[r.vertex][r.slot]);
    }
  return tiling(*mesh.lattice, edges);
}

}  // namespace tanktread::spline
