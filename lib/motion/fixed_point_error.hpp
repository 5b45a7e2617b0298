#pragma once
// Estimate of the distance of an iterate from the fixed point to which the iteration converges.

#include <deque>
#include <utility>

#include "base/types.hpp"

namespace tanktread::motion {

/// Estimates the error of an iterate x_k of a fixed-point iteration from the corrections f_j = g(x_j) - x_j of the last m iterates:
///
///   x_k - x* = -f_k + (dX + dF) c,   c the least-squares solution of dF c = f_k,   dX, dF: columns x_k - x_j, f_k - f_j          (4.32)
///
/// The correction f_k is smaller than the error by the factor 1 - rho, with rho the contraction rate of the slowest mode; near a fold this factor is
/// about 1/100. The estimate is exact if g is affine and the matrix dg/dx - 1 has at most the rank m. Anderson acceleration uses the estimate as its
/// step.
class FixedPointError {
 public:
  /// `most`: largest number m of earlier iterates x_j that the estimate (4.32) uses.
  explicit FixedPointError(int most) : most_(most) {}

  /// Stores the iterate x_k and its correction f_k, which must be finite. Returns the estimate (4.32) of the error x_k - x*, where x* is the fixed
  /// point. The cost is a least-squares problem with m columns, without evaluations of the fixed-point map.
  Net operator()(const Net& x, const Net& f);

  /// Returns true if the latest estimate (4.32) uses earlier iterates; without earlier iterates the estimate is -f_k.
  bool known() const { return before_.size() > 1; }

 private:
  int most_;
  std::deque<std::pair<Net, Net>> before_;  // pairs of an earlier iterate x_j and its correction f_j, latest last
};

}  // namespace tanktread::motion
