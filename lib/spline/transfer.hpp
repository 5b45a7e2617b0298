#pragma once
// Fields from one spline space to another: by Transfer to one that contains it, by Projection to any.

#include <memory>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

/// The same field in a space that contains the old one. Every element of `to` must lie in one element of `from` (refinement; `straddling` counts
/// those that do not).
///
/// Where both spaces have an element and its functions in common, control values are copied, to the last bit. The others are found by least squares
/// at the 4 x 4 Gauss points of the elements on which anything has changed, without a residual. When there is one, the spaces are not nested, and all
/// values are found anew by least squares. Both spaces must outlive it.
class Transfer {
 public:
  Transfer(const Space& from, const Space& to);
  ~Transfer();
  Transfer(Transfer&&) noexcept;

  struct Result {
    Net net;
    double residual;  ///< largest |new - old| over these points; where the field has size 1, 1e-13 is rounding
  };
  Result operator()(const Net& field) const;

  int straddling() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Least squares at the 4 x 4 Gauss points of the elements of both spaces, weighted by parametric area. One factorisation serves all fields.
/// Both spaces must outlive it.
class Projection {
 public:
  Projection(const Space& from, const Space& to);
  ~Projection();
  Projection(Projection&&) noexcept;

  struct Result {
    Net net;
    std::vector<double> defect;  ///< of an element of `from`: largest |old - new| over the points in it
  };
  Result operator()(const Net& field) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tanktread::spline
