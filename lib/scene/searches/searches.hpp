#pragma once
// Data that searches for steady shapes, periodic motions and branches need from a scene: the rigid motions that leave the problem invariant, the
// implicit step of the search, the conserved quantities, and the parameters of a branch.

#include <array>
#include <functional>
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
#include "system/rigid_motion.hpp"

namespace tanktread {

/// Returns the rigid motions about the origin that leave the problem invariant: the Lie derivative of the flow along them is 0, the walls do not
/// change, and every load moves with its particle. In (4.17), Q projects onto these motions. In a tube, only the
/// translation along it; in a channel, none. `size`: length scale of the particles, R_C. `kinds`: 6, or 3 for translations only.
std::vector<coupling::RigidMotion> free_motions(const Scene& scene, const stokes::AmbientFlow& flow, double size,
                                                std::span<const coupling::Particle> particles, int kinds = 6);

/// Adds to `to` the combinations of keys that are not allowed in a search for steady shapes, periodic motions or spectra.
void reject_searches(const ParticleScene& particle_scene, Rejections& to);

/// Returns Steady/step, the implicit step of the search in units of time. If this key is not set, the step is 0.5/Scene::rate(), but at most 10
/// relaxation times of each membrane. The bound is needed because the iteration multiplies errors of the velocity by the ratio of the step to the
/// relaxation time if no membrane opposes the motion.
double steady_step(const Scene& scene);

/// Returns the gradients, at the state x, of the quantities that the motion conserves: the volume of each deformable particle, and the total of each
/// field that is conserved (mass of surfactant).
std::vector<motion::Conserved> conserved_quantities(const coupling::CoupledMotion& motion, const coupling::State& x);

/// Values of the parameters Continuation/parameter and Continuation/second parameter; the second is 0 if there is none.
using Parameters = std::array<double, 2>;

/// Function that returns the scene of the deck with some keys changed by settings `Section/key=value`, or throws UserError.
using ChangedScene = std::function<Scene(const std::vector<std::string>& settings)>;

/// Returns the scene of a branch for these values of its parameters. Throws UserError if the deck does not allow them.
Scene scene_of_branch(const Scene& scene, const ChangedScene& changed, const Parameters& parameters);

/// Returns the parameter values at the start of the branch, which are the values in the deck. Throws UserError if the deck does not give a number for
/// a parameter, if the first parameter already equals Continuation/to, or if the deck does not allow the values at which the branch ends.
Parameters first_parameters(const Scene& scene, const std::string& deck, const ChangedScene& changed);

}  // namespace tanktread
