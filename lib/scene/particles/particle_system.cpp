#include "scene/particles/particle_system.hpp"

#include "scene/particles/gaps.hpp"

namespace tanktread {

std::unique_ptr<ParticleSystem> make_particle_system(const Scene& scene, coupling::Ranks& ranks, Phases& phases) {
  return scene.in_system() ? make_coupled_particles(scene, ranks, phases) : make_free_body(scene, ranks, phases);
}

void check_room(const Scene& scene) {
  if (scene.only_solids) return;
  if (scene.in_system()) checked_members(scene);
  else make_body(scene.first());
}

void check_start(const Scene& scene) {
  if (scene.only_solids || scene.is_resistance_problem()) return check_room(scene);
  coupling::Ranks ranks;
  Phases phases;
  make_particle_system(scene, ranks, phases);
}

}  // namespace tanktread
