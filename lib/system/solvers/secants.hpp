#pragma once
// Multisecant correction of the Jacobian from earlier iterations.

#include <vector>

#include <Eigen/Cholesky>

#include "system/blocks/block_vector.hpp"

namespace tanktread::coupling {

/// Correction E of the Jacobian J (4.3) from the last few quasi-Newton corrections d_i and the errors e_i = B (dv_i - J d_i) of J along them:
///
///   E w = sum_i c_i e_i,   c the coefficients of the least-squares fit of w by the d_i                                          (4.13)
///
/// w is a displacement, dv_i the change of the velocity due to d_i, and B the operator of the velocity system (2.8). The part of the Jacobian that
/// (4.3) omits is bounded and changes only as the shape changes, so that pairs (d_i, e_i) remain useful for a few steps. This is a multisecant
/// update: Fang & Saad, Numer. Linear Algebra Appl. 16 (2009).
class Secants {
 public:
  /// `pairs`: each correction d_i, followed by its error e_i, in the order d_1, e_1, d_2, e_2, ..., oldest first.
  explicit Secants(std::vector<State> pairs);
  Secants() = default;

  /// Adds the correction d_i = `correction` with its error e_i = `jacobian_error`. Only the last `most` pairs (d_i, e_i) are kept.
  void add(const State& correction, const State& jacobian_error, int most);

  /// Returns E w.
  State operator()(const State& w) const;

  const std::vector<State>& pairs() const { return pairs_; }

 private:
  void factor();
  const State& correction(Eigen::Index i) const { return pairs_[static_cast<std::size_t>(2 * i)]; }

  std::vector<State> pairs_;
  Eigen::LDLT<Eigen::MatrixXd> gram_{Eigen::MatrixXd(0, 0)};
};

}  // namespace tanktread::coupling
