#pragma once
// Gauss-Legendre rules on the unit interval and their tensor products on the unit square.

#include <vector>

#include <Eigen/Core>

namespace tanktread::quadrature {

/// Nodes (ascending) and weights on [0, 1]; the weights sum to 1. A rule with n nodes is exact for polynomials up to degree 2n - 1.
struct GaussRule {
  Eigen::VectorXd nodes, weights;
  int size() const { return static_cast<int>(nodes.size()); }
};

/// Returns the n-point Gauss-Legendre rule on [0, 1], n >= 1. The error of nodes and weights is a few units of round-off. Each rule is computed once
/// and stored; the reference stays valid for the whole run. Several threads may call this function, and tensor_gauss().
const GaussRule& gauss(int n);

/// Returns the smallest number of Gauss points that integrates polynomials of this degree exactly.
constexpr int gauss_points_for_degree(int degree) { return degree / 2 + 1; }

/// Returns the number of Gauss points per direction on an element of this degree, if elements up to degree 3 have `order`: one more for each degree
/// above 3.
constexpr int gauss_order(int order, int degree) { return degree > 3 ? order + degree - 3 : order; }

/// Nodes (s, t) and weights on the unit square, s fastest: node q = n_s j + i consists of node i (of n_s) in s and node j in t.
struct TensorRule {
  Eigen::VectorXd s, t, weights;
  int size() const { return static_cast<int>(weights.size()); }
};
TensorRule tensor(const GaussRule& in_s, const GaussRule& in_t);

/// Returns the n x n Gauss rule. Each rule is computed once and stored.
const TensorRule& tensor_gauss(int n);

/// Points (s, t) of the unit square and their weights, in any order.
struct Rule {
  std::vector<double> s, t, weights;

  Rule() = default;
  explicit Rule(const TensorRule& from)
      : s(from.s.begin(), from.s.end()), t(from.t.begin(), from.t.end()), weights(from.weights.begin(), from.weights.end()) {}

  int size() const { return static_cast<int>(weights.size()); }
  void clear() { s.clear(), t.clear(), weights.clear(); }
  void add(double at_s, double at_t, double weight) { s.push_back(at_s), t.push_back(at_t), weights.push_back(weight); }
};

}  // namespace tanktread::quadrature
