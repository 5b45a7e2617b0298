#pragma once
// Data that searches for steady shapes, periodic motions and branches need from a scene: the rigid motions that leave the problem invariant, whether
// a particle's centroid is held in place, the implicit step of the search, the conserved quantities, and the parameters of a branch.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "motion/integrator.hpp"
#include "motion/spectrum.hpp"
#include "scene/scene.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "surface/geometry.hpp"
#include "system/coupled_motion.hpp"
#include "system/particle.hpp"
#include "system/solids/rigid_motion.hpp"

namespace tanktread {

/// Returns the rigid motions about the origin that leave the problem invariant: the Lie derivative of the flow along them is 0, the walls do not
/// change, and the loads of all particles move with them. In (4.17), Q is the projector onto these motions. `size`: length scale of the particles,
/// R_C.
std::vector<coupling::RigidMotion> free_motions(const Scene& scene, const stokes::AmbientFlow& flow, double size,
                                                std::span<const coupling::Particle> particles);

/// Adds the combinations of keys that searches for steady shapes, periodic motions and spectra exclude.
void reject_searches(const Scene& scene, Rejections& to);

/// Returns Steady/step, or its default. The default is bounded by a multiple of the membranes' relaxation times. If no membrane opposes a motion, the
/// iteration amplifies velocity errors in this motion by the ratio of the step to these times.
double steady_step(const Scene& scene);

/// Returns true if the particle is moved after every step so that its centroid is at the centre given in the deck. The key `Particle/drift` decides
/// this. If it is not set, returns true for a deformable particle without walls whose centre is a stagnation point of an affine flow with a growing
/// direction (planar hyperbolic, four-roll, extension). In such a flow, a displacement by round-off grows like e^(rate t) and would carry away a
/// particle of steady shape.
bool holds_centre(const Scene& scene);

/// Displaces the state by a vector c so that its centroid is at `place`, together with the slopes and earlier positions of the time scheme. In an
/// affine flow with gradient L, v(x + c) = v(x) + L c for any shape x. If x(t) is a motion, x(t) + c(t) with dc/dt = L c is therefore also a motion.
/// So slopes change by L c, and the position at a time s earlier is displaced by exp(-L s) c.
void hold_centre(const stokes::AmbientFlow& flow, const surface::Geometry& geometry, const Vec3& place, motion::State& state);

/// Returns the conserved quantities of a motion at the shape x: the volume of each deformable particle, and the sums that the fields conserve.
/// `fields`: motion of the fields on the surfaces; null if there are none.
std::vector<motion::Conserved> conserved_quantities(const coupling::Capsule& capsule, const coupling::CoupledMotion* fields, const Net& x);

/// Values of the parameters Continuation/parameter and Continuation/second parameter; the second is 0 if there is none.
using Parameters = std::array<double, 2>;

/// Returns the settings `Section/key=value` for these values of Continuation/parameter and of the second parameter.
std::vector<std::string> settings_of(const motion::ContinuationOptions& branch, const Parameters& values);

/// Returns the parameter values at the start of the branch. Throws UserError if a parameter is not a number of the deck.
Parameters first_parameters(const Scene& scene, const std::string& deck);

}  // namespace tanktread
