#include "scene/posts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "scene/scene.hpp"

namespace tanktread {

namespace {

bool is_post(const ParticleKind& kind) { return kind.particle.shape.shape == "cylinder"; }

/// Throws UserError if the deck sets a key that has no meaning for a post.
void check_keys(const ParticleKind& kind, const Post& post) {
  const ParticleOptions& particle = kind.particle;
  const auto refuse_key = [&](const char* key, bool given) {
    refuse(given, post.path(key), "Particle/shape `cylinder`", "a cylinder is a fixed post, which does not move or deform");
  };
  for (const auto& [key, given] : {std::pair("semi-axes", particle.shape.semi_axes.has_value()), std::pair("file", particle.shape.file.has_value())})
    refuse(given, post.path(key), "Particle/shape `cylinder`", "its radius determines the size of a cylinder");
  refuse_key("motion", particle.motion != Motion::deforming);
  refuse_key("velocity", particle.velocity.has_value());
  refuse_key("angular velocity", particle.angular_velocity.has_value());
  refuse_key("force", particle.force.has_value());
  refuse_key("torque", particle.torque.has_value());
  refuse_key("density difference", particle.density_difference.has_value());
  refuse_key("viscosity ratio", particle.viscosity_ratio != 1);
  refuse_key("drift", particle.drift.has_value());
  refuse_key("forces", particle.forces.has_value());
  refuse_key("initial shape", particle.shape.initial.has_value());
  refuse_key("orientation", !particle.shape.orientation.isZero(0));
  refuse_key("copies", kind.copies.present);
  refuse_key("Membrane", kind.membrane_given);
  refuse_key("Adaptation/enabled", kind.adaptation.enabled);
}

Post post_of(const ParticleKind& kind) {
  const surface::ParticleShape& shape = kind.particle.shape;
  Post post{kind.name, shape.radius.value(), 0, shape.center, kind.surface.azimuthal_elements.value_or(24), kind.surface.axial_elements};
  if (!shape.axis) throw UserError("Particle/shape `cylinder` needs " + post.path("axis") + ": x1, x2 or x3.");
  post.axis = shape.axis->at(1) - '1';
  check_keys(kind, post);
  return post;
}

/// Returns the smallest distance of the axis of `post` from the axes of all periodic images of `other`. `same`: true if `post` and `other` are the
/// same post; its distance 0 from itself then does not count.
double distance(const Post& post, const Post& other, const stokes::PeriodicCell& cell, bool same) {
  double least = 1e300;
  for (const Vec3& image : cell.around({2, 2, 2})) {
    Vec3 apart = other.center + image - post.center;
    if (post.axis == other.axis) {
      apart[post.axis] = 0;
      if (!same || apart.norm() > 1e-9) least = std::min(least, apart.norm());
    } else {  // axes at right angles
      least = std::min(least, std::abs(apart[3 - post.axis - other.axis]));
    }
  }
  return least;
}

}  // namespace

std::string Post::path(const std::string& key) const {
  const std::string list = name.empty() ? "Particle" : "Particles/" + name;
  return key.empty() ? list : (name.empty() && (key == "Membrane" || key == "Adaptation/enabled") ? "" : list + "/") + key;
}

Vec3 period_of(const Post& post, const stokes::PeriodicCell& cell) {
  for (int d = 0; d < cell.n(); ++d) {
    const Vec3 vector = cell.vectors().col(d);
    if (std::abs(std::abs(vector[post.axis]) - vector.norm()) < 1e-9 * vector.norm()) return std::abs(vector[post.axis]) * Vec3::Unit(post.axis);
  }
  return Vec3::Zero();
}

void take_posts(Scene& scene) {
  for (const ParticleKind& kind : scene.particles)
    if (is_post(kind)) scene.posts.push_back(post_of(kind));
  std::erase_if(scene.particles, is_post);
  scene.only_solids = scene.particles.empty();
  if (!scene.only_solids) return;
  scene.particles.emplace_back().particle.shape.radius = scene.posts.front().radius;
}

void check_posts(const SharedOptions& shared) {
  const std::optional<stokes::PeriodicCell> cell = shared.domain.cell();
  if (shared.posts.empty()) {
    if (shared.flow.pressure_gradient && !shared.wall.solid)
      throw UserError(
          "Flow/pressure gradient needs two walls (Wall/distance) or posts (Particle/shape `cylinder`) in a Domain, because otherwise "
          "nothing resists the flow that it drives.");
    return;
  }
  if (shared.tube.present) return;  // rejected by reject_posts()
  if (!cell) throw UserError("Particle/shape `cylinder` needs a Domain: a post is one period of a cylinder along a periodic direction.");
  if (!shared.wall.solid && cell->n() < 3)
    throw UserError(
        "Particle/shape `cylinder` needs a Domain that is periodic in three directions, or walls: give Domain/periodic `x1 x2 x3` or "
        "Wall/distance. Otherwise the velocity due to the forces of posts would grow without limit far from them.");
  for (std::size_t p = 0; p < shared.posts.size(); ++p) {
    const Post& post = shared.posts[p];
    const int axis = post.axis + 1;
    if (period_of(post, *cell).isZero(0))
      throw UserError(formatted("%s is x%d, but no lattice vector of Domain is along x%d.", post.path("axis").c_str(), axis, axis));
    for (std::size_t q = 0; q <= p; ++q)
      if (distance(post, shared.posts[q], *cell, p == q) <= post.radius + shared.posts[q].radius)
        throw UserError(p == q ? post.path() + " touches its own image: its radius must be smaller than half the period across its axis."
                               : post.path() + " and " + shared.posts[q].path() + " touch each other.");
    for (const stokes::PlaneWall& wall : shared.wall.planes())
      if (wall.height(post.center) <= post.radius) throw UserError(post.path() + " touches the wall.");
  }
}

void reject_posts(const ParticleScene& particle_scene, Rejections& to) {
  const SharedOptions& shared = particle_scene;
  const bool posts = !shared.posts.empty();
  const Chosen cylinder("Particle/shape `cylinder`");
  to.pair(posts && shared.tube.present, cylinder, shared.duct_choice(), "a post extends over a whole period and would cross the wall");
  to.pair(posts && shared.wall.solid && !shared.wall.distance, cylinder, "Wall without Wall/distance",
          "the velocity due to the forces of posts would grow without limit far from the wall; give Wall/distance");
  to.pair(posts && !shared.tube.present && !shared.wall.solid && shared.flow.type != "quiescent", cylinder, shared.flow_choice(),
          "only a pressure gradient can drive a flow past posts; give Flow/type `quiescent` and Flow/pressure gradient");
  to.pair(posts && !shared.runs_in_time(), shared.sought(), cylinder,
          shared.only_solids ? "nothing deforms in a scene of posts only" : "a particle among posts drifts past them, so that no shape is steady");
  to.pair(posts && particle_scene.particle.drift == "held", cylinder, "Particle/drift `held`", "a particle among posts moves past them");
  to.pair(shared.flow.history && shared.only_solids, "Flow/history", "Particle/shape `cylinder` without other particles",
          "nothing moves, so that one steady problem is solved");
}

}  // namespace tanktread
