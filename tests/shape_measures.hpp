#pragma once
// Measures of one surface, for tests.

#include "base/indices.hpp"
#include "surface/geometry.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

/// Returns the mean curvature of the surface at a site.
inline double mean_curvature(const spline::Space& space, const Net& net, const spline::Site& site) {
  return mean_curvature(jet(ElementPoints(space, net, site.element).patch(), site.s, site.t));
}

inline Deformation deformation(const Geometry& geometry, const Net& net) {
  const Measures measures = geometry.measures(net);
  return Geometry::deformation(measures, geometry.extremes(net, measures.centroid, indices(geometry.bezier().n_elements())));
}

}  // namespace tanktread::surface
