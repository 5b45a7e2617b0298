#include "spline/t_mesh.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "base/formatted.hpp"

namespace tanktread::spline {

namespace {

/// Returns the initial mesh on a lattice, in which all elements have the same size.
TMesh uniform(Lattice lattice) {
  TMesh mesh;
  mesh.lattice = std::make_shared<Lattice>(std::move(lattice));
  const Lattice& l = *mesh.lattice;
  mesh.edges.assign(l.vertices(), 0);
  for (int c = 0; c < l.cells(); ++c)
    for (int k = 0; k < 4; ++k) {
      const int line = k % 2 ? l.x_of(c) + (k == 1) : l.height(l.y_of(c) + (k == 2));
      if (line % l.base == 0) mesh.set(l.side(c, k), true);
    }
  mesh.spacing.assign(l.extraordinary.size(), l.base);
  return mesh;
}

}  // namespace

TMesh cube(int elements_per_side, int levels) {
  if (elements_per_side < 3)
    throw UserError(formatted("A cube mesh needs at least 3 elements per side, %d were asked for.", elements_per_side));
  if (levels < 0 || levels > 12 || double(elements_per_side) * (1 << levels) > 1536)
    throw UserError(formatted("A cube mesh of %d elements per side with %d levels of refinement is too fine: elements per side times 2^levels may "
                              "be at most 1536.",
                              elements_per_side, levels));
  return uniform(cube_lattice(elements_per_side, levels));
}

TMesh polar(int azimuthal_elements, int meridional_elements, int levels) {
  if (azimuthal_elements < 4 || meridional_elements < 4)
    throw UserError(formatted("A polar mesh needs at least 4 elements in azimuth and 4 along the meridian, %d and %d were asked for.",
                              azimuthal_elements, meridional_elements));
  if (levels < 0 || levels > 12 || double(std::max(azimuthal_elements, meridional_elements)) * (1 << levels) > 4096)
    throw UserError(formatted("A polar mesh of %d by %d elements with %d levels of refinement is too fine: elements times 2^levels may be at most "
                              "4096.",
                              azimuthal_elements, meridional_elements, levels));
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
  for (int v : anchors(mesh)) out[v] = n++;
  return out;
}

std::array<Ray, 4> sides(const Lattice& l, const Rectangle& r) {
  const int right = r.x + r.width - 1, top = r.y + r.height - 1;
  const auto side = [&](int x, int y, int k) { return l.side(l.cell_at(r.face, x, y), k); };
  return {side(r.x, r.y, 0), side(right, r.y, 1), side(right, top, 2), side(r.x, top, 3)};
}

bool is_degenerate(const Lattice& l, const Rectangle& r) {
  return l.pad > 0 && (l.height(r.y) == 0 || l.height(r.y + r.height) == l.height(l.rows));
}

Tiling elements(const TMesh& mesh) {
  const Lattice& l = *mesh.lattice;
  Tiling t;
  t.tile_of_cell.assign(l.cells(), -1);
  for (int c = 0; c < l.cells(); ++c) {
    if (t.tile_of_cell[c] >= 0 || l.is_flat(c)) continue;
    int width = 1, height = 1;
    while (!mesh.edge_of_cell(c + width - 1, 1)) ++width;
    while (!mesh.edge_of_cell(c + (height - 1) * l.units, 2)) ++height;
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) t.tile_of_cell[c + j * l.units + i] = int(t.tiles.size());
    t.tiles.push_back({l.face_of(c), l.x_of(c), l.y_of(c), width, height});
  }
  return t;
}

namespace {

/// Returns the unit edges on the line of a ray, up to the vertex at which the line meets perpendicular edges for the `count`-th time.
std::vector<Ray> bays(const TMesh& mesh, Ray ray, int count) {
  std::vector<Ray> path;
  while (count > 0 && !mesh.lattice->ends(ray.vertex, ray.slot)) {
    path.push_back(ray);
    ray = step(*mesh.lattice, ray);
    if (mesh.lattice->valence(ray.vertex) == 3) break;
    if (touches(mesh, ray)) --count;
  }
  return path;
}

}  // namespace

int missing_slot(const TMesh& mesh, int v) {
  constexpr std::int8_t missing[16] = {-1, -1, -1, -1, -1, -1, -1, 3, -1, -1, -1, 2, -1, 1, 0, -1};
  const int m = mesh.lattice->valence(v) == 4 ? missing[mesh.edges[v]] : -1;
  return m >= 0 && !mesh.lattice->ends(v, m) ? m : -1;
}

std::vector<TJunction> t_junctions(const TMesh& mesh) {
  std::vector<TJunction> out;
  for (int v = 0; v < mesh.lattice->vertices(); ++v)
    if (const int m = missing_slot(mesh, v); m >= 0) out.push_back({v, m});
  return out;
}

std::vector<Ray> face_extension(const TMesh& mesh, const TJunction& t) { return bays(mesh, {t.vertex, t.missing}, 2); }
std::vector<Ray> edge_extension(const TMesh& mesh, const TJunction& t) { return bays(mesh, {t.vertex, (t.missing + 2) & 3}, 1); }

Tiling bezier_mesh(const TMesh& mesh) {
  TMesh extended = mesh;
  for (const TJunction& t : t_junctions(mesh))
    for (const Ray& r : face_extension(mesh, t)) extended.set(r, true);
  return elements(extended);
}

}  // namespace tanktread::spline
