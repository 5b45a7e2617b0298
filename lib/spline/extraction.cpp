#include "spline/extraction.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>

#include "spline/extraordinary.hpp"
#include "spline/tile_functions.hpp"

namespace tanktread::spline {

namespace {

/// Returns the 19 control points around an element at an extraordinary point, in the order of OneRing. Spoke 0 (a mesh line from the extraordinary
/// point) is the first side of the element, counter-clockwise.
std::array<int, OneRing::size> ring_of(const Lattice& l, const TileFunctions& f, const std::vector<int>& point, int tile) {
  const Rectangle& r = f.tiling.tiles[tile];
  const int h = r.width, P = sides(l, r)[f.irregular[tile]].vertex;
  int first = 0;
  while (f.tiling.tile_of_cell[l.cell[P][first]] != tile) ++first;
  auto walk = [&](Ray ray) {
    for (int i = 0; i < h; ++i) ray = step(l, ray);
    return ray;
  };
  auto turn_left = [](Ray ray) { return Ray{ray.vertex, (ray.slot + 1) & 3}; };
  auto turn_right = [](Ray ray) { return Ray{ray.vertex, (ray.slot + 3) & 3}; };
  std::array<int, OneRing::size> out{};
  out[OneRing::P] = point[P];
  for (int j = 0; j < 3; ++j) {
    const Ray e = walk({P, (first + j) % 3}), o = walk(turn_left(e)), b = walk(turn_right(o)), c = walk(turn_left(b));
    out[OneRing::E + j] = point[e.vertex];
    out[OneRing::F + j] = point[o.vertex];
    out[OneRing::A + j] = point[walk(e).vertex];
    out[OneRing::B + j] = point[b.vertex];
    out[OneRing::C + j] = point[c.vertex];
    out[OneRing::D + j] = point[walk(o).vertex];
  }
  if (r.height != h || std::find(out.begin(), out.end(), -1) != out.end())
    throw std::logic_error("The rings at an extraordinary point are not uniform.");
  return out;
}

/// Converts a table of Bernstein coefficients to an extraction matrix. In the table the extraordinary point is at corner 0 of the face, and
/// coefficient (u, v) of all functions is in row (p + 1) v + u. In the matrix the point is at corner k, and the shape is (functions, Bernstein
/// coefficients).
Eigen::MatrixXd at_corner(const Eigen::MatrixXd& table, int p, int k) {
  Eigen::MatrixXd out(table.cols(), table.rows());
  for (int v = 0; v <= p; ++v)
    for (int u = 0; u <= p; ++u) {
      const auto [i, j] = turned(u, v, p, k);
      out.col((p + 1) * j + i) = table.row((p + 1) * v + u).transpose();
    }
  return out;
}

/// Returns one bi-quartic element that represents a mesh element at an extraordinary point.
std::vector<Element> biquartic_element(const std::array<int, OneRing::size>& ring, int corner) {
  Element e;
  e.degree = 4;
  e.points.assign(ring.begin(), ring.end());
  e.extraction = std::make_shared<const Eigen::MatrixXd>(at_corner(constrained_biquartic(), 4, corner));
  return {std::move(e)};
}

/// Returns the pieces of the Catmull-Clark surface that represent a mesh element at an extraordinary point.
std::vector<Element> subdivided_element(const std::array<int, OneRing::size>& ring, int corner, int depth) {
  std::vector<Element> out;
  for (const Piece& piece : catmull_clark_pieces(depth)) {
    Element e;
    e.origin = turned(piece.u, piece.v, 1 - piece.size, corner);
    e.size = {piece.size, piece.size};
    const Eigen::MatrixXd all = at_corner(piece.extraction.transpose(), 3, corner);
    std::vector<int> used;
    for (int i = 0; i < OneRing::size; ++i)
      if ((all.row(i).array() != 0).any()) used.push_back(i);
    e.extraction = std::make_shared<const Eigen::MatrixXd>(all(used, Eigen::all));
    for (int i : used) e.points.push_back(ring[i]);
    out.push_back(std::move(e));
  }
  return out;
}

/// Returns the Bezier elements that represent a mesh element at an extraordinary point, positioned in the unit square of the mesh element.
std::vector<Element> around_point(const std::array<int, OneRing::size>& ring, int corner, ExtraordinaryRule rule, int depth) {
  switch (rule) {
    case ExtraordinaryRule::g1: return biquartic_element(ring, corner);
    case ExtraordinaryRule::catmull_clark: return subdivided_element(ring, corner, depth);
  }
  throw std::logic_error("no rule for extraordinary points has the number " + std::to_string(static_cast<int>(rule)));
}

int log2_of(int power) { return std::countr_zero(unsigned(power)); }

/// Bezier elements in the order of the mesh elements (tiles) that they represent. The Bezier elements of tile t begin at first[t].
struct TileElements {
  std::vector<Element> all;
  std::vector<int> first;

  bool one(int tile) const { return first[tile + 1] - first[tile] == 1; }
};

/// Returns the Bezier elements of all mesh elements. Elements at extraordinary points are complete. Regular elements have only their positions, not
/// yet their functions.
TileElements laid_out(const TMesh& mesh, const TileFunctions& b, ExtraordinaryRule rule) {
  const Lattice& l = *mesh.lattice;
  const std::vector<int> point = control_points(mesh);
  const int tiles = int(b.tiling.tiles.size());
  // At an extraordinary point, catmull_clark_pieces() represents a small square by one bicubic that only approximates the limit surface. The side of
  // this square is 2^-max(levels, 4) times the element size of the initial mesh. The side does not change if the mesh is refined, so the spaces
  // before and after a refinement are nested.
  const int levels = log2_of(l.base), below_unit = std::max(levels, 4) - levels;
  // Key: the corner of a mesh element that is the extraordinary point, and the width of the element. Value: the Bezier elements that represent the
  // mesh element, with OneRing indices as control points.
  std::map<std::pair<int, int>, std::vector<Element>> patterns;
  std::array<int, OneRing::size> numbers;
  std::iota(numbers.begin(), numbers.end(), 0);
  TileElements out;
  out.all.reserve(tiles);
  for (int t = 0; t < tiles; ++t) {
    const Rectangle& r = b.tiling.tiles[t];
    out.first.push_back(int(out.all.size()));
    if (b.irregular[t] < 0) {
      out.all.emplace_back();
    } else {
      const auto ring = ring_of(l, b, point, t);
      auto& pattern = patterns[{b.irregular[t], r.width}];
      if (pattern.empty()) pattern = around_point(numbers, b.irregular[t], rule, below_unit + log2_of(r.width));
      for (Element e : pattern) {
        for (int& p : e.points) p = ring[p];
        out.all.push_back(std::move(e));
      }
    }
    for (std::size_t k = out.first[t]; k < out.all.size(); ++k) {
      Element& e = out.all[k];
      e.face = r.face;
      e.origin = {(r.x + e.origin[0] * r.width) / l.units, (r.y + e.origin[1] * r.height) / l.units};
      e.size = {e.size[0] * r.width / l.units, e.size[1] * r.height / l.units};
    }
  }
  out.first.push_back(int(out.all.size()));
  return out;
}

/// Converts points given by mesh element (tile) and local coordinates to local coordinates on all Bezier elements whose closure contains them.
std::vector<Site> on_elements(const Lattice& l, const Tiling& tiling, const TileElements& elements, const std::vector<Site>& on_tiles) {
  std::vector<Site> found;
  for (const Site& site : on_tiles) {
    const int first = elements.first[site.element];
    if (elements.one(site.element)) {
      found.push_back({first, site.s, site.t});
      continue;
    }
    const Rectangle& r = tiling.tiles[site.element];
    const double x = (r.x + site.s * r.width) / l.units, y = (r.y + site.t * r.height) / l.units, margin = 1e-9;
    for (int k = first; k < elements.first[site.element + 1]; ++k) {
      const Element& e = elements.all[k];
      const double s = (x - e.origin[0]) / e.size[0], t = (y - e.origin[1]) / e.size[1];
      if (std::min(s, t) > -margin && std::max(s, t) < 1 + margin) found.push_back({k, std::clamp(s, 0.0, 1.0), std::clamp(t, 0.0, 1.0)});
    }
  }
  return found;
}

}  // namespace

Space space(const TMesh& mesh, ExtraordinaryRule rule) {
  const Lattice& l = *mesh.lattice;
  const TileFunctions b = tile_functions(mesh);
  TileElements elements = laid_out(mesh, b, rule);
  std::vector<int> count(b.tiling.tiles.size(), 0);  // number of functions on each mesh element
  for (const Contribution& c : b.entries) ++count[c.tile];
  std::vector<std::shared_ptr<Eigen::MatrixXd>> extraction(count.size());
  for (std::size_t t = 0; t < count.size(); ++t)
    if (b.irregular[t] < 0) elements.all[elements.first[t]].extraction = extraction[t] = std::make_shared<Eigen::MatrixXd>(count[t], 16);
  for (const Contribution& c : b.entries) {
    std::vector<int>& points = elements.all[elements.first[c.tile]].points;
    extraction[c.tile]->row(Eigen::Index(points.size())) = Eigen::Map<const Eigen::Matrix<double, 1, 16>>(c.row.data());
    points.push_back(c.anchor);
  }
  Space out;
  out.n_points = int(b.anchor.size());
  for (int A = 0; A < out.n_points; ++A)
    out.collocation.push_back(on_elements(l, b.tiling, elements, tiles_around(mesh, b.tiling, greville(mesh, b.anchor[A], b.knots[A]))));
  out.elements = std::move(elements.all);
  out.description = std::to_string(out.elements.size()) + " Bezier elements on a cube, " + std::to_string(out.n_points) +
                    " control points, eight extraordinary points (" + extraordinary_rules[static_cast<std::size_t>(rule)] + ")";
  return out;
}

}  // namespace tanktread::spline
