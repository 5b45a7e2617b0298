// The particles of a scene: one scene for each of them, and the equation of the rigid bodies among them.

#include <algorithm>
#include <span>

#include "scene/scene.hpp"

namespace tanktread {

std::vector<Scene> Scene::alone() const {
  Scene common = *this;
  common.solvers.rigid_bodies = by_tractions() ? coupling::BodyEquation::first_kind : coupling::BodyEquation::second_kind;
  if (particles.empty()) return {common};
  std::vector<ParticleKind>().swap(common.particles);  // frees the memory, which clear() would keep in each copy
  std::vector<Scene> scenes(particles.size(), common);
  for (std::size_t p = 0; p < particles.size(); ++p) static_cast<ParticleKind&>(scenes[p]) = particles[p];
  return scenes;
}

/// Returns true if the unknowns of rigid bodies are tractions (Solvers/rigid bodies `first kind`). `auto` selects `first kind` for several bodies of
/// up to 1500 control points, all with adaptive meshes, or for the only particle in a duct, of up to 2000. For a film of a tenth of the radius,
/// `first kind` needs a third of the points of `second kind`. With 1538 points both take the same time for a sphere of 0.8 tube radii, and the
/// pressure drop has errors of 2e-8 and 1e-5.
bool Scene::by_tractions() const {
  using enum coupling::BodyEquation;
  if (solvers.rigid_bodies != automatic || !runs_in_time()) return solvers.rigid_bodies == first_kind;
  const ParticleKind* first = particles.empty() ? this : particles.data();
  const std::span kinds(first, std::max<std::size_t>(1, particles.size()));
  const bool alone = tube.present && kinds.size() == 1 && solvers.tube == "schur";
  double bodies = 0, points = 0;
  for (const ParticleKind& kind : kinds) {
    if (!kind.particle.rigid()) continue;
    if (!kind.adaptation.enabled && !alone) return false;
    ++bodies, points += kind.particle.shape.imported ? kind.particle.shape.imported->space.n_points : kind.surface.n_points();
  }
  return alone ? bodies > 0 && points <= 2000 : bodies > 1 && points <= 1500;
}

double Scene::least_radius() const {
  const auto radius_of = [](const ParticleKind& kind) { return kind.particle.shape.equivalent_radius(); };
  return particles.empty() ? radius() : radius_of(std::ranges::min(particles, {}, radius_of));
}

}  // namespace tanktread
