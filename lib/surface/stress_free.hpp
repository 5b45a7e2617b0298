#pragma once
// Stress-free shapes of membranes that are not their resting ones.

#include "base/types.hpp"
#include "surface/fit.hpp"
#include "surface/options.hpp"

namespace tanktread::surface {

/// Control net of the oblate spheroid, or for a reduced volume of 1 the sphere, that has the area of the resting `shape`, its centre and its axis, on
/// the mesh of `unit_sphere`. Each of its points stands for the point of the resting shape at the same azimuth on the parallel that cuts off the same
/// area: no piece of the membrane differs in area between the two shapes, only in shape.
///
/// The reduced volume v = 6 sqrt(pi) V/A^(3/2) is above 0 and at most 1. The shape must have an axis: a sphere (its own x3), a spheroid, a red cell;
/// UserError otherwise.
Net stress_free_spheroid(const LeastSquaresFit& fit, const Net& unit_sphere, const ParticleShape& shape, double reduced_volume);

}  // namespace tanktread::surface
