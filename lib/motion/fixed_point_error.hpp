#pragma once
// How far an iterate is from the fixed point that it converges to.

#include <deque>
#include <utility>

#include "base/types.hpp"

namespace tanktread::motion {

/// The estimated error of an iterate x_k of a fixed-point iteration, from the corrections f_j = g(x_j) - x_j of the last m iterates:
///
///   x_k - x* = -f_k + (dX + dF) c,   c the least-squares solution of dF c = f_k,   dX, dF: columns x_k - x_j, f_k - f_j          (4.32)
///
/// A correction alone is smaller than the error by the factor 1 - rho of the mode with contraction rate rho that decays most slowly, near a fold a
/// hundredfold. The estimate is exact if g is affine and differs from the identity in m directions only; Anderson acceleration steps by it.
class FixedPointError {
 public:
  /// `most`: m.
  explicit FixedPointError(int most) : most_(most) {}

  /// Takes x_k and f_k, finite; returns the estimate of x_k - x*. Cost: a least-squares problem of m columns, no evaluation.
  Net operator()(const Net& x, const Net& f);

  bool known() const { return before_.size() > 1; }  ///< whether the latest estimate is more than the correction

 private:
  int most_;
  std::deque<std::pair<Net, Net>> before_;  // x_j, f_j, the latest last
};

}  // namespace tanktread::motion
