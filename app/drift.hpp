#pragma once
// The place of a particle in a flow that has none to keep it at.

#include "app/body.hpp"
#include "app/scene.hpp"
#include "motion/integrator.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

/// Whether the centroid is put back after every step: `Particle/drift`. By itself `held` at the point of rest of an affine flow that draws away
/// from it (planar hyperbolic, four-roll, extension): whatever rounding displaces grows there like e^(rate t), and carries off a particle whose
/// shape is steady.
bool holds_centre(const Scene& scene);

/// Moves the state so that its centroid is at `place`, and the slopes and earlier places of the scheme along: v(x + c) = v(x) + L c in an affine
/// flow, whatever the shape, so that x(t) + c(t) with dc/dt = L c is a motion where x(t) is one, and was displaced by exp(-L s) c at a time s ago.
void hold_centre(const stokes::AmbientFlow& flow, const surface::Geometry& geometry, const Vec3& place, motion::State& state);

}  // namespace tanktread
