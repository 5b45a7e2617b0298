#pragma once
// How well the elements of a T-mesh resolve what lies on them.

#include <array>
#include <optional>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "spline/t_mesh.hpp"
#include "surface/metrics.hpp"

namespace tanktread::surface {

/// Along one direction of an element: its length, and estimates of the distance between cubics on elements of this length and what they stand for,
///
///   e(x) = |D4 x - F D4 X| / 384,   e(phi) = |D4 phi| / 384,   phi the load per present area                       (1.5)
///
/// with D4 the fourth difference of values one element apart, the mean over both edges of the element in this direction: 1/384 is the constant of
/// cubic spline interpolation. F maps the tangents of the unstressed surface at the element's centre to those of the present one, and its normal
/// to that one's times the square root of the stretch in area: how X itself varies over the mesh, at extraordinary points above all, costs
/// nothing where the particle has kept its shape. Where all is smooth, cutting an element divides either by 16; next to an extraordinary point
/// by about 8.
struct Errors {
  double surface = 0;  ///< e(x), length
  double load = 0;     ///< e(phi), unit of phi; 0 without a load
};
struct Resolution {
  double length = 0;  ///< of the edges, their mean
  Errors errors;
  Errors merged;  ///< of the element twice as long that this one is a part of; 16 times `errors` where there is none
};

/// Of elements(mesh), in its order, along s and t. A line of places ends at an extraordinary point or a pole; where fewer than five are left, the
/// estimate is 0. A side that is a pole does not count.
std::vector<std::array<Resolution, 2>> resolution(const spline::TMesh& mesh, const spline::Space& space, const Net& rest, const Net& net,
                                                  const FieldAt& load);

}  // namespace tanktread::surface
