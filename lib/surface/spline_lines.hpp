#pragma once
// Cubic splines in one variable, and surfaces that are tensor products of two of them.

#include <array>
#include <utility>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::surface {

/// Cubic splines in one variable. Lists the intervals between knots (pieces) with their four functions, and for each collocation point all pieces
/// that contain it.
struct Line {
  struct Piece {
    std::array<int, 4> functions;
    Eigen::Matrix4d extraction;  ///< extraction matrix, one row per function and one column per Bernstein polynomial
  };
  int n = 0;
  std::vector<Piece> pieces;
  std::vector<std::vector<std::pair<int, double>>> sites;

  /// Adds a collocation point at the parameter u, which is in the range of `knots`. The intervals between these knots are the pieces with the indices
  /// `first`, `first` + 1, .... If `closed`, the first and the last knot are the same point of the closed line.
  void add_site(double u, const std::vector<double>& knots, int first, bool closed);
};

/// Adds the splines with the given knots to `line`. If `closed`, they are periodic, and the middle knot of function i is knots[i]. Otherwise the end
/// knots have multiplicity four. If `inwards`, the collocation points at the two ends are moved halfway to their neighbours.
void add(Line& line, const std::vector<double>& knots, bool closed, bool inwards);

/// Splines over one period: open splines for the geometry, and periodic splines for densities. `open` has the open splines and the collocation points
/// of the periodic splines. `open_from_periodic` maps the coefficients of a density, one per periodic spline, to its control values on `open`.
struct RepeatingLine {
  Line open;
  Eigen::MatrixXd open_from_periodic;
  std::vector<double> middles;  ///< middle of each periodic element, as a local coordinate on the piece of `open` with the same index
};

/// Returns the splines over the period from `ends[0]` to `ends[1]`. `knots`: knots of the periodic splines, all between the ends. The two ends are
/// the same point of the period, the seam. The seam divides the periodic element that reaches from the last knot to the first knot of the next
/// period. The part of this element before the seam is the last piece of `open`, and the part after the seam is piece 0.
RepeatingLine repeating(const std::vector<double>& knots, const std::array<double, 2>& ends);

/// Returns the collocation points of the tensor product of two lines; the index on the line `around` runs fastest.
std::vector<std::vector<spline::Site>> sites_of(const Line& along, const Line& around);

/// Returns the Kronecker product a x b, without entries that are zero up to round-off.
Eigen::SparseMatrix<double> kronecker(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Returns the tensor-product space of two lines: s runs along the line `along`, t along the line `around`. Control point i n + k belongs to function
/// i of `along` and function k of `around`, where n is the number of functions of `around`.
spline::Space product(const Line& along, const Line& around);

}  // namespace tanktread::surface
