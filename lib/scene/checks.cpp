// Checks of all options of a scene.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/words.hpp"
#include "record/files/file.hpp"
#include "scene/memory.hpp"
#include "scene/posts.hpp"
#include "scene/scene.hpp"
#include "scene/series/series.hpp"

namespace tanktread {

namespace {

/// Throws UserError if the viscosity ratio is too large. The system for the velocity loses one digit to round-off per factor of ten in the ratio. The
/// solver stagnates at a ratio of 1e15 times the tolerance in a tube, and at higher ratios without a tube.
void check_viscosity_ratio(const ParticleScene& particle_scene) {
  const double ratio = particle_scene.particle.viscosity_ratio, most = 1e14 * particle_scene.solvers.tolerance;
  if (ratio > most)
    throw UserError(
        formatted("Particle/viscosity ratio must be at most %.3g, 1e14 times Solvers/tolerance, because rounding errors grow with it, but "
                  "is %.3g; for a rigid particle give Particle/motion `free`.",
                  most, ratio));
}

/// Throws UserError if a key of the particle needs another key or section that the deck does not have.
void check_needs(const ParticleScene& particle_scene) {
  if (particle_scene.particle.density_difference && !particle_scene.flow.gravity) throw UserError("Particle/density difference needs Flow/gravity.");
  if (particle_scene.adaptation.film_resolution && particle_scene.name.empty() && !particle_scene.has_films_around_one())
    throw UserError("Adaptation/film resolution needs several particles, a Domain or a wall, because otherwise there are no films.");
}

/// Throws UserError if the final time or the expected period is missing, or if it is not a multiple of the period of the flow.
void check_times(const Scene& scene) {
  const bool in_time = scene.runs_in_time() && !scene.continuation.present && !scene.only_solids;
  const auto moves = [](const ParticleKind& kind) { return kind.particle.motion != Motion::prescribed; };
  if (std::isnan(scene.time.final_time) && in_time && std::ranges::any_of(scene.particles, moves))
    throw UserError("Time/final time is missing: give the time at which the run ends, in the deck's unit of time.");
  if (scene.periodic.present && std::isnan(scene.periodic.period))
    throw UserError("Periodic/period is missing: give the expected period, in the deck's unit of time.");
  if (const auto& history = scene.flow.history; scene.periodic.present && history && history->frequency) {
    const double cycles = scene.periodic.period * *history->frequency;
    if (cycles < 0.5 || std::abs(cycles - std::round(cycles)) > 1e-9 * cycles)
      throw UserError(formatted("Periodic/period must be a multiple of the period of Flow/history, %.10g, but is %.10g.", 1 / *history->frequency,
                                scene.periodic.period));
  }
  if (const auto least = scene.time.minimum_step; least && in_time && !scene.lands_on_snapshots() && scene.snapshot_interval() < *least)
    throw UserError("Output/interval must not be shorter than Time/minimum step, because every step has at most one snapshot; it is " +
                    deck::number_text(scene.snapshot_interval()) + ".");
  if (scene.snapshot_interval() < 1e-6 * scene.time.final_time)
    throw UserError("Output/interval must be at least a millionth of Time/final time, " + deck::number_text(1e-6 * scene.time.final_time) +
                    ", but is " + deck::number_text(scene.snapshot_interval()) + ".");
}

/// Throws UserError if the deck describes what surrounds a particle, but does not ask for a particle.
void check_particle(const Scene& scene) {
  if (!scene.particles.front().implied || !(scene.has_films_around_one() || scene.medium())) return;
  throw UserError((scene.tube.present ? scene.tube.list() : scene.wall.present ? "Wall" : "Domain") +
                  " needs a particle, and this deck asks for none: give the section Particle, for example `Particle: {radius: 0.5}`, or Particles.");
}

/// Throws UserError if options of the sections that all particles share contradict each other.
void check_shared(const Scene& scene) {
  scene.flow.check();
  if (scene.flow.type == "duct" && !scene.tube.present)
    throw UserError("Flow/type `duct` needs a section Tube, with at least Tube/section, or a section Channel.");
  check_times(scene);
  if (scene.tube.present) scene.tube.check();
  scene.domain.check(scene.flow, scene.tube.present ? scene.tube.list() : "");
  if (scene.wall.present) scene.wall.check(scene.flow, scene.domain.cell());
  check_posts(scene);
  check_posts_memory(scene);
}

/// Checks each of several particles as a separate scene, and checks that the particles can be combined in one scene. Throws UserError with the name
/// of the particle in the message.
void check_several(const Scene& scene) {
  const std::vector<ParticleScene> alone = scene.particle_scenes();
  const bool strong = scene.first_deforming().load_is_strong();
  for (ParticleScene one : alone) {
    one.volume_given = one.volume_given && !one.particle.rigid();  // the section Volume applies only to deformable particles
    const std::string list = one.path();
    if (!one.particle.rigid() && one.load_is_strong() != strong)
      throw UserError(list + "/Membrane/load must be the same for all deforming particles.");
    if (one.particle.drift == "held" && alone.size() > 1)
      throw UserError(list + "/drift `held` is for a single particle: held at their places, particles would not move relative to each other.");
    try {
      one.check();
    } catch (UserErrors& errors) {
      for (std::string& sentence : errors.all) sentence.insert(0, list + ": ");
      throw UserErrors(errors.all);
    } catch (const UserError& error) {
      throw UserError(list + ": " + error.what());
    }
  }
}

/// Throws UserError if a particle or a post has the name of a series of the run, or if the copy of a file that the deck names would have the name of
/// a file of the results. Series of particles and posts are stored under their names, and the copy of a particle's file is named after the particle.
void check_names(const Scene& scene) {
  Columns columns = run_columns(scene);
  SteadyRow().add_columns(scene, columns);
  const auto check_name = [&](const std::string& name, const std::string& path) {
    if (std::ranges::find(columns.all(), name, &Column::name) != columns.all().end())
      throw UserError(path + " has the name of a series of the run: give it another name.");
  };
  for (const ParticleKind& kind : scene.particles) check_name(kind.name, kind.path());
  for (const Post& post : scene.posts) check_name(post.name, post.path());
  for (const auto& [file, kept] : scene.files)
    if (output::is_result(kept))
      throw UserError("The copy of " + file + " would have the name of a file of the results, " + kept +
                      ": give another name to the particle, or to the file.");
}

/// Throws UserError if the mesh cannot have the element lengths that the adaptation requires.
void check_adaptation(const ParticleScene& particle_scene) {
  if (!particle_scene.adaptation.enabled) return;
  // Element length: side of a square with the mean element area on the sphere of equal volume.
  const double area = 4 * std::numbers::pi * particle_scene.radius() * particle_scene.radius();
  particle_scene.adaptation.check(static_cast<int>(particle_scene.surface.n_points()), std::sqrt(area / particle_scene.surface.n_elements()));
}

}  // namespace

void Scene::check() const {
  check_particle(*this);
  if (solvers.rigid_bodies == coupling::BodyEquation::first_kind) check_first_kind(*this);
  check_shared(*this);
  Rejections found;
  reject_power(*this, first_deforming().load_is_strong(), found);
  if (only_solids) {
    first().reject_surroundings(found);
    found.throw_if_any();
  } else if (!named()) {
    first().check(std::move(found));
  } else {
    check_several(*this);
    found.throw_if_any();
  }
  check_names(*this);
}

void ParticleScene::check(Rejections found) const {
  check_needs(*this);
  particle.shape.check();
  surface.check();
  check_viscosity_ratio(*this);
  if (!particle.rigid()) membrane.check();
  if (surfactant) surfactant->check(), surfactant->diffusivity_of(flow.rate(), radius());
  reject(found);
  found.throw_if_any();
  modulus();  // throws UserError if the deck does not determine it
  time_options().check();
  check_adaptation(*this);
  check_memory(*this);
}

}  // namespace tanktread
