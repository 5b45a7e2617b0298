#pragma once
// Elements of one space inside elements of another, and least squares on their Bezier points.

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "base/types.hpp"
#include "spline/bernstein.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

/// Bezier points of a field on an element, row (p + 1) j + i; without allocation.
using BezierPoints = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, (max_degree + 1) * (max_degree + 1), 3>;
BezierPoints bezier_points(const Element& e, const Net& field);

/// How an element of one space lies in an element of another.
struct Embedding {
  int around = 0;          ///< that element
  bool whole = false;      ///< the two have place and degree in common
  bool straddles = false;  ///< it sticks out of it
  Eigen::MatrixXd s, t;    ///< restriction (and elevation) along s and t of the Bezier points of the one around; empty if whole
  Eigen::MatrixXd raised;  ///< elevation of the element's own Bezier points where the one around has the higher degree; empty otherwise
};
/// Of every element of `to` in the element of `from` that holds its centre.
std::vector<Embedding> embeddings(const Space& from, const Space& to);

/// Bezier points of a field of `from` on the element of an embedding, of the higher of the two degrees.
BezierPoints restricted(const Space& from, const Embedding& embedding, const Net& field);
/// The element's own, of the same degree.
BezierPoints own_points(const Element& e, const Embedding& embedding, const Net& field);

/// Control values P of some points of `to` that minimise, the other ones given,
///
///   sum_e |C_e^T P - Q_e|^2,   Q_e: the field of `from` restricted to element e of `to` by de Casteljau.
///
/// One sparse Cholesky factorisation serves all fields. Spaces and embeddings must outlive it.
class BezierFit {
 public:
  BezierFit(const Space& from, const Space& to, const std::vector<Embedding>& embedding, const std::vector<int>& unknown);
  ~BezierFit();

  /// Fills in the rows of the unknown points.
  void solve(const Net& field, Net& net) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tanktread::spline
