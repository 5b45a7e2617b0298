#pragma once
// Elements side by side for the hot loops of the membrane, one in each lane of a register: extraction matrices, control-point ids, Gauss tables.

#include <array>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/pack.hpp"
#include "spline/space.hpp"

namespace tanktread::membrane {

constexpr int max_degree = 8;      ///< of a Bezier element
constexpr int max_order = 12;      ///< Gauss points per direction
constexpr int max_functions = 64;  ///< functions that live on one element

/// Up to pack_lanes() elements of one degree. Idle lanes repeat the last element with a reference weight of zero.
struct Batch {
  int used = 0;                       ///< lanes that hold an element of their own
  int functions = 0;                  ///< m, the largest of its elements; missing functions have zero extraction
  std::array<int, most_lanes> elements{};  ///< ids in the space
  std::size_t points = 0;             ///< where its control-point ids start in Group::points, [A * pack_lanes() + lane]
  std::size_t extraction = 0;         ///< where its extraction starts in Group::extraction, [A * (p + 1)^2 + b]; batches that are alike share one
};

/// All elements of one degree and material of a list, in ascending order, with the Gauss rule that belongs to the degree.
struct Group {
  int degree = 3, order = 4;
  int material = 0;                        ///< of its elements
  std::vector<double> value, slope, bend;  ///< 1-D Bernstein polynomials, first and second derivatives at the Gauss nodes, [q * (p + 1) + i]
  std::vector<double> weight;              ///< tensor weights, [q_t * order + q_s]
  std::vector<Batch> batches;
  std::vector<int> points;
  std::vector<Pack> extraction;

  int n_gauss() const { return order * order; }
  int n_bernstein() const { return (degree + 1) * (degree + 1); }
};

/// The given elements (any order, no repetition), one group a material and degree, both ascending. A group's rule has `order` points per
/// direction at degree 3 and one more for each degree beyond. `material`: of each element of the space; of all 0 where there are none.
std::vector<Group> pack(const spline::Space& space, std::span<const int> elements, int order, std::span<const int> material = {});

/// Tangents of a net at the Gauss points of a batch: a[6 q + c] = component c of x_,s, a[6 q + 3 + c] of x_,t.
void tangents(const Group& group, const Batch& batch, const Net& net, Pack* a);

/// The transpose of `tangents`: adds sum_q (N_A,s p_q,1 + N_A,t p_q,2) to the rows A of `sum`, lane after lane.
void add_transpose(const Group& group, const Batch& batch, const Pack* p, Net& sum);

/// The same up to second derivatives: j[15 q + 3 k + c], k = 0 .. 4 for x_,s x_,t x_,ss x_,st x_,tt.
void jets(const Group& group, const Batch& batch, const Net& net, Pack* j);
void add_jet_transpose(const Group& group, const Batch& batch, const Pack* p, Net& sum);

}  // namespace tanktread::membrane
