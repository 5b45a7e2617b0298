#include "scene/memory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Teuchos_ParameterList.hpp>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "scene/scene.hpp"
#include "scene/solids.hpp"
#include "scene/tube.hpp"
#include "surface/walls/channel.hpp"
#include "system/parallel/ranks.hpp"
#include "system/frozen/frozen_operator.hpp"
#include "system/solids/ducts/wall.hpp"

namespace tanktread {

namespace {

constexpr double most_bytes = 64e9;        // largest size of the assembled operators of one surface, summed over all ranks
constexpr double doubles = 72;             // bytes of a 3 x 3 block of doubles
constexpr double most_vector_bytes = 4e9;  // largest size of the vectors of an iterative solver, on one rank

/// Return the numbers of control points: points() of the particle, wall_points() of the tube wall.
double points(const ParticleScene& particle_scene) {
  const auto& imported = particle_scene.particle.shape.imported;
  return imported ? imported->space.n_points : particle_scene.surface.n_points();
}

double wall_points(const SharedOptions& shared) {
  const auto with = [&](int along) { return shared.tube.azimuthal_elements * (along + 3.0); };
  switch (shared.tube.kind()) {
    case surface::DuctKind::straight_tube: return with(shared.tube.elements_along());
    case surface::DuctKind::channel: return with(surface::Channel(shared.tube).elements());
  }
  throw std::logic_error("unknown DuctKind");
}

/// Returns the bytes of all assembled operators of the particle per pair of control points. A layer operator has 3 x 3 doubles per pair, and a frozen
/// operator six numbers of 16 bits. An operator with the option `auto` is not counted, because it is not assembled if it is too large.
double bytes_a_pair(const ParticleScene& particle_scene) {
  // A rigid particle has LU factors, and in a tube also the matrix.
  if (particle_scene.particle.rigid()) return doubles * coupling::Ranks().size() * (particle_scene.tube.present ? 2 : 1);
  const bool viscous = particle_scene.particle.viscosity_ratio != 1;
  const int frozen = particle_scene.time.assembles() ? (particle_scene.solvers.frozen_operator == "assembled") + viscous : 0;
  const bool relaxed = particle_scene.interface_motion() == coupling::MeshMotion::relaxed;
  return doubles * ((viscous + particle_scene.kelvin_voigt_membrane()) * (particle_scene.solvers.double_layer == "assembled") + relaxed) +
         coupling::FrozenOperator::bytes_a_pair * frozen;
}

/// Throws UserError if the assembled operators for `n_points` control points are too large. The message begins "<keys> must <must>", where `keys` are
/// the keys of the deck that determine this number.
void check_bytes(const std::string& keys, const std::string& must, double n_points, double bytes) {
  if (bytes * n_points * n_points > most_bytes)
    throw UserError(
        keys + " must " + must +
        formatted(": the assembled boundary-integral operators of %.0f control points take %.0f GB, more than the limit of %.0f GB.",
                  n_points, bytes * n_points * n_points / 1e9, most_bytes / 1e9));
}

/// Throws UserError if the assembled operators of the particle or of the wall of a duct are too large.
void check_size(const ParticleScene& particle_scene) {
  const double bytes = bytes_a_pair(particle_scene), most = std::floor(std::sqrt(most_bytes / bytes));
  const std::string few = formatted("give at most %.0f control points", most);
  if (particle_scene.particle.shape.imported)
    check_bytes("Particle/file", few, points(particle_scene), bytes);
  else if (particle_scene.surface.polar())
    check_bytes("Surface/azimuthal elements and Surface/meridional elements", few, points(particle_scene), bytes);
  else
    check_bytes("Surface/elements per side",
                formatted("be at most %.0f, but is %d", std::floor(std::sqrt((most - 2) / 6)), *particle_scene.surface.elements_per_side),
                points(particle_scene), bytes);
  const surface::TubeOptions& tube = particle_scene.tube;
  if (!tube.present) return;
  if (surface::properties(tube.kind()).may_iterate && coupling::WallSolver{particle_scene.solvers.wall}.may_iterate(tube.period > 0)) return;
  check_bytes(tube.list() + "/azimuthal elements and " + tube.list() + "/axial elements",
              formatted("give at most %.0f control points", most_wall_points()), wall_points(particle_scene), doubles * coupling::Ranks().size());
}

/// Throws UserError if the vectors that each rank stores for an iterative solver, and the matrix of their inner products, are too large.
void check_vectors(const ParticleScene& particle_scene, const std::string& path, const std::shared_ptr<Teuchos::ParameterList>& list) {
  const double unknowns = 3 * (points(particle_scene) + (particle_scene.tube.present ? wall_points(particle_scene) : 0));
  double vectors = 1;
  std::string keys;
  for (const char* key : {"Num Blocks", "Block Size", "Num Recycled Blocks", "Deflation Blocks", "Adaptive Block Size"}) {
    if (!list || !list->isType<int>(key)) continue;
    vectors *= std::max(1, list->get<int>(key));
    keys += (keys.empty() ? std::string() : " and ") + path + "/Belos/" + key;
  }
  const double most = std::floor((std::sqrt(unknowns * unknowns + 4 * most_vector_bytes / 8) - unknowns) / 2);
  if (vectors > most)
    throw UserError(keys + formatted(" may ask for at most %.0f vectors, which with %.0f unknowns take %.0f GB on each rank, but %.0f are asked for.",
                                     most, unknowns, most_vector_bytes / 1e9, vectors));
}

}  // namespace

double most_wall_points() { return std::floor(std::sqrt(most_bytes / (doubles * coupling::Ranks().size()))); }

void check_memory(const ParticleScene& particle_scene) {
  check_size(particle_scene);
  check_vectors(particle_scene, "Solvers", particle_scene.solvers.belos);
  for (const coupling::IterativeOptions* system : particle_scene.solvers.systems()) check_vectors(particle_scene, system->path, system->belos);
}

void check_first_kind(const Scene& scene) {
  double n_points = 0;
  for (const ParticleScene& one : scene.particle_scenes())
    if (one.particle.rigid()) n_points += points(one);
  if (n_points == 0) throw UserError("Solvers/rigid bodies `first kind` is for rigid bodies, but every Particle deforms.");
  check_bytes("Solvers/rigid bodies", "be `second kind`", n_points, 2 * doubles * coupling::Ranks().size());
}

void check_posts_memory(const Scene& scene) {
  if (scene.posts.empty() || scene.tube.present) return;
  check_bytes("Surface/azimuthal elements and Surface/axial elements of posts", formatted("give at most %.0f control points", most_wall_points()),
              solid_points(scene), doubles * coupling::Ranks().size());
}

}  // namespace tanktread
