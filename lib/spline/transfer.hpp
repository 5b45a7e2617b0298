#pragma once
// Transfer of fields between spline spaces: transfer() to a space that contains the old one, projection() to any other space.

#include <functional>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

struct Transferred {
  Net net;
  /// largest |new field - old field| at the Gauss points of the changed elements; about 1e-13 (round-off) if the spaces are nested and the field is
  /// of order 1
  double residual;
};

/// Returns a function that represents fields in a space that contains the old space. Every element of `to` must be inside one element of `from`, as
/// after refinement.
///
/// On elements that both spaces have in common, with the same functions, control values are copied bitwise. The other values are computed by least
/// squares at the 4 x 4 Gauss points of the changed elements. If the spaces are nested, the residual is zero to round-off. If the spaces are not
/// nested, all values are computed again by least squares. Both spaces must outlive the function.
std::function<Transferred(const Net& field)> transfer(const Space& from, const Space& to);

struct Projected {
  Net net;
  std::vector<double> defect;  ///< largest |old field - new field| at the Gauss points in each element of `from`
};

/// Returns a function that projects fields to another space by least squares at the 4 x 4 Gauss points of the elements of both spaces, weighted by
/// parametric area. Uses one factorisation for all fields. Both spaces must outlive the function.
std::function<Projected(const Net& field)> projection(const Space& from, const Space& to);

}  // namespace tanktread::spline
