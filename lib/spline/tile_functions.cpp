#include "spline/tile_functions.hpp"

#include <algorithm>
#include <cstdlib>

#include "spline/bernstein.hpp"

namespace tanktread::spline {

namespace {

void reach_along(const TMesh& mesh, Ray ray, int out[2]) {
  const Lattice& l = *mesh.lattice;
  int found = 0;
  for (int distance = 1; found < 2; ++distance) {
    if (l.ends(ray.vertex, ray.slot)) {  // the end knot, repeated
      for (; found < 2; ++found) out[found] = distance - 1;
      return;
    }
    ray = step(l, ray);
    if (l.valence(ray.vertex) == 3) {
      out[found] = distance;
      if (found == 0) out[1] = 2 * distance;
      return;
    }
    if (touches(mesh, ray)) out[found++] = distance;
  }
}

int width_along(const Rectangle& r, int turn) { return turn & 1 ? r.height : r.width; }

/// Returns the number of lattice cells between `cell` and the rear side of its mesh element r, where `turn` is the forward direction (see Walker).
int behind(const Lattice& l, const Rectangle& r, int cell, int turn) {
  const int x = l.x_of(cell) - r.x, y = l.y_of(cell) - r.y;
  const int cells[4] = {x, y, r.width - 1 - x, r.height - 1 - y};
  return cells[turn & 3];
}

/// Returns the 16 products ahead[a] aside[b] of Bezier coefficients, in the order of the local coordinates s, t of the element. `ahead`: coefficients
/// along the direction `turn`. `aside`: coefficients along the direction to the left of it, as in Walker.
std::array<double, 16> in_frame(const std::array<double, 4>& ahead, const std::array<double, 4>& aside, int turn) {
  std::array<double, 16> row;
  for (int b = 0; b < 4; ++b)
    for (int a = 0; a < 4; ++a) {
      const auto [i, j] = turned(a, b, 3, turn);
      row[4 * j + i] = ahead[a] * aside[b];
    }
  return row;
}

struct Builder {
  const TMesh& mesh;
  const Lattice& l;
  TileFunctions& out;

  /// Returns the mesh element that contains a cell, and sets `number` to its index. A cell of zero height counts as a separate element with a
  /// negative `number`.
  Rectangle tile(int cell, int& number) const {
    number = out.tiling.tile_of_cell[cell];
    return number < 0 ? Rectangle{l.face_of(cell), l.x_of(cell), l.y_of(cell), 1, 1} : out.tiling.tiles[number];
  }

  /// Adds the Bezier coefficients of function A on the regular mesh elements in one quadrant around its anchor: between the directions (slots) q and
  /// q + 1.
  void quadrant(int A, int q) {
    const int v = out.anchor[A], next = (q + 1) % l.valence(v);
    if (l.cell[v][q] < 0) return;
    const bool mirrored = l.valence(v) == 3;
    const Knots& k = out.knots[A];
    const int* ahead = k.reach[q];
    const int* aside = k.reach[next];
    auto knots_of = [&](int slot) {
      const int *plus = k.reach[slot], *minus = mirrored ? plus : k.reach[(slot + 2) & 3];
      const int back = mirrored ? slot : (slot + 2) & 3;
      return std::array<double, 5>{-double(l.length(v, back, minus[1])), -double(l.length(v, back, minus[0])), 0.0,
                                   double(l.length(v, slot, plus[0])), double(l.length(v, slot, plus[1]))};
    };
    const std::array<double, 5> knots_ahead = knots_of(q), knots_aside = knots_of(next);

    Walker row{l.cell[v][q], l.corner[v][q]};
    for (int j = 0; j < aside[1];) {
      int up = aside[1] - j;
      Walker w = row;
      for (int i = 0; i < ahead[1];) {
        int number;
        const Rectangle r = tile(w.cell, number);
        const int along = width_along(r, w.turn), across = width_along(r, w.turn + 1);
        const int below = behind(l, r, w.cell, w.turn + 1), rest = along - behind(l, r, w.cell, w.turn);
        if (below == 0 && rest == along && number >= 0 && out.irregular[number] < 0) {
          const auto a = b_spline_on(knots_ahead, l.length(v, q, i), l.length(v, q, i + along));
          const auto b = b_spline_on(knots_aside, l.length(v, next, j), l.length(v, next, j + across));
          out.entries.push_back({number, A, in_frame(a, b, w.turn)});
        }
        up = std::min(up, across - below);
        i += rest;
        if (i < ahead[1]) w = forward(l, w, rest);
      }
      j += up;
      if (j < aside[1]) row = left(l, row, up);
    }
  }
};

}  // namespace

Knots knots(const TMesh& mesh, int anchor) {
  Knots k{};
  for (int s = 0; s < mesh.lattice->valence(anchor); ++s) reach_along(mesh, {anchor, s}, k.reach[s]);
  return k;
}

TileFunctions tile_functions(const TMesh& mesh) {
  const Lattice& l = *mesh.lattice;
  TileFunctions out;
  out.tiling = bezier_mesh(mesh);
  out.anchor = anchors(mesh);
  out.irregular.assign(out.tiling.tiles.size(), -1);
  for (int v : l.extraordinary)
    for (int s = 0; s < 3; ++s) out.irregular[out.tiling.tile_of_cell[l.cell[v][s]]] = l.corner[v][s];
  out.entries.reserve(17 * out.anchor.size());
  out.knots.reserve(out.anchor.size());
  for (int v : out.anchor) out.knots.push_back(knots(mesh, v));
  Builder builder{mesh, l, out};
  for (int A = 0; A < int(out.anchor.size()); ++A)
    for (int q = 0; q < l.valence(out.anchor[A]); ++q) builder.quadrant(A, q);
  return out;
}

CellPoint greville(const TMesh& mesh, int v, const Knots& k) {
  const Lattice& l = *mesh.lattice;
  if (l.valence(v) == 3) {
    const auto [x, y] = turned(0, 0, 3, l.corner[v][0]);
    return {l.cell[v][0], x, y};
  }
  // The Greville point is the mean of the three inner knots, and the middle one of these knots is at the anchor. So the distance from the anchor to
  // the Greville point, in thirds of a lattice unit, is the sum of the positions of the other two knots relative to the anchor. o0: along direction
  // 0, o1: along direction 1.
  const int o0 = l.length(v, 0, k.reach[0][0]) - l.length(v, 2, k.reach[2][0]);
  const int o1 = l.length(v, 1, k.reach[1][0]) - l.length(v, 3, k.reach[3][0]);
  if (l.pad > 0) {  // polar mesh: a single face, so that directions do not turn between faces
    const int x = (3 * (v % l.units) + o0 + 3 * l.units) % (3 * l.units), y = 3 * l.height(v / l.units) + o1;
    const int row = std::min(y / 3, l.rows - 2 * l.pad - 1);
    return {l.cell_at(0, x / 3, row + l.pad), x % 3, y - 3 * row};
  }
  const int q = o0 >= 0 ? (o1 >= 0 ? 0 : 3) : (o1 >= 0 ? 1 : 2);
  const int ahead = std::abs(q & 1 ? o1 : o0), aside = std::abs(q & 1 ? o0 : o1);
  const Walker w = left(l, forward(l, {l.cell[v][q], l.corner[v][q]}, ahead / 3), aside / 3);
  const auto [x, y] = turned(ahead % 3, aside % 3, 3, w.turn);
  return {w.cell, x, y};
}

std::vector<Site> tiles_around(const TMesh& mesh, const Tiling& tiling, const CellPoint& p) {
  const Lattice& l = *mesh.lattice;
  std::vector<Site> sites;
  auto add = [&](int cell, const std::array<int, 2>& at) {
    const int tile = cell < 0 ? -1 : tiling.tile_of_cell[cell];
    if (tile < 0 || std::any_of(sites.begin(), sites.end(), [&](const Site& s) { return s.element == tile; })) return;
    const Rectangle& r = tiling.tiles[tile];
    sites.push_back({tile, (3 * (l.x_of(cell) - r.x) + at[0]) / (3.0 * r.width), (3 * (l.y_of(cell) - r.y) + at[1]) / (3.0 * r.height)});
  };
  const bool on_vertical = p.x % 3 == 0, on_horizontal = p.y % 3 == 0;
  if (on_vertical && on_horizontal) {
    const int w = l.corners[p.cell][p.y == 0 ? (p.x == 0 ? 0 : 1) : (p.x == 0 ? 3 : 2)];
    for (int s = 0; s < l.valence(w); ++s) add(l.cell[w][s], turned(0, 0, 3, l.corner[w][s]));
  } else {
    add(p.cell, {p.x, p.y});
    if (on_vertical || on_horizontal) {
      // If the point lies on an edge, also adds the cell on the other side of the edge. In this cell the edge has the opposite direction.
      const int edge = on_vertical ? (p.x == 0 ? 3 : 1) : (p.y == 0 ? 0 : 2), along = turned(p.x, p.y, 3, 4 - edge)[0];
      const int u = l.corners[p.cell][edge], s = (l.slot[p.cell][edge] + l.valence(u) - 1) % l.valence(u);
      add(l.cell[u][s], turned(3 - along, 0, 3, (l.corner[u][s] + 3) & 3));
    }
  }
  std::sort(sites.begin(), sites.end(), [](const Site& x, const Site& y) { return x.element < y.element; });
  return sites;
}

}  // namespace tanktread::spline
