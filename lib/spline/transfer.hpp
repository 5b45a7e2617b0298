#pragma once
// Fields from one spline space to another on the same macro faces.

#include <memory>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

/// Least squares on Bezier coefficients: control values P of `to` that minimise
///
///   sum_e |C_e^T P - Q_e|^2,   Q_e: the field of `from` restricted to element e of `to` by de Casteljau.
///
/// Exact when the spaces are nested; the residual tells. Every element of `to` must lie in one element of `from` (refinement; `straddling`
/// counts those that do not). One sparse Cholesky factorisation serves all fields.
/// Both spaces must outlive it.
class Transfer {
 public:
  Transfer(const Space& from, const Space& to);
  ~Transfer();
  Transfer(Transfer&&) noexcept;

  struct Result {
    Net net;
    double residual;  ///< largest |C_e^T P - Q_e| over all Bezier points; where the field has size 1, 1e-13 is rounding
  };
  Result operator()(const Net& field) const;

  int straddling() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tanktread::spline
