#pragma once
// Everything that a deck says about one run.

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/copies.hpp"
#include "scene/domain.hpp"
#include "scene/registry.hpp"
#include "scene/wall_options.hpp"
#include "system/solvers/options.hpp"
#include "system/symmetry.hpp"
#include "deck/expectation.hpp"
#include "membrane/options.hpp"
#include "membrane/surfactant_options.hpp"
#include "motion/adaptation.hpp"
#include "motion/options.hpp"
#include "motion/continuation.hpp"
#include "motion/periodic.hpp"
#include "motion/spectrum.hpp"
#include "motion/steady.hpp"
#include "record/files/options.hpp"
#include "quadrature/options.hpp"
#include "stokes/flow/flow_options.hpp"
#include "surface/options.hpp"

namespace tanktread {

namespace deck {
class Units;
}

class Rejections;
struct Scene;

/// `Particle/motion`.
enum class Motion { deforming, prescribed, free };

std::string text(Motion motion);  ///< as the deck has it, in `quotes`

/// `Particle/*`: the resting shape and what fills it.
struct ParticleOptions {
  surface::ParticleShape shape;
  double viscosity_ratio = 1;  ///< lambda
  Motion motion = Motion::deforming;
  std::optional<Vec3> velocity;          ///< of the centre, of a `prescribed` motion; zero if not given
  std::optional<Vec3> angular_velocity;  ///< about the centre; zero if not given
  std::optional<Vec3> force, torque;     ///< on a `free` body; zero if not given
  std::optional<double> density_difference;  ///< times `Flow/gravity` the body force per volume; zero if not given
  std::optional<std::string> drift;      ///< `free`, `held`; see holds_centre
  std::optional<std::string> forces;     ///< on a `prescribed` body: `reciprocal`, `integral`

  bool rigid() const { return motion != Motion::deforming; }
  std::string choice() const;  ///< "Particle/motion `free`", for sentences
  void declare(deck::Section& section);
  void reject(const Scene& scene, Rejections& to) const;  ///< what this motion of the scene's particle excludes
};

/// What may differ from particle to particle.
struct ParticleKind {
  std::string name;  ///< of the list Particles/<name>; empty of the only one
  ParticleOptions particle;
  membrane::Options membrane;
  surface::MeshOptions surface;
  coupling::InterfaceOptions interface;
  std::optional<membrane::SurfactantOptions> surfactant;  ///< Interface/surfactant; none: a clean interface
  const Registry* registry = &no_parts;                   ///< parts that the program adds
  std::vector<membrane::LoadParts::Chosen> loads;         ///< Membrane/loads
  std::vector<membrane::FieldParts::Chosen> fields;       ///< Interface/fields
  motion::AdaptationOptions adaptation;
  CopiesOptions copies;
  bool membrane_given = false;  ///< whether the deck has this list at all

  void declare(deck::Section& section);        ///< of Particles/<name>: the keys of Particle, and the other lists
  void declare_lists(deck::Section& section);  ///< Membrane, Surface, Interface and Adaptation
  void reject(const Scene& scene, Rejections& to) const;  ///< what mesh, membrane and interface of the scene's particle exclude
};

/// `Contact/*`: of several particles.
struct ContactOptions {
  double limit = 1e-3;  ///< smallest gap, over the R_C of the smallest particle, at which a run goes on
  bool limiter = false;  ///< whether gaps are held there by forces between the particles

  static constexpr double slack = 1e-2;  ///< by how much of the limit the limiter lets gaps beside its contacts fall below it
  double end() const { return (limiter ? 1 - 2 * slack : 1) * limit; }  ///< the gap, over the same R_C, below which the run ends

  void declare(deck::Section& section);
  void reject(const Scene& scene, Rejections& to) const;
};

/// The options of every room; one list of the deck each.
struct Scene : ParticleKind {
  stokes::FlowOptions flow;
  std::shared_ptr<const deck::Units> units;  ///< none: the deck does not say what its numbers stand for
  std::vector<ParticleKind> particles;  ///< Particles/<name>; none: the one particle that the scene itself is of
  ContactOptions contact;
  DomainOptions domain;
  WallOptions wall;
  surface::TubeOptions tube;
  coupling::VolumeOptions volume;
  quadrature::Options quadrature;
  motion::TimeOptions time;
  motion::SteadyOptions steady;
  motion::ContinuationOptions continuation;
  motion::SpectrumOptions spectrum;
  motion::PeriodicOptions periodic;
  coupling::SymmetryOptions symmetry;
  coupling::SolverOptions solvers;
  output::Options output;
  deck::Expectations expect;
  std::vector<SeriesParts::Chosen> series;  ///< Output/series
  bool volume_given = false;  ///< whether the deck has this list at all
  std::vector<std::pair<std::string, std::string>> files;  ///< that the deck names: where they are, and what the run keeps them as

  Scene() = default;
  explicit Scene(const Registry& parts) { registry = &parts; }

  void declare(deck::Section& root);

  /// One sentence (UserError) for what contradicts each other, within a list and between lists, or is too large.
  void check() const;
  bool runs_in_time() const { return !spectrum.present && !steady.present && !periodic.present; }  ///< otherwise steady shapes are looked at
  /// The list that asks for what is not a run in time.
  std::string sought() const { return steady.present ? "Steady" : periodic.present ? "Periodic" : "Spectrum"; }
  bool load_is_strong() const { return membrane.load == "strong"; }

  /// Returns true if the particles are solved for in one coupled system. Otherwise the scene is one rigid body and its resistance problem, which
  /// knows neither the balance of power, nor searches, nor forces of a wall, nor registered series, nor prescribed motion in a flow that changes.
  bool in_system() const {
    return !particles.empty() || !name.empty() || !particle.rigid() || (domain.present && !tube.present) || output.power_balance || !runs_in_time() ||
           tube.repulsion || !series.empty() || (flow.history && particle.motion == Motion::prescribed);
  }
  /// Returns true if gaps exist: between several particles, or between a particle and its periodic images.
  bool has_gaps() const { return !particles.empty() || domain.present; }

  /// The scene of each particle, as if it were alone.
  std::vector<Scene> alone() const;

  bool reciprocal_forces() const;    ///< `Particle/forces`, or its default
  double radius() const;             ///< R_C: of the sphere of equal volume
  double least_radius() const;       ///< the smallest R_C of all particles, over which gaps are measured
  double rate() const;               ///< speed over radius; of the membrane at rest, modulus/(viscosity x radius), where nothing else moves
  double speed() const;              ///< of Ca: rate x R_C, or the mean velocity in a tube; 0 of a flow without a gradient
  double modulus() const;            ///< G_s, or the surface tension of a drop; units force/length; 0 of a rigid body
  bool elastic() const { return !particle.rigid() && membrane.law != "surface tension"; }  ///< a membrane, not an interface of a drop
  bool viscous_membrane() const { return !particle.rigid() && membrane.viscosity.any(); }
  bool maxwell_membrane() const { return viscous_membrane() && membrane.relaxation_time; }
  bool kelvin_voigt_membrane() const { return viscous_membrane() && !membrane.relaxation_time; }
  bool has_velocity_system() const { return particle.rigid() || particle.viscosity_ratio != 1 || kelvin_voigt_membrane(); }
  Vec3 body_force() const;           ///< density difference x gravity, units force/length^3
  double bending_modulus() const;    ///< E_b, units force x length
  std::string interface_motion() const;  ///< of the control points: the deck's, or its default for the law
  bool lands_on_snapshots() const;   ///< whether steps are shortened to end there
  double snapshot_interval() const;  ///< simulated time between snapshots
  double next_snapshot(double now) const;  ///< the next multiple of it after `now`, or the final time
};

/// The largest number of control points that the wall of a tube may have. Each rank keeps the factors of the wall; those of all ranks together must
/// fit into the memory allowed.
double most_wall_points();

/// Whether the key at this path may differ when a run goes on: one that the checkpoint is not made of.
bool may_change_on_resume(const std::string& path);

}  // namespace tanktread
