#pragma once
// The shape that a run starts with where it is not the resting one: Particle/initial shape.

#include <optional>

#include "record/files/checkpoint.hpp"
#include "scene/body.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// The end of the run that the deck starts from; nothing where it names none. Throws UserError where there is none, or its surface is another one.
std::optional<output::Checkpoint> run_before(const Scene& scene);

/// Control net of the initial shape on the body's mesh; the resting one where the deck has no other. `before`: run_before, or nothing. Throws
/// UserError where a file holds another surface.
Net initial_shape(const Scene& scene, const Body& body, const output::Checkpoint* before);

/// Control net of the membrane's stress-free shape on the body's mesh, before any pre-inflation: the resting one where the deck has no other. Throws
/// UserError where a file holds another surface, or the resting shape has no axis.
Net stress_free_shape(const Scene& scene, const Body& body);

}  // namespace tanktread
