#pragma once
// Stress-free shapes of membranes that differ from their resting shapes.

#include "base/types.hpp"
#include "surface/fit.hpp"
#include "surface/options.hpp"

namespace tanktread::surface {

/// Returns the control net of a stress-free oblate spheroid (a sphere if the reduced volume is 1) on the mesh of `unit_sphere`. The spheroid has the
/// area, the centre and the axis of the resting `shape`. Each point of the spheroid corresponds to the point of the resting shape at the same
/// azimuth, on the parallel that encloses the same area with the equator. So every part of the membrane has the same area in both shapes, and only
/// the form of the part differs.
///
/// The reduced volume v = 6 sqrt(pi) V/A^(3/2) is above 0 and at most 1. The shape must have an axis of revolution: a sphere (axis: body-fixed x3), a
/// spheroid, a red cell. Otherwise throws UserError.
Net stress_free_spheroid(const LeastSquaresFit& fit, const Net& unit_sphere, const ParticleShape& shape, double reduced_volume);

}  // namespace tanktread::surface
