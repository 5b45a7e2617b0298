#pragma once
// Rigid motions that a scene leaves free, what holds a particle against them, and the step of a steady search.

#include <span>
#include <vector>

#include "motion/integrator.hpp"
#include "scene/scene.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "surface/geometry.hpp"
#include "system/particle.hpp"
#include "system/solids/rigid_motion.hpp"

namespace tanktread {

/// Returns the rigid motions about the origin that change neither the flow nor loads and walls: the Lie derivative of the flow along them is 0, and
/// the loads of all particles move with them. `size`: a length of the particles, R_C. Q of (4.17) projects onto them.
std::vector<coupling::RigidMotion> free_motions(const Scene& scene, const stokes::AmbientFlow& flow, double size,
                                                std::span<const coupling::Particle> particles);

/// Returns Steady/step, or its default. The default is bounded by the relaxation times of the membranes because the iteration amplifies errors of the
/// velocity in motions that no membrane opposes by the step over these times.
double steady_step(const Scene& scene);

/// Returns whether the centroid is put back after every step: `Particle/drift`. The default is `held` at the point of rest of an affine flow that
/// draws away from it (planar hyperbolic, four-roll, extension): whatever rounding displaces grows there like e^(rate t), and carries off a particle
/// whose shape is steady.
bool holds_centre(const Scene& scene);

/// Moves the state so that its centroid is at `place`, and the slopes and earlier places of the scheme along: v(x + c) = v(x) + L c in an affine
/// flow, whatever the shape, so that x(t) + c(t) with dc/dt = L c is a motion where x(t) is one, and was displaced by exp(-L s) c at a time s ago.
void hold_centre(const stokes::AmbientFlow& flow, const surface::Geometry& geometry, const Vec3& place, motion::State& state);

}  // namespace tanktread
