#pragma once
// A particle whose centroid is held at its place, `Particle/drift: held`.

#include "motion/integrator.hpp"
#include "scene/scene.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

/// Returns true if the particle is moved after every step so that its centroid is at the centre given in the deck. The key `Particle/drift` decides
/// this. If this key is not set, returns true if the particle is deformable, there are no walls, no net force on the particle (such as a weight) and
/// no registered loads, and the given centre is a stagnation point of an affine flow with a growing direction (planar hyperbolic, four-roll,
/// extension). In such a flow, a displacement of the particle by round-off grows like e^(rate t), so that a particle of steady shape would drift
/// away.
bool holds_centre(const ParticleScene& particle_scene);

/// Displaces the shape of the state by the vector c that moves the centroid to `place`, and changes the slopes and earlier positions of the time
/// scheme accordingly. In an affine flow with gradient L, v(x + c) = v(x) + L c for any shape x. If x(t) is a motion, x(t) + c(t) with dc/dt = L c is
/// therefore also a motion. So slopes change by L c, and the position at the time s before the current time is displaced by exp(-L s) c.
void hold_centre(const stokes::AmbientFlow& flow, const surface::Geometry& geometry, const Vec3& place, motion::TimeState& state);

}  // namespace tanktread
