#pragma once
// Posts: fixed cylinders in a periodic cell, `Particle/shape: cylinder` of the deck.

#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "stokes/medium/periodic_images.hpp"

namespace tanktread {

struct ParticleKind;
struct Scene;

/// A circular cylinder along a periodic direction, at rest. One period of it is in the cell.
struct Post {
  std::string name;  ///< name of its section in Particles; empty for a single one
  double radius = 1;
  int axis = 0;  ///< index of the coordinate axis along which it lies
  Vec3 center = Vec3::Zero();
  int around = 24;           ///< number of elements around it
  std::optional<int> along;  ///< number of elements along its period

  std::string path(const std::string& key = {}) const;  ///< returns the path of its section or of a key in it, for messages
};

/// Returns the lattice vector along the axis of a post, units length; zero if there is none.
Vec3 period_of(const Post& post, const stokes::PeriodicCell& cell);

/// Removes the cylinders from the kinds of a scene and adds them to its posts. Sets whether its walls are plates, also for its flow, and the default
/// of Adaptation/film resolution where there are films. Throws UserError if a cylinder has keys that only particles have.
void take_posts(Scene& scene);

/// Throws UserError if posts do not fit into the scene.
void check_posts(const Scene& scene);

}  // namespace tanktread
