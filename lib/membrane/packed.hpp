#pragma once
// Elements packed for the innermost loops of the membrane, one element per register lane: extraction matrices, control-point ids, Gauss tables.

#include <array>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/pack.hpp"
#include "spline/limits.hpp"
#include "spline/space.hpp"

namespace tanktread::membrane {

constexpr int max_order = 12;                     ///< largest number of Gauss points per direction
constexpr int max_gauss = max_order * max_order;  ///< largest number of Gauss points of an element

/// A batch: up to pack_lanes() elements of one degree, one per register lane. Idle lanes repeat the last element with the weight 0.
struct Batch {
  int used = 0;                       ///< number of lanes that are not idle
  int functions = 0;                  ///< largest number of basis functions of an element of the batch; elements with fewer are padded with zeros
  std::array<int, most_lanes> elements{};  ///< indices of the elements in the space
  std::size_t points = 0;             ///< index in Group::points of the batch's first control-point id; the id for function A in lane l has the index
                                      ///< points + A * pack_lanes() + l
  /// index in Group::extraction of the first entry of the batch's extraction matrices; the entry for function A and Bernstein polynomial b has the
  /// index extraction + A * (p + 1)^2 + b, with the degree p. Equal matrices are stored once
  std::size_t extraction = 0;
  std::size_t row = 0;                ///< index of the batch's first row in the rows of PointSums
};

/// All given elements of one degree and material, in ascending order, with the Gauss rule of the degree.
struct Group {
  int degree = 3, order = 4;
  int material = 0;                        ///< material index of the elements of this group
  std::vector<double> value, slope, bend;  ///< values, first and second derivatives of the 1-D Bernstein polynomials i at the Gauss nodes q, at index
                                           ///< q * (p + 1) + i with the degree p
  std::vector<double> weight;              ///< tensor-product weights, at index q_t * order + q_s
  std::vector<Batch> batches;
  std::vector<int> points;
  std::vector<Pack> extraction;

  int n_gauss() const { return order * order; }
  int n_bernstein() const { return (degree + 1) * (degree + 1); }
};

/// Packs the given elements (any order, no repetition) into one group per material and degree, sorted by material, then by degree. The rule of a
/// group has quadrature::gauss_order(order, degree) points per direction. `material`: index of the material of each element of
/// the space; if empty, all elements have the material 0.
std::vector<Group> pack(const spline::Space& space, std::span<const int> elements, int order, std::span<const int> material = {});

/// Evaluates the tangents of a net at the Gauss points of a batch: a[6 q + c] is component c of x_,s, and a[6 q + 3 + c] is component c of x_,t.
void tangents(const Group& group, const Batch& batch, const Net& net, Pack* a);

/// Applies the transpose of `tangents`: sets sum_q (N_A,s p_s + N_A,t p_t) for each element and function A of the batch; component c for function A
/// in lane l is rows[3 (l functions + A) + c]. At the Gauss point q, p_s is p[6 q .. 6 q + 2], and p_t is p[6 q + 3 .. 6 q + 5]. add_transpose()
/// adds the results to the rows of the control points of `sum`. The elements are added one after another, in the order of their lanes.
void transpose(const Group& group, const Batch& batch, const Pack* p, double* rows);
void add_transpose(const Group& group, const Batch& batch, const Pack* p, Net& sum);

/// Evaluates first and second derivatives of a net at the Gauss points of a batch: j[15 q + 3 k + c] is component c of derivative k = 0 .. 4 at point
/// q, in the order x_,s x_,t x_,ss x_,st x_,tt. jet_transpose applies the transpose of `jets`; `rows`: see transpose().
void jets(const Group& group, const Batch& batch, const Net& net, Pack* j);
void jet_transpose(const Group& group, const Batch& batch, const Pack* p, double* rows);

/// Sums over all batches of what transpose() gives for each element and function, at the control points. The terms of a control point are added in
/// the order of groups, batches, lanes and functions, whatever thread computes them.
class PointSums {
 public:
  PointSums() = default;
  /// Sets the member `row` of the batches of `groups`.
  PointSums(const spline::Space& space, std::vector<Group>& groups);

  std::size_t n_rows() const { return n_rows_; }  ///< number of rows of all batches
  void add(const double* rows, Net& sum) const;  ///< adds the rows to the control points of `sum`. Component c of row r is rows[3 r + c]

 private:
  std::size_t n_rows_ = 0;
  std::vector<std::size_t> first_;  // for each control point, index in row_ of its first term
  std::vector<int> row_;
};

}  // namespace tanktread::membrane
