#pragma once
// Options of one particle, as read from the deck.

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/rejections.hpp"
#include "base/types.hpp"
#include "membrane/options.hpp"
#include "membrane/surfactant_options.hpp"
#include "motion/adaptation.hpp"
#include "scene/copies.hpp"
#include "scene/registry.hpp"
#include "surface/options.hpp"
#include "system/options.hpp"

namespace tanktread {

struct ParticleScene;

/// `Particle/motion`. A new motion needs a decision wherever Motion is asked: see the recipe of a kind of particle in lib/README.md.
enum class Motion { deforming, prescribed, free };
inline const std::vector<std::string> particle_motions{"deforming", "prescribed", "free"};  ///< words for Motion in decks

std::string text(Motion motion);  ///< returns the name of the motion in the deck, in backquotes

/// Options `Particle/*` of the deck: the resting shape, the inner fluid and the motion.
struct ParticleOptions {
  surface::ParticleShape shape;
  double viscosity_ratio = 1;  ///< lambda
  Motion motion = Motion::deforming;
  std::optional<Vec3> velocity;          ///< velocity of the centre of a body with `prescribed` motion; zero if not set
  std::optional<Vec3> angular_velocity;  ///< angular velocity of a body with `prescribed` motion about its centre; zero if not set
  std::optional<Vec3> force, torque;     ///< force and torque on a `free` body; zero if not set
  std::optional<double> density_difference;  ///< inner minus outer density, for the body force of `Flow/gravity`; zero if not set
  std::optional<std::string> drift;      ///< motion of the centroid, `free` or `held`; if not set, holds_centre() decides
  std::optional<std::string> forces;     ///< how forces on a `prescribed` body are computed: `reciprocal`, `integral`

  bool rigid() const;  ///< returns whether particles with this motion are rigid bodies
  std::string choice() const;  ///< returns for example "Particle/motion `free`", for messages
  void declare(deck::Section& section);
  void reject(const ParticleScene& particle_scene, Rejections& to) const;  ///< adds the choices that contradict the motion of the particle
};

/// Options that may differ between particles.
struct ParticleKind {
  std::string name;  ///< name of the section Particles/<name>; empty for a single particle
  ParticleOptions particle;
  membrane::Options membrane;
  surface::MeshOptions surface;
  coupling::InterfaceOptions interface;
  std::optional<membrane::SurfactantOptions> surfactant;  ///< Interface/surfactant; not set for a clean interface
  std::vector<membrane::LoadParts::Chosen> loads;         ///< Membrane/loads
  std::vector<membrane::FieldParts::Chosen> fields;       ///< Interface/fields
  motion::AdaptationOptions adaptation;
  CopiesOptions copies;
  bool membrane_given = false;  ///< true if the deck has the section Membrane
  bool implied = false;  ///< true if the deck gives none of the sections Particle, Particles and Membrane, which ask for a particle
  double duct_half_width = std::numeric_limits<double>::infinity();  ///< least distance of the axis of Tube or Channel from its wall, if known
  double field_length = 0;      ///< length by which values of surface fields are multiplied to become rows of a state x; 0: R_C of the particle

  std::string path() const { return name.empty() ? "Particle" : "Particles/" + name; }  ///< returns the section of the particle, for messages
  /// Declares Particles/<name>: the keys of Particle, and the inner sections `copies`, Membrane, Surface, Interface and Adaptation. `registry`:
  /// user-defined loads and fields.
  void declare(deck::Section& section, const Registry& registry);
  void declare_sections(deck::Section& section, const Registry& registry);  ///< declares the sections Membrane, Surface, Interface and Adaptation
  /// If the deck does not set Adaptation/film resolution, sets its default. A particle of the section Particles always has a default. The particle of
  /// the section Particle has one if `films` is true: if there are films around a single particle (SharedOptions::has_films_around_one).
  void complete_film_resolution(bool films);
  void reject(const ParticleScene& particle_scene, Rejections& to) const;  ///< adds the choices that contradict the mesh, membrane or interface
};

}  // namespace tanktread
