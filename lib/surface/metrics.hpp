#pragma once
// Refinement indicators: size of the elements of a T-mesh, variation of fields on them, and resolution errors of surface and load.

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::surface {

/// A mid-line of an element, along s at t = 1/2 or along t at s = 1/2 (1.3): its length L, and |phi(end) - phi(start)| / L for three fields phi: the
/// traction (per current area), the velocity and the mean curvature chi. Units: length, and the unit of phi per length.
struct MidLine {
  double length = 0, traction = 0, velocity = 0, curvature = 0;
};

/// Lengths of the two mid-lines of one element of the T-mesh, and variations of fields along them.
struct ElementMetrics {
  std::array<MidLine, 2> along;  ///< s, t

  /// Returns L_alpha/L_beta.
  double aspect_ratio(int alpha) const { return along[alpha].length / along[1 - alpha].length; }
};

/// A field on the surface as a function of a site (element and local coordinates). The variation of an empty function is 0.
using FieldAt = std::function<Vec3(const spline::Site&)>;
using FieldsAt = std::function<Eigen::VectorXd(const spline::Site&)>;

struct MetricFields {
  FieldAt traction, velocity;
};

/// Returns the metrics of elements(mesh), in the order of elements(mesh), on the surface of `net`. These are the elements of the T-mesh, which are
/// marked and refined, not the Bezier elements: a mid-line may cross several Bezier elements. If a mid-line ends at a pole, where most fields have no
/// value, only its length is computed.
std::vector<ElementMetrics> element_metrics(const spline::TMesh& mesh, const spline::Space& space, const Net& net,
                                            const MetricFields& fields);

/// Returns the traction f J0/J per current area for a load f per reference area (3.7). J0 and J are the area elements of the configurations `rest`
/// and `net`; `load`: control values of f. The result of this function and of field_of_net() refers to the arguments, which must outlive it.
FieldAt per_current_area(const spline::Space& space, const Net& rest, const Net& net, const Net& load);

/// Returns the field with control values `net`.
FieldAt field_of_net(const spline::Space& space, const Net& net);

/// Criteria of refinement, each of which is an estimated error (1.5).
enum class Criterion {
  surface,  ///< error e(x) of the surface, length
  load,     ///< error e(phi) of the load phi, in the unit of phi; 0 without a load
  fields,   ///< error e(q) of the fields q, dimensionless; 0 without fields
};
constexpr std::size_t n_criteria = static_cast<std::size_t>(Criterion::fields) + 1;

/// Errors of an element along one direction. They estimate how far the exact surface or load is from its best approximation by cubics on elements
/// of this length,
///
///   e(x) = |D4 x - F D4 X| / 384,   e(phi) = |D4 phi| / 384,   phi the load per current area                       (1.5)
///   e(q) = |D4 q - G D4 x| / 384,   q the fields on the surface
///
/// with x the current and X the unstressed surface, and D4 the fourth difference of values one element apart, averaged over both edges of the element
/// in this direction. 1/384 is the constant of cubic spline interpolation. F maps the tangents of the unstressed surface at the element's centre to
/// the tangents of the current surface, and the unstressed normal to the current normal times the square root of the area stretch. So variations of X
/// itself, largest at extraordinary points, do not count as errors where the particle has kept its shape. G is the gradient of q along the surface.
/// So a field that is linear in x has no error. On smooth surfaces, halving an element divides all errors by 16; next to an extraordinary point by
/// about 8.
struct Errors {
  std::array<double, n_criteria> of{};  ///< errors in the order of Criterion

  double operator[](Criterion criterion) const { return of.at(static_cast<std::size_t>(criterion)); }
  double& operator[](Criterion criterion) { return of.at(static_cast<std::size_t>(criterion)); }
  Errors operator+(const Errors& other) const {
    Errors sum;
    for (std::size_t k = 0; k < n_criteria; ++k) sum.of[k] = of[k] + other.of[k];
    return sum;
  }
  Errors operator*(double factor) const {
    Errors product;
    for (std::size_t k = 0; k < n_criteria; ++k) product.of[k] = of[k] * factor;
    return product;
  }
};
struct Resolution {
  double length = 0;  ///< mean length of the element's edges along the direction
  Errors errors;
  Errors merged;  ///< errors of the element after merging, with twice the length; estimated as 16 times `errors` if there is no such element
};

/// Returns the estimated discretisation errors along s and along t for each element of elements(mesh), in this order. A line of sample points ends at
/// an extraordinary point or a pole; if it has fewer than five points, the estimate is 0. A side of an element that is collapsed to a pole is
/// ignored.
std::vector<std::array<Resolution, 2>> resolution(const spline::TMesh& mesh, const spline::Space& space, const Net& rest, const Net& net,
                                                  const FieldAt& load, const FieldsAt& fields = {});

}  // namespace tanktread::surface
