#include "scene/posts.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "scene/scene.hpp"

namespace tanktread {

namespace {

bool is_post(const ParticleKind& kind) { return kind.particle.shape.shape == "cylinder"; }

/// Keys of the section of a post that a post can have. The key `shape` is set on every post.
constexpr const char* keys_of_post[] = {"radius", "axis", "center"};

/// Returns true if the sentence `idle` of Section::idle_keys is about the key or section at `path`.
bool is_about(const std::string& idle, const std::string& path) {
  return idle.starts_with(path + "/") || idle.starts_with(path + " has no effect");
}

/// Moves the sentences about keys that a post cannot have from `idle`, the keys without effect in the deck, to `wrong`. Removes the sentences about
/// keys that a post can have. Keys of Surface stay in `idle`, because a post often takes them from Particles/defaults.
void check_keys(const Post& post, std::vector<std::string>& idle, std::vector<std::string>& wrong) {
  std::vector<std::string> left;
  for (std::string& sentence : idle) {
    const auto is_of = [&](const char* key) { return is_about(sentence, post.path(key)); };
    const bool of_post = is_of("") || is_of("Interface") || is_of("Adaptation");
    if (!of_post || is_of("Surface")) left.push_back(std::move(sentence));
    else if (std::ranges::none_of(keys_of_post, is_of)) wrong.push_back(std::move(sentence));
  }
  idle = std::move(left);
}

/// Adds a sentence to `wrong` for each section that the deck gives although a post cannot have it.
void check_sections(const ParticleKind& kind, const Post& post, std::vector<std::string>& wrong) {
  const std::pair<const char*, bool> sections[] = {{"initial shape", kind.particle.shape.initial.has_value()},
                                                   {"copies", kind.copies.present},
                                                   {"Membrane", kind.membrane_given},
                                                   {"Interface/surfactant", kind.surfactant.has_value()},
                                                   {"Interface/fields", !kind.fields.empty()}};
  for (const auto& [section, given] : sections)
    if (given)
      wrong.push_back(contradiction(post.path(section), "Particle/shape `cylinder`", "a cylinder is a fixed post, which does not move or deform"));
}

Post post_of(const ParticleKind& kind) {
  const surface::ParticleShape& shape = kind.particle.shape;
  Post post{kind.name, shape.radius.value(), 0, shape.center, kind.surface.azimuthal_elements.value_or(24), kind.surface.axial_elements};
  if (!shape.axis) throw UserError("Particle/shape `cylinder` needs " + post.path("axis") + ": x1, x2 or x3.");
  post.axis = shape.axis->at(1) - '1';
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
  if (key.empty()) return list;
  const bool outside = name.empty() && std::isupper(static_cast<unsigned char>(key.front())) != 0;  // Membrane is next to Particle, not in it
  return outside ? key : list + "/" + key;
}

Vec3 period_of(const Post& post, const stokes::PeriodicCell& cell) {
  for (int d = 0; d < cell.n(); ++d) {
    const Vec3 vector = cell.vectors().col(d);
    if (std::abs(std::abs(vector[post.axis]) - vector.norm()) < 1e-9 * vector.norm()) return std::abs(vector[post.axis]) * Vec3::Unit(post.axis);
  }
  return Vec3::Zero();
}

void take_posts(Scene& scene) {
  std::vector<std::string> wrong;
  for (const ParticleKind& kind : scene.particles) {
    if (!is_post(kind)) continue;
    const Post& post = scene.posts.emplace_back(post_of(kind));
    check_keys(post, scene.idle_keys, wrong);
    check_sections(kind, post, wrong);
  }
  require_none(std::move(wrong));
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
  to.pair(shared.varies_in_time() && shared.only_solids, "Flow/history", "Particle/shape `cylinder` without other particles",
          "nothing moves, so that one steady problem is solved");
}

}  // namespace tanktread
