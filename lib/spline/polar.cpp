#include "spline/polar.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <stdexcept>

#include <Eigen/LU>

#include "base/types.hpp"
#include "spline/tile_functions.hpp"

namespace tanktread::spline {
namespace {

std::logic_error unknown_rule(PoleRule rule) {
  return std::logic_error("no rule for poles has the number " + std::to_string(static_cast<int>(rule)));
}

/// Returns the blossom (polar form), at three knots (lattice units), of a periodic cubic spline on the initial mesh. The coefficients of the spline
/// are the cosines (or sines) of the azimuths of the mesh vertices.
double blossom_of_circle(const Lattice& l, const std::array<double, 3>& knots, bool sine) {
  const int m = l.units / l.base, span = int(std::floor(knots[1] / l.base));
  double d[4];
  for (int i = 0; i < 4; ++i) {
    const double angle = 2 * std::numbers::pi * (span - 1 + i) / m;
    d[i] = sine ? std::sin(angle) : std::cos(angle);
  }
  for (int r = 1; r <= 3; ++r)
    for (int i = 3; i >= r; --i) {
      const double x = (knots[r - 1] / l.base - (span - 3 + i)) / (4 - r);
      d[i] = (1 - x) * d[i - 1] + x * d[i];
    }
  return d[3];
}

/// A control point of the tensor-product net near a pole: its anchor (lattice vertex) and its position in the tangent plane at the pole. The unit
/// of length is the height of the first element of the initial mesh.
struct PolePoint {
  int anchor;
  bool is_pole;
  Eigen::Vector2d place;
};

/// Returns the indices of three of the points p around the origin that form a large triangle: its area cannot be increased by exchanging one point.
std::array<int, 3> largest_triangle(const std::vector<Eigen::Vector2d>& p) {
  constexpr double clearly = 1e-9;
  std::array<int, 3> best{0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    const double angle = 2 * std::numbers::pi * k / 3;
    const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
    for (int i = 0; i < int(p.size()); ++i)
      if (way.dot(p[i]) > way.dot(p[best[k]]) + clearly) best[k] = i;
  }
  const auto area = [&](const std::array<int, 3>& t) {
    const Eigen::Vector2d a = p[t[1]] - p[t[0]], b = p[t[2]] - p[t[0]];
    return std::abs(a[0] * b[1] - a[1] * b[0]);
  };
  double largest = area(best);
  const auto exchange = [&](int corner) {
    bool any = false;
    for (int i = 0; i < int(p.size()); ++i) {
      auto other = best;
      other[corner] = i;
      if (const double size = area(other); size > largest * (1 + clearly)) best = other, largest = size, any = true;
    }
    return any;
  };
  while (exchange(0) || exchange(1) || exchange(2)) {
  }
  return best;
}

/// Returns the corners of the triangle whose sides have the midpoints `middle`. Corner k is opposite to midpoint k.
std::array<Eigen::Vector2d, 3> around(const std::array<Eigen::Vector2d, 3>& middle) {
  const Eigen::Vector2d sum = middle[0] + middle[1] + middle[2];
  return {sum - 2 * middle[0], sum - 2 * middle[1], sum - 2 * middle[2]};
}

/// Weight with which the spline function of an anchor (vertex of the tensor-product net) contributes to the basis function of the control point
/// `point`.
struct Share {
  int point;
  double weight;
};
class Shares {
 public:
  Shares(const TMesh& mesh, const TileFunctions& f, PoleRule poles) : per_pole_(properties(poles).points), shares_(f.anchor.size()) {
    const Lattice& l = *mesh.lattice;
    const int replaced = properties(poles).rows_replaced;
    auto to_end = [&](int v) { return std::min(v / l.units, l.rows - v / l.units); };
    int next = per_pole_;
    for (std::size_t a = 0; a < f.anchor.size(); ++a)
      if (to_end(f.anchor[a]) >= replaced) shares_[a] = {{next++, 1.0}};
    n_points_ = next + per_pole_;
    std::vector<PolePoint> at_pole[2];
    for (std::size_t a = 0; a < f.anchor.size(); ++a) {
      const int v = f.anchor[a];
      if (to_end(v) >= replaced) continue;
      const bool behind = v / l.units < l.rows / 2;
      at_pole[!behind].push_back({int(a), to_end(v) == 0, to_end(v) == 0 ? Eigen::Vector2d(0, 0) : place(l, v, f.knots[a].reach, behind)});
    }
    for (int k : {0, 1}) sites_[k] = share(poles, at_pole[k], k == 0 ? 0 : next);
  }

  const std::vector<Share>& operator[](int anchor) const { return shares_[anchor]; }
  int n_points() const { return n_points_; }
  int per_pole() const { return per_pole_; }

  /// Returns where function k of a pole is collocated: the anchor (vertex with a control point) whose generalised Greville point is used, or -1 for
  /// the pole itself. `ahead`: true for the pole at the end of the meridian, false for the pole at its start.
  int site(bool ahead, int k) const { return sites_[ahead].at(k); }

 private:
  static Eigen::Vector2d place(const Lattice& l, int v, const int (&reach)[4][2], bool behind) {
    const int slot = behind ? 1 : 3;
    const double x = v % l.units, height = double(l.length(v, slot, reach[slot][0])) / l.base;
    const std::array<double, 3> knots{x - reach[2][0], x, x + reach[0][0]};
    return height * Eigen::Vector2d(blossom_of_circle(l, knots, false), blossom_of_circle(l, knots, true));
  }

  /// Sets the shares of the anchors at a pole in its control points, which start with the index `first`. Returns the collocation sites of these
  /// control points, as site() does.
  std::vector<int> share(PoleRule poles, const std::vector<PolePoint>& at_pole, int first) {
    switch (poles) {
      case PoleRule::bezier_transform:
      case PoleRule::plain:
        for (const PolePoint& p : at_pole) shares_[p.anchor] = {{first, 1.0}};
        return {-1};
      case PoleRule::c1: return share_among_three(at_pole, first);
    }
    throw unknown_rule(poles);
  }

  std::vector<int> share_among_three(const std::vector<PolePoint>& at_pole, int first) {
    std::vector<int> sites(3);
    std::vector<Eigen::Vector2d> places;
    for (const PolePoint& p : at_pole) places.push_back(p.place);
    const auto middles = largest_triangle(places);
    const auto corner = around({places[middles[0]], places[middles[1]], places[middles[2]]});
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) {
      corners.col(k) << 1, corner[k];
      const PolePoint& middle = at_pole[middles[(k + 1) % 3]];  // midpoint of a triangle side that ends at corner k
      sites[k] = middle.is_pole ? -1 : middle.anchor;
    }
    const Eigen::Matrix3d barycentric = corners.inverse();
    for (const PolePoint& p : at_pole)
      for (int k = 0; k < 3; ++k) shares_[p.anchor].push_back({first + k, barycentric.row(k).dot(Vec3(1, p.place[0], p.place[1]))});
    return sites;
  }

  int per_pole_, n_points_ = 0;
  std::vector<std::vector<Share>> shares_;
  std::array<std::vector<int>, 2> sites_;  // collocation sites of the per_pole_ control points of each pole, see site()
};

/// Returns knot i of the open uniform knots 0, 0, 0, 0, 1, .. r - 1, r, r, r, r.
double open_knot(int i, int r) { return std::clamp(i - 3, 0, r); }

/// Returns the permutation of Bezier points that turns an element with a side at a pole so that the pole is at u = 1, as PolePiece requires. Bezier
/// point 4 v + u of the turned element is point order[4 v + u] of the element. `ahead`: true if the pole is at the end of the meridian, false if it
/// is at the start.
std::array<int, 16> seen_from_base(bool ahead) {
  std::array<int, 16> order;
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 4; ++u) order[4 * v + u] = ahead ? 4 * u + 3 - v : 4 * (3 - u) + v;
  return order;
}

/// Replaces the degenerate elements at the poles by non-degenerate pieces, and converts sites (element and local coordinates) on these elements to
/// sites on the pieces.
class Transform {
 public:
  explicit Transform(int subdivisions) : pieces_(pole_pieces(subdivisions)) {}

  void add_pieces(const Element& e, bool ahead, std::vector<Element>& out) const {
    const auto order = seen_from_base(ahead);
    for (const PolePiece& piece : pieces_) {
      Eigen::MatrixXd turned(e.extraction->rows(), 16);
      for (int b = 0; b < 16; ++b) turned.col(b) = e.extraction->col(order[b]);
      turned = (turned * piece.conversion.transpose()).eval();
      Element part = e;
      part.points.clear();
      std::vector<Eigen::Index> used;
      for (Eigen::Index a = 0; a < turned.rows(); ++a)
        if (turned.row(a).cwiseAbs().maxCoeff() > 1e-13) used.push_back(a), part.points.push_back(e.points[a]);
      part.extraction = std::make_shared<const Eigen::MatrixXd>(turned(used, Eigen::all));
      part.size[0] /= double(pieces_.size());
      out.push_back(std::move(part));
    }
  }

  void add_sites(double s, double t, bool ahead, int first, std::vector<Site>& out) const {
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      if (const auto at = ahead ? pieces_[k].local(t, 1 - s) : pieces_[k].local(1 - t, s))
        out.push_back({first + int(k), (*at)[0], (*at)[1]});
  }

 private:
  std::vector<PolePiece> pieces_;
};

/// Returns the pole as one site (element and local coordinates) on every element that has a side collapsed to the pole. `ahead`: the pole at the end
/// of the meridian, otherwise the pole at its start.
std::vector<Site> tiles_at_pole(const Lattice& l, const Tiling& tiling, bool ahead) {
  std::vector<Site> out;
  for (int k = 0; k < int(tiling.tiles.size()); ++k) {
    const Rectangle& r = tiling.tiles[k];
    if (ahead ? r.y + r.height == l.rows - l.pad : r.y == l.pad) out.push_back({k, 0.5, ahead ? 1.0 : 0.0});
  }
  return out;
}

/// Returns the generalised Greville points of the control points, by mesh element (tile) and local coordinates.
std::vector<std::vector<Site>> sites_on_tiles(const TMesh& mesh, const TileFunctions& f, const Shares& shares) {
  const Lattice& l = *mesh.lattice;
  std::vector<std::vector<Site>> out(shares.n_points());
  for (std::size_t a = 0; a < f.anchor.size(); ++a)
    if (shares[int(a)].size() == 1 && shares[int(a)][0].point >= shares.per_pole() &&
        shares[int(a)][0].point < shares.n_points() - shares.per_pole())
      out[shares[int(a)][0].point] = tiles_around(mesh, f.tiling, greville(mesh, f.anchor[a], f.knots[a]));
  for (bool ahead : {false, true}) {
    const int first = ahead ? shares.n_points() - shares.per_pole() : 0;
    for (int k = 0; k < shares.per_pole(); ++k) {
      const int a = shares.site(ahead, k);
      out[first + k] = a < 0 ? tiles_at_pole(l, f.tiling, ahead) : tiles_around(mesh, f.tiling, greville(mesh, f.anchor[a], f.knots[a]));
    }
  }
  return out;
}

/// Returns the Bezier elements of the mesh elements (tiles) with all their functions.
std::vector<Element> tile_elements(const Lattice& l, const TileFunctions& f, const Shares& shares) {
  std::vector<Element> out(f.tiling.tiles.size());
  std::vector<std::map<int, Eigen::Matrix<double, 1, 16>>> functions(out.size());
  for (const Contribution& c : f.entries)
    for (const Share& share : shares[c.anchor])
      functions[c.tile].try_emplace(share.point, Eigen::Matrix<double, 1, 16>::Zero()).first->second +=
          share.weight * Eigen::Map<const Eigen::Matrix<double, 1, 16>>(c.row.data());
  const double height = l.height(l.rows);
  for (std::size_t t = 0; t < out.size(); ++t) {
    const Rectangle& r = f.tiling.tiles[t];
    Element& e = out[t];
    Eigen::MatrixXd extraction(functions[t].size(), 16);
    for (const auto& [point, row] : functions[t]) {
      extraction.row(Eigen::Index(e.points.size())) = row;
      e.points.push_back(point);
    }
    e.extraction = std::make_shared<const Eigen::MatrixXd>(std::move(extraction));
    e.origin = {double(r.x) / l.units, l.height(r.y) / height};
    e.size = {double(r.width) / l.units, r.height / height};
  }
  return out;
}

}  // namespace

PoleProperties properties(PoleRule rule) {
  switch (rule) {
    case PoleRule::bezier_transform:
      return {.name = "poles by Bezier transform", .points = 1, .rows_replaced = 1, .has_normal = true, .replaces_elements = true};
    case PoleRule::plain: return {.name = "plain poles", .points = 1, .rows_replaced = 1, .has_normal = false, .replaces_elements = false};
    case PoleRule::c1: return {.name = "C1 poles", .points = 3, .rows_replaced = 2, .has_normal = true, .replaces_elements = false};
  }
  throw unknown_rule(rule);
}

std::vector<PolarAnchor> polar_anchors(const PolarMesh& mesh) {
  const int m = mesh.azimuthal, r = mesh.meridional, replaced = properties(mesh.poles).rows_replaced;
  std::vector<PolarAnchor> out;
  const auto three = [&](double row) {
    std::vector<Eigen::Vector2d> place;
    for (int k = 0; k < m; ++k) place.emplace_back(std::cos(2 * std::numbers::pi * k / m), std::sin(2 * std::numbers::pi * k / m));
    const auto middles = largest_triangle(place);
    for (const Eigen::Vector2d& corner : around({place[middles[0]], place[middles[1]], place[middles[2]]}))
      out.push_back({row, std::atan2(corner[1], corner[0]) * m / (2 * std::numbers::pi), corner.norm()});
  };
  const auto pole = [&](double u, double row) {
    switch (mesh.poles) {
      case PoleRule::bezier_transform:
      case PoleRule::plain: return out.push_back({u, 0, 1});
      case PoleRule::c1: return three(row);
    }
    throw unknown_rule(mesh.poles);
  };
  pole(0, 1.0 / 3);
  for (int row = replaced; row <= r + 2 - replaced; ++row) {
    const double u = (open_knot(row + 1, r) + open_knot(row + 2, r) + open_knot(row + 3, r)) / 3;
    for (int k = 0; k < m; ++k) out.push_back({u, double(k), 1});
  }
  pole(r, r - 1.0 / 3);
  return out;
}

Space space(const PolarMesh& mesh) { return space(polar(mesh.azimuthal, mesh.meridional), mesh.poles, mesh.subdivisions); }

Space space(const TMesh& mesh, PoleRule poles, int subdivisions) {
  const Lattice& l = *mesh.lattice;
  const TileFunctions f = tile_functions(mesh);
  const Shares shares(mesh, f, poles);
  Space out;
  out.n_points = shares.n_points();
  out.elements = tile_elements(l, f, shares);
  out.collocation = sites_on_tiles(mesh, f, shares);
  const PoleProperties rule = properties(poles);
  if (rule.replaces_elements) {
    const Transform transform(subdivisions);
    std::vector<Element> kept, pieces;
    // for each element k: its index after the replacement, or -1 - j if it is replaced by pieces that begin at pieces[j]
    std::vector<int> place(out.elements.size());
    std::vector<bool> at_end(out.elements.size());
    for (std::size_t t = 0; t < out.elements.size(); ++t) {
      const Rectangle& r = f.tiling.tiles[t];
      const bool behind = r.y == l.pad, ahead = r.y + r.height == l.rows - l.pad;
      at_end[t] = ahead;
      place[t] = behind || ahead ? -1 - int(pieces.size()) : int(kept.size());
      if (behind || ahead)
        transform.add_pieces(out.elements[t], ahead, pieces);
      else
        kept.push_back(std::move(out.elements[t]));
    }
    const int regular = int(kept.size());
    out.elements = std::move(kept);
    std::move(pieces.begin(), pieces.end(), std::back_inserter(out.elements));
    for (auto& sites : out.collocation) {
      std::vector<Site> found;
      for (const Site& s : sites) {
        if (place[s.element] >= 0)
          found.push_back({place[s.element], s.s, s.t});
        else
          transform.add_sites(s.s, s.t, at_end[s.element], regular - 1 - place[s.element], found);
      }
      sites = std::move(found);
    }
  }
  for (auto& sites : out.collocation)
    std::sort(sites.begin(), sites.end(), [](const Site& x, const Site& y) { return x.element < y.element; });
  out.description = std::to_string(out.elements.size()) + " Bezier elements, base mesh " + std::to_string(l.units / l.base) +
                    " around and " + std::to_string(l.height(l.rows) / l.base) + " from pole to pole, " + std::to_string(out.n_points) +
                    " control points, " + rule.name;
  if (rule.replaces_elements) out.description += " (" + std::to_string(1 << subdivisions) + " cuts)";
  return out;
}

}  // namespace tanktread::spline
