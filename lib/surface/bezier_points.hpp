#pragma once
// Maps between control nets and the Bezier points of the elements, and the fixed order in which sums over elements are computed.

#include <algorithm>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::surface {

/// Number of consecutive elements in a block. Sums are taken within each block, then over the blocks in order. Every block belongs to one rank as a
/// whole, so that sums do not depend on the number of ranks.
constexpr int block_size = 64;

inline int n_blocks(int n_elements) { return (n_elements + block_size - 1) / block_size; }

/// Returns the elements of the given blocks, in order. A block has block_size consecutive elements.
inline std::vector<int> elements_of(std::span<const int> blocks, int n_elements) {
  std::vector<int> elements;
  for (const int b : blocks)
    for (int e = block_size * b; e < std::min(block_size * (b + 1), n_elements); ++e) elements.push_back(e);
  return elements;
}

/// Returns the sum of the values in each block of elements, given one value per element.
inline std::vector<double> block_sums(std::span<const double> of_elements) {
  std::vector<double> sums(n_blocks(static_cast<int>(of_elements.size())), 0.);
  for (std::size_t e = 0; e < of_elements.size(); ++e) sums[e / block_size] += of_elements[e];
  return sums;
}

/// Indices of all elements of one degree, ascending.
struct DegreeGroup {
  int degree = 3;
  std::vector<int> elements;
};

/// Returns the elements grouped by degree, degrees ascending.
std::vector<DegreeGroup> groups_by_degree(const spline::Space& space);

/// The extraction of a space as a map between control nets and Bezier points. It is computed once per mesh and can be applied to any number of nets.
/// Equal extraction matrices are stored only once, so that they stay in the cache. Most elements of a uniform mesh, and the elements of equal
/// particles, have equal matrices.
class BezierMap {
 public:
  explicit BezierMap(const spline::Space& space);

  int n_points() const { return n_points_; }
  int n_elements() const { return static_cast<int>(elements_.size()); }
  int degree(int element) const { return elements_[element].degree; }
  int n_bezier(int element) const { return (degree(element) + 1) * (degree(element) + 1); }
  const std::vector<DegreeGroup>& groups() const { return groups_; }

  /// Computes the Bezier points of one element; `out` has shape (3, n_b): all of x1, then x2, then x3.
  void points(int element, const Net& net, double* out) const;

  /// Applies the transpose of `points`: net_A += sum_b extraction(A, b) in_b, with `in` of shape (3, n_b). Converts derivatives with respect to
  /// Bezier points into derivatives with respect to control points.
  void add_transposed(int element, const double* in, Net& net) const;

  /// transposed() computes what add_transposed() adds to the control points of one element, and add_rows() adds it.
  void transposed(int element, const double* in, std::vector<double>& rows) const;
  void add_rows(int element, const std::vector<double>& rows, Net& net) const;

 private:
  struct Element {
    int degree, functions, first;  ///< degree p; number of functions; index in `points_` of the element's first control point
    std::size_t operation;         ///< index in `by_bezier_` and `by_function_` at which the element's extraction matrix begins
  };
  int n_points_;
  std::vector<DegreeGroup> groups_;
  std::vector<Element> elements_;
  std::vector<int> points_;
  // by_bezier_: extraction matrices, entry [Bezier point][function]. by_function_: the same matrices transposed, entry [function][Bezier point].
  std::vector<double> by_bezier_, by_function_;
};

}  // namespace tanktread::surface
