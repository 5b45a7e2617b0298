#include "surface/clearance.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>

#include "spline/bernstein.hpp"

namespace tanktread::surface {

namespace {

/// Part [s, s + size] x [t, t + size] of an element, no point of which is nearer to the outline than `bound`.
struct Piece {
  int element;
  double s, t, size, bound;
  bool operator<(const Piece& other) const { return bound > other.bound; }  // the first of a queue is the nearest
};

class Search {
 public:
  Search(const Patches& surface, const Outline& outline)
      : surface_(surface), outline_(outline), convex_(outline.convex()), inner_(outline.distance(outline.centroid())) {
    best_.gap = std::numeric_limits<double>::infinity();
  }

  Clearance nearest() {
    std::priority_queue<Piece> pieces;
    for (int e = 0; e < surface_.size(); ++e) pieces.push(bounded({e, 0, 0, 1, 0}));
    while (!pieces.empty() && near(pieces.top())) {
      const Piece piece = pieces.top();
      pieces.pop();
      if (piece.size <= smallest) {
        descend(piece);
        continue;
      }
      const double half = piece.size / 2;
      for (const double s : {piece.s, piece.s + half})
        for (const double t : {piece.t, piece.t + half})
          if (const Piece part = bounded({piece.element, s, t, half, 0}); near(part)) pieces.push(part);
    }
    return best_;
  }

 private:
  static constexpr double smallest = 0.25;

  bool near(const Piece& piece) const { return piece.bound < best_.gap - 1e-9 * outline_.radius(); }

  /// With the bound that follows from the Bezier points of the piece, in whose hull it lies: the distance changes no faster than the place does,
  /// and it is concave inside a convex outline.
  Piece bounded(Piece piece) const {
    const Eigen::Matrix2Xd hull = points(piece);
    piece.bound = inner_ - (hull.colwise() - outline_.centroid()).colwise().norm().maxCoeff();
    if (!near(piece)) return piece;
    double closer = std::numeric_limits<double>::infinity();
    if (convex_) {
      for (Eigen::Index i = 0; i < hull.cols(); ++i) closer = std::min(closer, outline_.distance(hull.col(i)));
    } else {
      const Vec2 middle = hull.rowwise().mean();
      closer = outline_.distance(middle) - (hull.colwise() - middle).colwise().norm().maxCoeff();
    }
    piece.bound = std::max(piece.bound, closer);
    return piece;
  }

  /// x2 and x3 of the Bezier points of a piece.
  Eigen::Matrix2Xd points(const Piece& piece) const {
    const Patch& patch = surface_[piece.element];
    const int m = patch.degree + 1;
    const Eigen::MatrixXd in_s = spline::restriction(patch.degree, piece.s, piece.s + piece.size),
                          in_t = spline::restriction(patch.degree, piece.t, piece.t + piece.size);
    Eigen::Matrix2Xd result(2, m * m);
    for (const int c : {0, 1}) {
      const Eigen::Map<const Eigen::MatrixXd> net(patch.points + (c + 1) * m * m, m, m);  // s fastest
      const Eigen::MatrixXd part = in_s * net * in_t.transpose();
      result.row(c) = Eigen::Map<const Eigen::RowVectorXd>(part.data(), part.size());
    }
    return result;
  }

  Clearance at(int element, double s, double t) const {
    const Vec3 x = place(surface_[element], s, t);
    return {x, outline_.distance({x[1], x[2]})};
  }

  /// Downhill from the middle of a piece by steps along the grid and across it, halved where none leads on.
  void descend(const Piece& piece) {
    double s = piece.s + piece.size / 2, t = piece.t + piece.size / 2;
    Clearance lowest = at(piece.element, s, t);
    for (double step = piece.size / 2; step > 1e-5;) {
      const double from_s = s, from_t = t;
      for (const int a : {-1, 0, 1})
        for (const int b : {-1, 0, 1}) {
          const double trial_s = std::clamp(from_s + a * step, piece.s, piece.s + piece.size),
                       trial_t = std::clamp(from_t + b * step, piece.t, piece.t + piece.size);
          if (const Clearance there = at(piece.element, trial_s, trial_t); there.gap < lowest.gap) lowest = there, s = trial_s, t = trial_t;
        }
      if (s == from_s && t == from_t) step /= 2;
    }
    if (lowest.gap < best_.gap) best_ = lowest;
  }

  const Patches& surface_;
  const Outline& outline_;
  bool convex_;
  double inner_;  // distance of the outline's centroid
  Clearance best_;
};

}  // namespace

Clearance clearance(const Patches& surface, const Outline& outline) { return Search(surface, outline).nearest(); }

}  // namespace tanktread::surface
