#include "surface/clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "spline/bernstein.hpp"

namespace tanktread::surface {

namespace {

constexpr std::array coordinates{0, 1, 2};

/// Disc that gives a lower bound of the distance from a piece of the surface to the outline. For every point of the piece, the nearest point of the
/// outline is outside the disc. If the distance of the point from `centre` is d, its distance from the outline is therefore at least radius - d.
/// gap(d^2) returns this bound.
struct Disc {
  Vec2 centre;
  double radius;
  double gap(double squared_distance) const { return radius - std::sqrt(std::max(squared_distance, 0.)); }
};

/// Returns a disc that gives the lower bound (see Disc) for every piece of the surface within the distance r of x. The disc touches the outline at
/// `foot`, the point of the outline nearest to x. Its curvature is at least the curvature of the outline at `foot`. If a point of the outline would
/// lie inside the disc, the radius is reduced such that the circle passes through this point.
Disc touching(const Outline& outline, const Vec2& x, const Nearest& foot, double r, double tolerance) {
  if (foot.distance < tolerance) return {foot.x, 0};
  const PlaneJet at = outline.at(foot.side, foot.u);
  const double curvature = (at.d[0] * at.dd[1] - at.d[1] * at.dd[0]) / std::pow(at.d.norm(), 3);
  const Vec2 inward = (x - foot.x) / foot.distance;
  double radius = 1 / std::max(curvature, 1e-3 / outline.radius());
  for (int trial = 0; trial < 20 && radius > 0; ++trial) {
    const Vec2 centre = foot.x + radius * inward;
    const Nearest reached = outline.nearest_around(x, foot, r, centre);
    if (reached.distance > radius - tolerance) return {centre, reached.distance};
    const Vec2 chord = reached.x - foot.x;
    radius = std::min(radius, chord.squaredNorm() / (2 * chord.dot(inward)));
  }
  return {foot.x, 0};
}

/// Part (piece) of a surface element, given by its Bezier points.
struct ElementPart {
  std::array<Eigen::MatrixXd, 3> points;  // one matrix per coordinate
  Disc disc{Vec2::Zero(), 0};
  double bound = -std::numeric_limits<double>::infinity();  // lower bound of the distance of the piece from the outline
  Vec3 corner = Vec3::Zero();                               // corner of the piece farthest from the centre of `disc`
  // direction in which the piece is bisected, the one in which it is more curved. true: along the column index of `points`, false: along the row
  // index
  bool bends_across = false;

  /// Returns an upper bound of the distance from x to the points of the piece, in the plane x2 x3.
  double reach(const Vec2& x) const {
    return std::sqrt(((points[1].array() - x[0]).square() + (points[2].array() - x[1]).square()).maxCoeff());
  }
};

/// Returns the factors c(i, k) with B_i B_k = c(i, k) B_{i+k}, where B_i and B_k are Bernstein polynomials of degree p and B_{i+k} is one of degree
/// 2p.
Eigen::MatrixXd products(Eigen::Index p) {
  const auto binomial = [](Eigen::Index n, Eigen::Index k) {
    double value = 1;
    for (Eigen::Index i = 1; i <= k; ++i) value = value * static_cast<double>(n - k + i) / static_cast<double>(i);
    return value;
  };
  return Eigen::MatrixXd::NullaryExpr(
      p + 1, p + 1, [&](Eigen::Index i, Eigen::Index k) { return binomial(p, i) * binomial(p, k) / binomial(2 * p, i + k); });
}

/// Branch-and-bound search for the point of the surface nearest to the outline: bisects the piece of the surface with the smallest lower bound of
/// the distance, until no piece can be nearer than the best point found.
class OutlineSearch {
 public:
  OutlineSearch(const Patches& surface, const Outline& outline) : surface_(surface), outline_(outline) {}

  Clearance nearest() {
    begin();
    while (!pieces_.empty() && near(pieces_.front().bound)) {
      std::ranges::pop_heap(pieces_, std::ranges::greater(), &ElementPart::bound);
      ElementPart piece = std::move(pieces_.back());
      pieces_.pop_back();
      look_at_corner(piece);
      if (near(piece.bound))
        for (const int k : {0, 1}) add(half(piece, k));
    }
    return best_;
  }

 private:
  bool near(double gap) const { return gap < best_.gap - tolerance(); }
  double tolerance() const { return (best_.gap < 0 ? 1e-3 : 1e-8) * outline_.radius(); }

  /// Collects the elements that may contain the point nearest to the outline. Other elements are excluded by lower bounds of their distances,
  /// computed from the largest disc in the outline about the centroid of the outline.
  void begin() {
    const Disc central{outline_.centroid(), outline_.distance(outline_.centroid())};
    const auto squared = [&](const Patch& patch, int b) {
      return (Vec2(patch.coordinate(1, b), patch.coordinate(2, b)) - central.centre).squaredNorm();
    };
    double farthest = -1;
    for (int e = 0; e < surface_.size(); ++e)
      if (const double there = squared(surface_[e], 0); there > farthest) {
        farthest = there;
        for (const int c : coordinates) best_.x[c] = surface_[e].coordinate(c, 0);
      }
    best_.gap = outline_.distance(best_.x.tail<2>());
    for (int e = 0; e < surface_.size(); ++e) {
      const Patch& patch = surface_[e];
      double reach = 0;
      for (int b = 0; b < patch.n_bezier(); ++b) reach = std::max(reach, squared(patch, b));
      if (!near(central.gap(reach))) continue;
      ElementPart element;
      element.disc = central;
      for (const int c : coordinates)
        element.points[c] = Eigen::Map<const Eigen::MatrixXd>(patch.points + c * patch.n_bezier(), patch.degree + 1, patch.degree + 1);
      add(std::move(element));
    }
  }

  void add(ElementPart piece) {
    ++best_.pieces;
    bound(piece);
    if (!near(piece.bound)) return;
    pieces_.push_back(std::move(piece));
    std::ranges::push_heap(pieces_, std::ranges::greater(), &ElementPart::bound);
  }

  ElementPart half(const ElementPart& piece, int k) const {
    ElementPart part;
    part.disc = piece.disc, part.bound = piece.bound;
    const Eigen::MatrixXd halving = spline::restriction(static_cast<int>(piece.points[0].rows()) - 1, 0.5 * k, 0.5 * (k + 1));
    for (const int c : coordinates)
      part.points[c] = piece.bends_across ? Eigen::MatrixXd(piece.points[c] * halving.transpose()) : Eigen::MatrixXd(halving * piece.points[c]);
    return part;
  }

  /// Computes the distance from a corner of the piece to the outline, and updates the smallest distance found. If the distance of the corner exceeds
  /// the lower bound that follows from the disc of the piece, fits a new disc to the piece to improve the bound.
  void look_at_corner(ElementPart& piece) {
    const Vec2 x = piece.corner.tail<2>();
    const double expected = piece.disc.gap((x - piece.disc.centre).squaredNorm());
    if (!near(expected)) return;
    const Nearest foot = outline_.nearest(x);
    if (foot.distance < best_.gap) best_.x = piece.corner, best_.gap = foot.distance;
    if (foot.distance < expected + tolerance() / 2) return;
    piece.disc = touching(outline_, x, foot, piece.reach(x), tolerance() / 4);
    bound(piece);
  }

  /// Sets three members of a piece: `bound`, the lower bound of its distance from the outline; `corner`, its corner farthest from the centre of the
  /// disc (see Disc) inside the outline that gives the bound; and `bends_across`, the direction in which the piece is bisected next. All three follow
  /// from the Bezier coefficients of the squared distance from the centre of the disc.
  void bound(ElementPart& piece) {
    const Eigen::Index m = piece.points[0].rows(), n = 2 * m - 1, last = n - 1;
    if (products_.rows() != m) products_ = products(m - 1);
    const Eigen::MatrixXd y = piece.points[1].array() - piece.disc.centre[0], z = piece.points[2].array() - piece.disc.centre[1];
    Eigen::MatrixXd q = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index j = 0; j < m; ++j)
      for (Eigen::Index l = 0; l < m; ++l)
        for (Eigen::Index i = 0; i < m; ++i)
          for (Eigen::Index k = 0; k < m; ++k) q(i + k, j + l) += products_(i, k) * products_(j, l) * (y(i, j) * y(k, l) + z(i, j) * z(k, l));
    piece.bound = std::max(piece.bound, piece.disc.gap(q.maxCoeff()));
    const auto bend = [](const auto& a, const auto& b, const auto& c) { return (a - 2 * b + c).cwiseAbs().maxCoeff(); };
    piece.bends_across = bend(q.leftCols(n - 2), q.middleCols(1, n - 2), q.rightCols(n - 2)) >
                         bend(q.topRows(n - 2), q.middleRows(1, n - 2), q.bottomRows(n - 2));
    double farthest = -1;
    for (const Eigen::Index i : {Eigen::Index(0), last})
      for (const Eigen::Index j : {Eigen::Index(0), last})
        if (q(i, j) > farthest) {
          farthest = q(i, j);
          for (const int c : coordinates) piece.corner[c] = piece.points[c](i / 2, j / 2);
        }
  }

  const Patches& surface_;
  const Outline& outline_;
  std::vector<ElementPart> pieces_;  // a heap
  Eigen::MatrixXd products_;   // result of products(p), factors of products of Bernstein polynomials, for the degree p used last
  Clearance best_;
};

}  // namespace

Clearance clearance(const Patches& surface, const Outline& outline) { return OutlineSearch(surface, outline).nearest(); }

}  // namespace tanktread::surface
