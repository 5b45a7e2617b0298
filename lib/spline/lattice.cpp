#include "spline/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <Eigen/Geometry>

namespace tanktread::spline {

namespace {

/// Computes the connectivity of the vertices from the corners of the cells: for each vertex and direction (slot), the neighbour, the cell, and the
/// slot of the neighbour that points back to the vertex. The cell between slots 0 and 1 of a vertex is its cell of lowest index.
void connect(Lattice& l) {
  const int n = int(l.position.size());
  l.neighbour.assign(n, {-1, -1, -1, -1});
  l.back.assign(n, {0, 0, 0, 0});
  l.cell.assign(n, {-1, -1, -1, -1});
  l.corner.assign(n, {0, 0, 0, 0});
  l.slot.resize(l.corners.size());
  l.is_extraordinary.assign(n, 0);

  // Cells around each vertex, in ascending order.
  std::vector<std::array<int, 4>> around(n, {-1, -1, -1, -1});
  std::vector<std::array<std::uint8_t, 4>> which(n);
  for (int c = 0; c < l.cells(); ++c)
    for (int k = 0; k < 4; ++k) {
      const int v = l.corners[c][k];
      int i = 0;
      while (around[v][i] >= 0) ++i;
      around[v][i] = c;
      which[v][i] = std::uint8_t(k);
    }

  for (int v = 0; v < n; ++v) {
    int i = 0;
    for (int s = 0; s < 4; ++s) {
      const int c = around[v][i], k = which[v][i];
      l.neighbour[v][s] = l.corners[c][(k + 1) & 3];
      l.cell[v][s] = c;
      l.corner[v][s] = std::uint8_t(k);
      l.slot[c][k] = std::uint8_t(s);
      const int last = l.corners[c][(k + 3) & 3];  // neighbour of v in the slot after s
      if (last == l.neighbour[v][0]) break;
      i = 0;
      while (l.corners[around[v][i]][(which[v][i] + 1) & 3] != last) ++i;
    }
  }
  for (int v = 0; v < n; ++v) {
    for (int s = 0; s < 4 && l.neighbour[v][s] >= 0; ++s) {
      const auto& there = l.neighbour[l.neighbour[v][s]];
      l.back[v][s] = std::uint8_t(std::find(there.begin(), there.end(), v) - there.begin());
    }
    l.is_extraordinary[v] = l.neighbour[v][3] < 0;
    if (l.is_extraordinary[v]) l.extraordinary.push_back(v);
  }
  l.point_at.assign(l.faces, {-1, -1, -1, -1});
  for (int i = 0; i < int(l.extraordinary.size()); ++i)
    for (int s = 0; s < 3; ++s) l.point_at[l.face_of(l.cell[l.extraordinary[i]][s])][l.corner[l.extraordinary[i]][s]] = i;
}

Walker cross(const Lattice& l, Walker w, int edge, int& entered) {
  const int v = l.corners[w.cell][edge], s = (l.slot[w.cell][edge] + l.valence(v) - 1) % l.valence(v);
  entered = (l.corner[v][s] + 3) & 3;
  return {l.cell[v][s], w.turn};
}

/// Returns the number of cells between a cell and the side of the macro face in direction `turn`.
int room(const Lattice& l, int cell, int turn) {
  const int x = l.x_of(cell), y = l.y_of(cell), cells[4] = {l.units - 1 - x, l.rows - 1 - y, x, y};
  return cells[turn];
}

/// Returns the walker (cell and direction) after n cells in the direction w.turn + offset.
Walker move(const Lattice& l, Walker w, int n, int offset) {
  const int stride[4] = {1, l.units, -1, -l.units};
  while (n > 0) {
    const int d = (w.turn + offset) & 3, inside = std::min(n, room(l, w.cell, d));
    w.cell += inside * stride[d];
    n -= inside;
    if (n == 0) break;
    int entered;
    w = cross(l, w, (d + 1) & 3, entered);
    w.turn = (entered + 1 - offset) & 3;
    --n;
  }
  return w;
}

}  // namespace

Walker forward(const Lattice& l, Walker w, int n) { return move(l, w, n, 0); }
Walker left(const Lattice& l, Walker w, int n) { return move(l, w, n, 1); }

PlacedEdge placed(const Lattice& l, Ray e) {
  const int c = l.cell[e.vertex][e.slot], k = l.corner[e.vertex][e.slot];
  if (c < 0) return {0, e.vertex % l.units, e.vertex / l.units, true};  // the edge is on the border of the polar lattice
  return {l.face_of(c), l.x_of(c) + (k == 1), l.y_of(c) + (k == 2), k % 2 == 0};
}

std::array<int, 2> distances(const Lattice& l, const PlacedEdge& e, int corner) {
  const auto distance = [&](int x, int y) { return std::max(corner == 1 || corner == 2 ? l.units - x : x, corner >= 2 ? l.units - y : y); };
  const auto [near, far] = std::minmax({distance(e.x, e.y), distance(e.x + e.horizontal, e.y + !e.horizontal)});
  return {near, far};
}

int Lattice::length(int v, int k, int steps) const {
  if (pad == 0 || k % 2 == 0) return steps;
  const int y = v / units;
  return k == 1 ? height(y + steps) - height(y) : height(y) - height(y - steps);
}

void Lattice::set(std::vector<std::uint8_t>& edges, Ray edge, bool present) const {
  for (const auto [v, k] : {edge, reverse(edge)}) {
    const int bit = 1 << k;
    edges[v] = std::uint8_t(present ? edges[v] | bit : edges[v] & ~bit);
  }
}

Lattice polar_lattice(int azimuthal_elements, int meridional_elements, int levels) {
  Lattice l;
  l.faces = 1;
  l.base = 1 << levels;
  l.pad = 1;
  const int W = l.units = azimuthal_elements * l.base, H = l.rows = meridional_elements * l.base + 2, n = W * (H + 1);
  l.neighbour.resize(n);
  l.back.assign(n, {2, 3, 0, 1});
  l.cell.resize(n);
  l.corner.assign(n, {0, 1, 2, 3});
  l.is_extraordinary.assign(n, 0);
  l.point_at.assign(1, {-1, -1, -1, -1});
  l.corners.resize(std::size_t(W) * H);
  l.slot.assign(l.corners.size(), {0, 1, 2, 3});
  for (int y = 0; y <= H; ++y)
    for (int x = 0; x < W; ++x) {
      const int v = y * W + x, right = (x + 1) % W, left_x = (x + W - 1) % W;
      const double longitude = 2 * M_PI * x / W, latitude = M_PI * (double(l.height(y)) / (H - 2) - 0.5);
      l.position.emplace_back(std::cos(longitude) * std::cos(latitude), std::sin(longitude) * std::cos(latitude), std::sin(latitude));
      l.neighbour[v] = {y * W + right, y < H ? v + W : -1, y * W + left_x, y > 0 ? v - W : -1};
      l.cell[v] = {y < H ? v : -1, y < H ? y * W + left_x : -1, y > 0 ? (y - 1) * W + left_x : -1, y > 0 ? v - W : -1};
      if (y < H) l.corners[v] = {v, y * W + right, (y + 1) * W + right, v + W};
    }
  return l;
}

Lattice cube_lattice(int elements_per_side, int levels) {
  using Int3 = Eigen::Vector3i;
  // Unit vectors X, Y, Z. `axis`: directions of x and y of each face; their cross product points outwards.
  const Int3 X(1, 0, 0), Y(0, 1, 0), Z(0, 0, 1);
  const Int3 axis[6][2] = {{Y, Z}, {Z, Y}, {Z, X}, {X, Z}, {X, Y}, {Y, X}};

  Lattice l;
  l.faces = 6;
  l.base = 1 << levels;
  const int R = l.units = l.rows = elements_per_side * l.base;
  l.corners.resize(std::size_t(6) * R * R);
  l.position.reserve(std::size_t(6) * R * R + 2);

  std::unordered_map<long long, int> on_a_side;  // vertices that several faces share
  std::vector<int> id(std::size_t(R + 1) * (R + 1));
  for (int f = 0; f < 6; ++f) {
    const Int3 x = axis[f][0], y = axis[f][1], out = x.cross(y);
    for (int j = 0; j <= R; ++j)
      for (int i = 0; i <= R; ++i) {
        const Int3 p = R * out + (2 * i - R) * x + (2 * j - R) * y;
        auto fresh = [&] {
          l.position.push_back(p.cast<double>() / R);
          return int(l.position.size()) - 1;
        };
        int& v = id[std::size_t(j) * (R + 1) + i];
        if (i > 0 && i < R && j > 0 && j < R) {
          v = fresh();
          continue;
        }
        const long long m = 2LL * R + 1, key = ((p[0] + R) * m + (p[1] + R)) * m + (p[2] + R);
        const auto found = on_a_side.find(key);
        v = found != on_a_side.end() ? found->second : (on_a_side[key] = fresh());
      }
    for (int j = 0; j < R; ++j)
      for (int i = 0; i < R; ++i) {
        const int a = j * (R + 1) + i, b = a + R + 1;
        l.corners[l.cell_at(f, i, j)] = {id[a], id[a + 1], id[b + 1], id[b]};
      }
  }
  connect(l);
  return l;
}

}  // namespace tanktread::spline
