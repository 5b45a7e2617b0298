#pragma once
// Posts: fixed cylinders in a periodic cell, `Particle/shape: cylinder` of the deck.

#include <optional>
#include <string>

#include "base/rejections.hpp"
#include "base/types.hpp"
#include "stokes/medium/periodic_images.hpp"

namespace tanktread {

struct ParticleKind;
struct ParticleScene;
struct Scene;
struct SharedOptions;

/// A circular cylinder along a periodic direction, at rest. One period of the cylinder is in the cell.
struct Post {
  std::string name;  ///< name of the post's section in Particles; empty if the deck has only one particle
  double radius = 1;
  int axis = 0;  ///< index of the coordinate axis parallel to the post
  Vec3 center = Vec3::Zero();
  int around = 24;           ///< number of elements around the post
  std::optional<int> along;  ///< number of elements of the post along its period

  std::string path(const std::string& key = {}) const;  ///< returns the path of the post's section or of a key in it, for messages
};

/// Returns the lattice vector along the axis of a post, in units of length; zero if no lattice vector is along the axis.
Vec3 period_of(const Post& post, const stokes::PeriodicCell& cell);

/// Reason why most keys of a particle have no effect on a cylinder, for Section::without_effect.
constexpr const char* only_keys_of_post =
    "on a post (Particle/shape `cylinder`), which has only the keys radius, axis and center, and the keys azimuthal elements and axial elements of "
    "Surface";

/// Moves the cylinders from the particles of a scene to its posts. Throws UserError if the deck gives a cylinder another key than those that a post
/// can have. Such keys are the keys of the cylinder in Scene::idle_keys; sentences about a cylinder are removed from there.
void take_posts(Scene& scene);

/// Throws UserError if a post does not fit into the cell, or if it touches a wall or another post. If there are no posts, throws UserError if the
/// scene has a pressure gradient but neither posts nor two walls, so that nothing resists the flow.
void check_posts(const SharedOptions& shared);

/// Adds to `to` the combinations of choices that are not allowed with posts.
void reject_posts(const ParticleScene& particle_scene, Rejections& to);

}  // namespace tanktread
