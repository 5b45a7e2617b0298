#include "spline/polar.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "spline/knots.hpp"
#include "spline/pole_transform.hpp"

namespace tanktread::spline {
namespace {

/// Tensor rows 0 .. r + 2 of m functions each, and which control points they stand for.
class Rows {
 public:
  explicit Rows(const PolarMesh& mesh) : mesh_(mesh), replaced_(mesh.poles == PoleRule::c1 ? 2 : 1) {}

  int per_pole() const { return replaced_ == 2 ? 3 : 1; }
  int kept() const { return mesh_.meridional + 3 - 2 * replaced_; }
  int n_points() const { return kept() * mesh_.azimuthal + 2 * per_pole(); }

  /// Calls use(point, weight) for the control points in whose functions N_{row, k} appears.
  template <class Use>
  void each(int row, int k, const Use& use) const {
    const int m = mesh_.azimuthal, from_end = mesh_.meridional + 2 - row;
    if (std::min(row, from_end) >= replaced_) return use(per_pole() + (row - replaced_) * m + (k + m) % m, 1.0);
    const int pole = row < from_end ? 0 : per_pole() + kept() * m;
    if (replaced_ == 1) return use(pole, 1.0);
    for (int l = 0; l < 3; ++l) {
      const double angle = 2 * std::numbers::pi * (double(k) / m - l / 3.0);
      use(pole + l, (std::min(row, from_end) == 0 ? 1 : 1 + std::cos(angle)) / 3);
    }
  }

 private:
  const PolarMesh& mesh_;
  int replaced_;  // rows at either end
};

/// Knot i of the open uniform knots 0, 0, 0, 0, 1, .. r - 1, r, r, r, r.
double open_knot(int i, int r) { return std::clamp(i - 3, 0, r); }

Element tensor_element(const PolarMesh& mesh, const Rows& rows, int i, int j) {
  const int m = mesh.azimuthal, r = mesh.meridional;
  std::map<int, Eigen::Matrix<double, 1, 16>> functions;
  for (int row = j; row < j + 4; ++row) {
    std::array<double, 5> knots;
    for (int k = 0; k < 5; ++k) knots[k] = open_knot(row + k, r);
    const auto along = b_spline_on(knots, j, j + 1);
    for (int k = i - 1; k <= i + 2; ++k) {
      const double at = k;
      const auto around = b_spline_on({at - 2, at - 1, at, at + 1, at + 2}, i, i + 1);
      rows.each(row, k, [&](int point, double weight) {
        auto& function = functions.try_emplace(point, Eigen::Matrix<double, 1, 16>::Zero()).first->second;
        for (int b = 0; b < 16; ++b) function[b] += weight * around[b % 4] * along[b / 4];
      });
    }
  }
  Element e;
  e.extraction.resize(Eigen::Index(functions.size()), 16);
  for (const auto& [point, function] : functions) {
    e.extraction.row(Eigen::Index(e.points.size())) = function;
    e.points.push_back(point);
  }
  e.origin = {double(i) / m, double(j) / r};
  e.size = {1.0 / m, 1.0 / r};
  return e;
}

/// Bezier points in the order of the transform, with the pole at u = 1, from those of the element: Q_(v u) = element[order[4 v + u]].
std::array<int, 16> seen_from_base(bool ahead) {
  std::array<int, 16> order;
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 4; ++u) order[4 * v + u] = ahead ? 4 * u + 3 - v : 4 * (3 - u) + v;
  return order;
}

/// Replaces the elements at the poles by pieces and the sites on them by sites on the pieces.
class Transform {
 public:
  explicit Transform(const PolarMesh& mesh) : pieces_(pole_pieces(mesh.subdivisions)) {}

  void add_pieces(const Element& e, bool ahead, std::vector<Element>& out) const {
    const auto order = seen_from_base(ahead);
    for (const PolePiece& piece : pieces_) {
      Eigen::MatrixXd turned(e.extraction.rows(), 16);
      for (int b = 0; b < 16; ++b) turned.col(b) = e.extraction.col(order[b]);
      turned = (turned * piece.conversion.transpose()).eval();
      Element part = e;
      part.points.clear();
      std::vector<Eigen::Index> used;
      for (Eigen::Index a = 0; a < turned.rows(); ++a)
        if (turned.row(a).cwiseAbs().maxCoeff() > 1e-13) used.push_back(a), part.points.push_back(e.points[a]);
      part.extraction = turned(used, Eigen::all);
      part.size[0] /= double(pieces_.size());
      out.push_back(std::move(part));
    }
  }

  void add_sites(double s, double t, bool ahead, int first, std::vector<Site>& out) const {
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      if (const auto at = ahead ? pieces_[k].local(t, 1 - s) : pieces_[k].local(1 - t, s))
        out.push_back({first + int(k), (*at)[0], (*at)[1]});
  }

  int size() const { return int(pieces_.size()); }

 private:
  std::vector<PolePiece> pieces_;
};

/// Elements i, j of the tensor grid whose closure holds a place.
struct GridSite {
  int i, j;
  double s, t;
};
std::vector<GridSite> grid_sites(const PolarMesh& mesh, const PolarAnchor& at) {
  const int m = mesh.azimuthal, r = mesh.meridional;
  std::vector<GridSite> out;
  if (at.u == 0 || at.u == r) {
    for (int i = 0; i < m; ++i) out.push_back({i, at.u == 0 ? 0 : r - 1, 0.5, at.u == 0 ? 0.0 : 1.0});
    return out;
  }
  const int i = int(at.v), j = int(at.u);
  for (int y = at.u == j ? j - 1 : j; y <= j; ++y)
    for (int x = at.v == i ? i - 1 : i; x <= i; ++x) out.push_back({(x + m) % m, y, at.v - x, at.u - y});
  return out;
}

const char* name(PoleRule rule) {
  return rule == PoleRule::plain ? "plain poles" : rule == PoleRule::c1 ? "C1 poles" : "poles by Bezier transform";
}

}  // namespace

std::vector<PolarAnchor> anchors(const PolarMesh& mesh) {
  const int m = mesh.azimuthal, r = mesh.meridional;
  const bool c1 = mesh.poles == PoleRule::c1;
  std::vector<PolarAnchor> out;
  const auto pole = [&](double u) {
    if (!c1) return out.push_back({u, 0});
    for (int l = 0; l < 3; ++l) out.push_back({u == 0 ? c1_site : r - c1_site, l * m / 3.0});
  };
  pole(0);
  for (int row = c1 ? 2 : 1; row <= r + (c1 ? 0 : 1); ++row) {
    const double u = (open_knot(row + 1, r) + open_knot(row + 2, r) + open_knot(row + 3, r)) / 3;
    for (int k = 0; k < m; ++k) out.push_back({u, double(k)});
  }
  pole(r);
  return out;
}

Space space(const PolarMesh& mesh) {
  const int m = mesh.azimuthal, r = mesh.meridional;
  const Rows rows(mesh);
  Space out;
  out.n_points = rows.n_points();
  std::vector<Element> at_poles;
  const bool transformed = mesh.poles == PoleRule::bezier_transform;
  for (int j = 0; j < r; ++j)
    for (int i = 0; i < m; ++i) {
      const bool at_pole = j == 0 || j == r - 1;
      (transformed && at_pole ? at_poles : out.elements).push_back(tensor_element(mesh, rows, i, j));
    }
  const int regular = int(out.elements.size());

  const Transform transform(mesh);
  for (std::size_t k = 0; k < at_poles.size(); ++k) transform.add_pieces(at_poles[k], int(k) >= m, out.elements);
  for (const PolarAnchor& anchor : anchors(mesh)) {
    std::vector<Site> sites;
    for (const auto& [i, j, s, t] : grid_sites(mesh, anchor)) {
      if (!transformed)
        sites.push_back({j * m + i, s, t});
      else if (j > 0 && j < r - 1)
        sites.push_back({(j - 1) * m + i, s, t});
      else
        transform.add_sites(s, t, j > 0, regular + (j > 0 ? m + i : i) * transform.size(), sites);
    }
    std::sort(sites.begin(), sites.end(), [](const Site& x, const Site& y) { return x.element < y.element; });
    out.collocation.push_back(std::move(sites));
  }
  out.description = std::to_string(out.elements.size()) + " Bezier elements, " + std::to_string(m) + " around and " + std::to_string(r) +
                    " from pole to pole, " + std::to_string(out.n_points) + " control points, " + name(mesh.poles);
  if (transformed) out.description += " (" + std::to_string(1 << mesh.subdivisions) + " cuts)";
  return out;
}

}  // namespace tanktread::spline
