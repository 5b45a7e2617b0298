#include "spline/extraction.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>

#include "spline/catmull_clark.hpp"
#include "spline/extraordinary_g1.hpp"
#include "spline/knots.hpp"

namespace tanktread::spline {

namespace {

/// Coefficients of one function on one Bezier element, before they are sorted by element.
struct Contribution {
  int tile, point;
  std::array<double, 16> row;
};

int width_along(const Rectangle& r, int turn) { return turn & 1 ? r.height : r.width; }

/// Cells from `cell` to the near side (behind) of its tile, looking in direction `turn`.
int behind(const Lattice& l, const Rectangle& r, int cell, int turn) {
  switch (turn & 3) {
    case 0:
      return l.x_of(cell) - r.x;
    case 1:
      return l.y_of(cell) - r.y;
    case 2:
      return r.x + r.width - 1 - l.x_of(cell);
    default:
      return r.y + r.height - 1 - l.y_of(cell);
  }
}

/// The outer product of coefficients along forward and left, in the element's own s, t.
std::array<double, 16> in_frame(const std::array<double, 4>& ahead, const std::array<double, 4>& aside, int turn) {
  std::array<double, 16> row;
  for (int b = 0; b < 4; ++b)
    for (int a = 0; a < 4; ++a) {
      const int i = turn == 0 ? a : turn == 1 ? 3 - b : turn == 2 ? 3 - a : b;
      const int j = turn == 0 ? b : turn == 1 ? a : turn == 2 ? 3 - b : 3 - a;
      row[4 * j + i] = ahead[a] * aside[b];
    }
  return row;
}

struct Builder {
  const TMesh& mesh;
  const Lattice& l;
  Tiling tiling;
  std::vector<int> anchor, point;  // lattice vertex of a control point; the inverse
  std::vector<int> irregular;      // of a tile: its corner at an extraordinary point, or -1
  std::vector<Contribution> entries;

  explicit Builder(const TMesh& m) : mesh(m), l(*m.lattice), tiling(bezier_mesh(m)), anchor(anchors(m)), point(control_points(m)) {
    irregular.assign(tiling.tiles.size(), -1);
    for (int v : l.extraordinary)
      for (int s = 0; s < 3; ++s) irregular[tiling.tile_of_cell[l.cell[v][s]]] = l.corner[v][s];
  }

  /// Function of control point A on the regular elements of the quadrant between slots q and q + 1 of its anchor.
  void quadrant(int A, const Knots& k, int q) {
    const int v = anchor[A], next = (q + 1) % l.valence(v);
    const bool mirrored = l.valence(v) == 3;
    const int* ahead = k.reach[q];
    const int* aside = k.reach[next];
    const int* back = mirrored ? ahead : k.reach[(q + 2) & 3];
    const int* right = mirrored ? aside : k.reach[(q + 3) & 3];
    auto knots_of = [](const int* minus, const int* plus) {
      return std::array<double, 5>{double(-minus[1]), double(-minus[0]), 0.0, double(plus[0]), double(plus[1])};
    };
    const auto ka = knots_of(back, ahead), kb = knots_of(right, aside);

    Walker row{l.cell[v][q], l.corner[v][q]};
    for (int j = 0; j < aside[1];) {
      int up = aside[1] - j;
      Walker w = row;
      for (int i = 0; i < ahead[1];) {
        const int tile = tiling.tile_of_cell[w.cell];
        const Rectangle& r = tiling.tiles[tile];
        const int along = width_along(r, w.turn), across = width_along(r, w.turn + 1);
        const int below = behind(l, r, w.cell, w.turn + 1), rest = along - behind(l, r, w.cell, w.turn);
        if (below == 0 && rest == along && irregular[tile] < 0)
          entries.push_back({tile, A, in_frame(b_spline_on(ka, i, i + along), b_spline_on(kb, j, j + across), w.turn)});
        up = std::min(up, across - below);
        i += rest;
        if (i < ahead[1]) w = forward(l, w, rest);
      }
      j += up;
      if (j < aside[1]) row = left(l, row, up);
    }
  }

  /// The 19 control points around an irregular element, in the order of OneRing with spoke 0 along its first side seen from the point.
  std::array<int, OneRing::size> ring(int tile) const {
    const Rectangle& r = tiling.tiles[tile];
    const int h = r.width, P = corners(l, r)[irregular[tile]];
    int first = 0;
    while (tiling.tile_of_cell[l.cell[P][first]] != tile) ++first;
    auto walk = [&](Ray ray) {
      for (int i = 0; i < h; ++i) ray = step(l, ray);
      return ray;
    };
    auto turn_left = [](Ray ray) { return Ray{ray.vertex, (ray.slot + 1) & 3}; };
    auto turn_right = [](Ray ray) { return Ray{ray.vertex, (ray.slot + 3) & 3}; };
    std::array<int, OneRing::size> out{};
    out[OneRing::P] = point[P];
    for (int j = 0; j < 3; ++j) {
      const Ray e = walk({P, (first + j) % 3}), f = walk(turn_left(e)), b = walk(turn_right(f)), c = walk(turn_left(b));
      out[OneRing::E + j] = point[e.vertex];
      out[OneRing::F + j] = point[f.vertex];
      out[OneRing::A + j] = point[walk(e).vertex];
      out[OneRing::B + j] = point[b.vertex];
      out[OneRing::C + j] = point[c.vertex];
      out[OneRing::D + j] = point[walk(f).vertex];
    }
    if (r.height != h || std::find(out.begin(), out.end(), -1) != out.end())
      throw std::logic_error("The rings at an extraordinary point are not uniform.");
    return out;
  }
};

/// Columns of a matrix whose row (p + 1) v + u belongs to a face with its point at corner 0, for a face with the point at corner k;
/// transposed to (functions, Bernstein).
Eigen::MatrixXd at_corner(const Eigen::MatrixXd& table, int p, int k) {
  Eigen::MatrixXd out(table.cols(), table.rows());
  for (int v = 0; v <= p; ++v)
    for (int u = 0; u <= p; ++u) {
      const int i = k == 0 ? u : k == 1 ? p - v : k == 2 ? p - u : v;
      const int j = k == 0 ? v : k == 1 ? u : k == 2 ? p - v : p - u;
      out.col((p + 1) * j + i) = table.row((p + 1) * v + u).transpose();
    }
  return out;
}

/// Every tile whose closure holds the generalised Greville point of control point A, with the local coordinates there.
std::vector<Site> greville(const Builder& b, int A, const Knots& k) {
  const Lattice& l = b.l;
  const int v = b.anchor[A];
  std::vector<Site> sites;
  // A point of a cell in thirds of a unit, face frame.
  auto add = [&](int cell, int x, int y) {
    const int tile = b.tiling.tile_of_cell[cell];
    for (const Site& s : sites)
      if (s.element == tile) return;
    const Rectangle& r = b.tiling.tiles[tile];
    sites.push_back({tile, (3 * (l.x_of(cell) - r.x) + x) / (3.0 * r.width), (3 * (l.y_of(cell) - r.y) + y) / (3.0 * r.height)});
  };
  auto add_vertex = [&](int w) {
    for (int s = 0; s < l.valence(w); ++s) {
      const int c = l.corner[w][s];
      add(l.cell[w][s], c == 1 || c == 2 ? 3 : 0, c >= 2 ? 3 : 0);
    }
  };
  auto add_edge = [&](int cell, int edge, int thirds) {
    const int at[4][2] = {{thirds, 0}, {3, thirds}, {3 - thirds, 3}, {0, 3 - thirds}};
    add(cell, at[edge][0], at[edge][1]);
  };

  if (l.valence(v) == 3) {
    add_vertex(v);
  } else {
    // Offsets along slots 0 and 1, in thirds of a unit.
    const int o0 = k.reach[0][0] - k.reach[2][0], o1 = k.reach[1][0] - k.reach[3][0];
    const int q = o0 >= 0 ? (o1 >= 0 ? 0 : 3) : (o1 >= 0 ? 1 : 2);
    const int ahead = std::abs(q & 1 ? o1 : o0), aside = std::abs(q & 1 ? o0 : o1);
    const Walker w = left(l, forward(l, {l.cell[v][q], l.corner[v][q]}, ahead / 3), aside / 3);
    const int a = ahead % 3, c = aside % 3, t = w.turn;
    if (a == 0 && c == 0) {
      add_vertex(l.corners[w.cell][t]);
    } else if (a == 0 || c == 0) {
      // On the side behind (from corner t + 3 to t) or to the right (from t to t + 1).
      const int edge = c == 0 ? t : (t + 3) & 3, thirds = c == 0 ? a : 3 - c;
      add_edge(w.cell, edge, thirds);
      const int u = l.corners[w.cell][edge], s = (l.slot[w.cell][edge] + l.valence(u) - 1) % l.valence(u);
      add_edge(l.cell[u][s], (l.corner[u][s] + 3) & 3, 3 - thirds);
    } else {
      const int at[4][2] = {{a, c}, {3 - c, a}, {3 - a, 3 - c}, {c, 3 - a}};
      add(w.cell, at[t][0], at[t][1]);
    }
  }
  std::sort(sites.begin(), sites.end(), [](const Site& x, const Site& y) { return x.element < y.element; });
  return sites;
}

/// Elements of a tile at an extraordinary point, in the tile's own unit square: one bi-quartic, or the Catmull-Clark pieces.
std::vector<Element> around_point(const std::array<int, OneRing::size>& ring, int corner, ExtraordinaryRule rule, int depth) {
  std::vector<Element> out;
  if (rule == ExtraordinaryRule::g1) {
    Element e;
    e.degree = 4;
    e.points.assign(ring.begin(), ring.end());
    e.extraction = at_corner(constrained_biquartic(), 4, corner);
    out.push_back(std::move(e));
    return out;
  }
  for (const Piece& piece : catmull_clark_pieces(depth)) {
    const double u = piece.u, v = piece.v, far_u = 1 - u - piece.size, far_v = 1 - v - piece.size;
    const double x[4] = {u, far_v, far_u, v}, y[4] = {v, u, far_v, far_u};
    Element e;
    e.origin = {x[corner], y[corner]};
    e.size = {piece.size, piece.size};
    const Eigen::MatrixXd all = at_corner(piece.extraction.transpose(), 3, corner);
    std::vector<int> used;
    for (int i = 0; i < OneRing::size; ++i)
      if ((all.row(i).array() != 0).any()) used.push_back(i);
    e.extraction = all(used, Eigen::all);
    for (int i : used) e.points.push_back(ring[i]);
    out.push_back(std::move(e));
  }
  return out;
}

int log2_of(int power) { return std::countr_zero(unsigned(power)); }

}  // namespace

Space space(const TMesh& mesh, ExtraordinaryRule rule) {
  Builder b(mesh);
  const Lattice& l = b.l;
  Space out;
  out.n_points = int(b.anchor.size());
  out.collocation.resize(out.n_points);
  b.entries.reserve(std::size_t(17) * out.n_points);
  for (int A = 0; A < out.n_points; ++A) {
    const Knots k = knots(mesh, b.anchor[A]);
    for (int q = 0; q < l.valence(b.anchor[A]); ++q) b.quadrant(A, k, q);
    out.collocation[A] = greville(b, A, k);
  }

  const int tiles = int(b.tiling.tiles.size());
  std::vector<int> count(tiles, 0), first(tiles + 1, 0);  // functions of a tile; its first element
  for (const Contribution& c : b.entries) ++count[c.tile];
  out.elements.reserve(tiles);
  // The averaged square keeps its side, 2^-max(levels, 4) of a base element, however often the rings around it are refined.
  const int levels = log2_of(l.base), below_unit = std::max(levels, 4) - levels;
  std::map<std::pair<int, int>, std::vector<Element>> patterns;  // by corner and spacing, with ring numbers for points
  std::array<int, OneRing::size> numbers;
  std::iota(numbers.begin(), numbers.end(), 0);
  for (int t = 0; t < tiles; ++t) {
    const Rectangle& r = b.tiling.tiles[t];
    first[t] = int(out.elements.size());
    if (b.irregular[t] < 0) {
      Element e;
      e.points.reserve(count[t]);
      e.extraction.resize(count[t], 16);
      out.elements.push_back(std::move(e));
    } else {
      const auto ring = b.ring(t);
      auto& pattern = patterns[{b.irregular[t], r.width}];
      if (pattern.empty()) pattern = around_point(numbers, b.irregular[t], rule, below_unit + log2_of(r.width));
      for (Element e : pattern) {
        for (int& p : e.points) p = ring[p];
        out.elements.push_back(std::move(e));
      }
    }
    for (std::size_t k = first[t]; k < out.elements.size(); ++k) {
      Element& e = out.elements[k];
      e.face = r.face;
      e.origin = {(r.x + e.origin[0] * r.width) / l.units, (r.y + e.origin[1] * r.height) / l.units};
      e.size = {e.size[0] * r.width / l.units, e.size[1] * r.height / l.units};
    }
  }
  first[tiles] = int(out.elements.size());
  for (const Contribution& c : b.entries) {
    Element& e = out.elements[first[c.tile]];
    e.extraction.row(Eigen::Index(e.points.size())) = Eigen::Map<const Eigen::Matrix<double, 1, 16>>(c.row.data());
    e.points.push_back(c.point);
  }
  for (auto& sites : out.collocation) {
    std::vector<Site> found;
    for (const Site& site : sites) {
      const Rectangle& r = b.tiling.tiles[site.element];
      const double x = (r.x + site.s * r.width) / l.units, y = (r.y + site.t * r.height) / l.units;
      if (first[site.element + 1] - first[site.element] == 1) {
        found.push_back({first[site.element], site.s, site.t});
        continue;
      }
      for (int k = first[site.element]; k < first[site.element + 1]; ++k) {
        const Element& e = out.elements[k];
        const double s = (x - e.origin[0]) / e.size[0], t = (y - e.origin[1]) / e.size[1], margin = 1e-9;
        if (std::min(s, t) > -margin && std::max(s, t) < 1 + margin) found.push_back({k, std::clamp(s, 0.0, 1.0), std::clamp(t, 0.0, 1.0)});
      }
    }
    sites = std::move(found);
  }
  out.description = std::to_string(out.elements.size()) + " Bezier elements on a cube, " + std::to_string(out.n_points) +
                    " control points, eight extraordinary points (" + (rule == ExtraordinaryRule::g1 ? "g1" : "catmull-clark") + ")";
  return out;
}

}  // namespace tanktread::spline
