#pragma once
// Initial shape of a run (Particle/initial shape), and stress-free shape of the membrane. Both are the resting shape if the deck gives no other
// shape.

#include <optional>

#include "record/files/checkpoint.hpp"
#include "scene/body.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Last checkpoint of an earlier run, reduced to one particle.
struct RunBefore : output::Checkpoint {
  bool in_place = false;  ///< true if the run has several particles, and each particle of the scene starts from the one with its name, where that is
};

/// Returns the last checkpoint of the run named by Particle/initial shape/run, with the particle named by Particle/initial shape/particle; nothing if
/// the deck names no run. Throws UserError if there is no checkpoint or no such particle, if data are missing, or if the mesh of the run does not fit
/// the scene.
std::optional<RunBefore> run_before(const ParticleScene& particle_scene);

/// Returns the control net of the initial shape on the body's mesh; by default the resting shape. `before`: checkpoint that run_before() returned, or
/// null. Throws UserError if the file or checkpoint holds another surface.
Net initial_shape(const ParticleScene& particle_scene, const Body& body, const RunBefore* before);

/// Returns the control net of the membrane's stress-free shape on the mesh of `body`, before any pre-inflation. The default is the resting shape.
/// `first`: the body on the mesh of the deck, which differs from the mesh of `body` if an earlier run has adapted it. A spheroid is fitted on the
/// mesh of `first` and transferred like the resting shape, so that points with equal parameters on both shapes still correspond to each other. Throws
/// UserError if a file holds another surface, or if the resting shape has no axis.
Net stress_free_shape(const ParticleScene& particle_scene, const Body& body, const Body& first);

}  // namespace tanktread
