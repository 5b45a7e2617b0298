#pragma once
// From control nets to the Bezier points of the elements, and back for what is dual to them, in the layouts that the hot loops work on.

#include <utility>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::surface {

/// All elements of one degree. `place` of an element is its position in `elements`.
struct Block {
  int degree = 3;
  std::vector<int> elements;
};

/// The elements grouped by degree: degrees ascending, elements ascending in each.
struct Blocks {
  std::vector<Block> blocks;
  std::vector<std::pair<int, int>> place;  ///< element -> (block, position in it)
};
Blocks blocks_by_degree(const spline::Space& space);

/// The extraction of a space as a map between control nets and Bezier points, made once a mesh and good for any number of nets.
/// Equal extraction matrices are kept once (a uniform mesh has one for nearly all elements), so they stay in the cache.
class BezierMap {
 public:
  explicit BezierMap(const spline::Space& space);

  int n_points() const { return n_points_; }
  int n_elements() const { return static_cast<int>(elements_.size()); }
  int degree(int element) const { return elements_[element].degree; }
  int n_bezier(int element) const { return (degree(element) + 1) * (degree(element) + 1); }
  const Blocks& blocks() const { return blocks_; }

  /// Bezier points of one element, `out` of shape (3, n_b): all of x1, then x2, then x3.
  void points(int element, const Net& net, double* out) const;

  /// The same for the n_e elements of a block: column c n_e + k holds component c of element k, shape ((p+1)^2, 3 n_e), column-major, so that
  /// (Bernstein table) * (this) gives one contiguous array a component over all nodes of all elements. `out` is resized only if it has another shape.
  void points(const Block& block, const Net& net, Eigen::MatrixXd& out) const;

  /// The transpose of `points`: net_A += sum_b extraction(A, b) in_b, with `in` of shape (3, n_b). Turns derivatives with respect to
  /// Bezier points into derivatives with respect to control points.
  void add_transposed(int element, const double* in, Net& net) const;

 private:
  struct Operator {
    int m, n_b;
    std::vector<double> by_function, by_bezier;  ///< the matrix with the Bezier index, with the function index running fastest
  };
  struct Element {
    int degree, first, operation;  ///< degree, start in `points_`, position in `operators_`
  };
  int n_points_;
  Blocks blocks_;
  std::vector<Element> elements_;
  std::vector<int> points_;
  std::vector<Operator> operators_;
};

}  // namespace tanktread::surface
