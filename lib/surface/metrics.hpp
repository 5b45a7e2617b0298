#pragma once
// Size of the elements of a T-mesh and variation of the fields on them: what refinement is decided by.

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

}  // namespace tanktread::surface
