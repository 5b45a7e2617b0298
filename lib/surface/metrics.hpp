#pragma once
// What refinement is decided by: size of the elements of a T-mesh and variation of the fields on them; or how well they resolve what lies on them.

#include <array>
#include <functional>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::surface {

/// One mid-line of an element, along s at t = 1/2 or along t at s = 1/2 (P-36): its length L, and |phi(end) - phi(start)| / L of the
/// traction (per current area), the velocity and the mean curvature chi. Units: length, and those of phi per length.
struct MidLine {
  double length = 0, traction = 0, velocity = 0, curvature = 0;
};

/// The two mid-lines of one element of the T-mesh.
struct ElementMetrics {
  std::array<MidLine, 2> along;  ///< s, t

  /// L_alpha/L_beta.
  double aspect_ratio(int alpha) const { return along[alpha].length / along[1 - alpha].length; }
};

/// A field on the surface, at a site of the space. Empty: not in use, its variation is 0.
using FieldAt = std::function<Vec3(const spline::Site&)>;
using FieldsAt = std::function<Eigen::VectorXd(const spline::Site&)>;

struct MetricFields {
  FieldAt traction, velocity;
};

/// Metrics of elements(mesh), in its order, on the surface of `net`. Elements are those of the T-mesh, which are marked and cut, not the Bezier
/// elements: a mid-line may run through several of these. Of one that ends at a pole, where most fields have no value, only the length is taken.
std::vector<ElementMetrics> element_metrics(const spline::TMesh& mesh, const spline::Space& space, const Net& net,
                                            const MetricFields& fields);

/// The traction per current area of a load per reference area (3.7): f J0/J, with `load` on the net, `rest` and `net` the two configurations.
/// This and the next keep references: what they are given must outlive them.
FieldAt per_current_area(const spline::Space& space, const Net& rest, const Net& net, const Net& load);

/// The field with control values `net`.
FieldAt field_of_net(const spline::Space& space, const Net& net);

/// Along one direction of an element: its length, and estimates of the distance between cubics on elements of this length and what they stand for,
///
///   e(x) = |D4 x - F D4 X| / 384,   e(phi) = |D4 phi| / 384,   phi the load per present area                       (1.5)
///   e(q) = |D4 q - G D4 x| / 384,   q the fields on the surface
///
/// with D4 the fourth difference of values one element apart, the mean over both edges of the element in this direction: 1/384 is the constant of
/// cubic spline interpolation. F maps the tangents of the unstressed surface at the element's centre to those of the present one, and its normal
/// to that one's times the square root of the stretch in area: how X itself varies over the mesh, at extraordinary points above all, costs
/// nothing where the particle has kept its shape. G is the gradient of q along the surface, for the same reason: a q that varies like x has no
/// error. Where all is smooth, cutting an element divides either by 16; next to an extraordinary point
/// by about 8.
struct Errors {
  double surface = 0;  ///< e(x), length
  double load = 0;     ///< e(phi), unit of phi; 0 without a load
  double fields = 0;   ///< of the fields on the surface, which are scaled to order 1; 0 without any

  Errors operator+(const Errors& other) const { return {surface + other.surface, load + other.load, fields + other.fields}; }
  Errors operator*(double factor) const { return {surface * factor, load * factor, fields * factor}; }
};
struct Resolution {
  double length = 0;  ///< of the edges, their mean
  Errors errors;
  Errors merged;  ///< of the element twice as long that this one is a part of; 16 times `errors` where there is none
};

/// Of elements(mesh), in its order, along s and t. A line of places ends at an extraordinary point or a pole; where fewer than five are left, the
/// estimate is 0. A side that is a pole does not count.
std::vector<std::array<Resolution, 2>> resolution(const spline::TMesh& mesh, const spline::Space& space, const Net& rest, const Net& net,
                                                  const FieldAt& load, const FieldsAt& fields = {});

}  // namespace tanktread::surface
