// The particles of a scene: one scene for each of them, and the equation of the rigid bodies among them.

#include <algorithm>
#include <limits>

#include "scene/scene.hpp"

namespace tanktread {

std::vector<ParticleScene> Scene::particle_scenes() const {
  std::vector<ParticleScene> scenes;
  for (const ParticleKind& kind : particles) scenes.emplace_back(*this, kind);
  const auto equation = by_tractions() ? coupling::BodyEquation::first_kind : coupling::BodyEquation::second_kind;
  for (ParticleScene& one : scenes) one.solvers.rigid_bodies = equation;
  return scenes;
}

ParticleScene Scene::first_deforming() const {
  const auto found = std::ranges::find_if(particles, [](const ParticleKind& kind) { return !kind.particle.rigid(); });
  return {*this, found == particles.end() ? particles.front() : *found};
}

/// Returns true if the unknowns of rigid bodies are tractions (Solvers/rigid bodies `first kind`). `auto` selects `first kind` for several bodies of
/// up to 1500 control points, all with adaptive meshes, or for the only particle in a duct, of up to 2000. For a film of a tenth of the radius,
/// `first kind` needs a third of the points of `second kind`. With 1538 points both take the same time for a sphere of 0.8 tube radii, and the
/// pressure drop has errors of 2e-8 and 1e-5.
bool Scene::by_tractions() const {
  using enum coupling::BodyEquation;
  if (solvers.rigid_bodies != automatic || !runs_in_time()) return solvers.rigid_bodies == first_kind;
  const bool alone = tube.present && particles.size() == 1 && solvers.tube == "schur";
  double bodies = 0, points = 0;
  for (const ParticleKind& kind : particles) {
    if (!kind.particle.rigid()) continue;
    if (!kind.adaptation.enabled && !alone) return false;
    ++bodies, points += kind.particle.shape.imported ? kind.particle.shape.imported->space.n_points : kind.surface.n_points();
  }
  return alone ? bodies > 0 && points <= 2000 : bodies > 1 && points <= 1500;
}

double Scene::least_radius() const {
  double least = std::numeric_limits<double>::infinity();
  for (const ParticleKind& kind : particles) least = std::min(least, kind.particle.shape.equivalent_radius());
  return least;
}

bool Scene::adapts() const {
  return std::ranges::any_of(particles, [](const ParticleKind& kind) { return kind.adaptation.enabled; });
}

bool Scene::lands_on_snapshots() const {
  return output.between_steps ? *output.between_steps == "land" : !time.fixed_step || adapts();
}

}  // namespace tanktread
