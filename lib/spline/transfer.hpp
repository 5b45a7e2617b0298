#pragma once
// Fields from one spline space to another that contains it.

#include <memory>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

/// The same field in a space that contains the old one. Every element of `to` must lie in one element of `from` (refinement; `straddling` counts
/// those that do not).
///
/// Where both spaces have an element and its functions in common, control values are copied, to the last bit. Any other control value belongs to
/// the field on a single element: the sixteen functions there are independent, so C_e^T P = Q_e gives it, Q_e being the Bezier points of the
/// field, restricted by de Casteljau; the element is the one on which its function is largest. Where no such element determines a value well
/// (at extraordinary points and poles) it is found by least squares on the Bezier points around (BezierFit). So the work is that of what has
/// changed. When the residual tells that the spaces are not nested, all values are found anew by least squares.
///
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
