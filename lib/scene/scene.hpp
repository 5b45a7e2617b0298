#pragma once
// All options of a run, as read from its deck.
//
// How wrong options are reported:
//   range of a key, check()  a value is wrong by itself, a key is missing, or numbers do not fit each other: throws UserError
//   Rejections::pair         two choices exclude each other: in a function reject...(), so that `--rejections` lists the combination
//   refuse()                 two keys exclude each other: two keys for one quantity, a key of another choice of its own section, or sections that
//                            cannot be read together. Sections that cannot be read together are also listed by reject_unread() (scene/rejections.cpp)
//   idle_keys                a key has no effect: the run warns. On a post such a key is an error, see take_posts()
//
// The types that describe a particle. Each contains the type above it, or is built from it:
//   ParticleOptions    keys of the section Particle (scene/particle_kind.hpp)
//   ParticleKind       all sections of one particle; Scene::particles has one per particle (scene/particle_kind.hpp)
//   ParticleScene      a ParticleKind and the options that all particles share: the argument of functions about one particle
//   Body               spaces, control nets and moduli on the current mesh (scene/body.hpp)
//   Member             a ParticleScene with its Body and its rows in the nets of all particles, for the time of a run (scene/member.hpp)
//   coupling::Particle data of a Member that the coupled system uses (system/particle.hpp)
//   RecordedParticle   data of a Member that user-defined series use (scene/registry.hpp)

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "accuracy/request.hpp"
#include "base/rejections.hpp"
#include "scene/contact_options.hpp"
#include "scene/domain.hpp"
#include "scene/particle_kind.hpp"
#include "scene/posts.hpp"
#include "scene/registry.hpp"
#include "scene/wall_options.hpp"
#include "system/solvers/options.hpp"
#include "system/symmetry.hpp"
#include "system/options.hpp"
#include "deck/expectation.hpp"
#include "motion/options.hpp"
#include "motion/continuation.hpp"
#include "motion/periodic.hpp"
#include "motion/spectrum.hpp"
#include "motion/steady.hpp"
#include "record/files/options.hpp"
#include "quadrature/options.hpp"
#include "stokes/flow/flow_options.hpp"
#include "surface/walls/duct_options.hpp"

namespace tanktread {

namespace coupling {
struct SharedWalls;
}
namespace deck {
class Units;
}

/// Search for shapes or motions that takes the place of a run in time: the section of the deck that asks for it. `spectrum` is the spectrum of the
/// initial shape; that of a shape that is searched for belongs to the other searches.
enum class Search { none, steady, periodic, spectrum };

/// Options of the searches for shapes and motions, with one section of the deck each.
struct SearchOptions {
  motion::SteadyOptions steady;
  motion::ContinuationOptions continuation;
  motion::SpectrumOptions spectrum;
  motion::PeriodicOptions periodic;
};

/// Options of a deck that all particles share, with one section of the deck each.
struct SharedOptions : SearchOptions {
  const Registry* registry = &no_parts;  ///< user-defined parts
  stokes::FlowOptions flow;
  std::shared_ptr<const deck::Units> units;  ///< units of the deck's values; null if the deck does not set them
  ContactOptions contact;
  DomainOptions domain;
  WallOptions wall;
  std::vector<Post> posts;    ///< cylinders among the particles of the deck, in the order of the deck
  bool only_solids = false;   ///< true if all particles of the deck are posts; then nothing moves
  surface::TubeOptions tube;
  coupling::VolumeOptions volume;
  quadrature::Options quadrature;
  motion::TimeOptions time;
  coupling::SymmetryOptions symmetry;
  coupling::SolverOptions solvers;
  output::Options output;
  deck::Expectations expect;
  accuracy::Options accuracy;
  std::vector<SeriesParts::Chosen> series;  ///< Output/series
  std::vector<EquationParts::Chosen> equations;  ///< Equations
  bool volume_given = false;  ///< true if the deck has the section Volume
  std::shared_ptr<coupling::SharedWalls> walls;  ///< walls, plates and posts, which the systems of one search share
  std::vector<std::pair<std::string, std::string>> files;  ///< files that the deck names: path, and name of the copy that the run keeps

  Search search() const {
    return steady.present ? Search::steady : periodic.present ? Search::periodic : spectrum.present ? Search::spectrum : Search::none;
  }
  bool runs_in_time() const { return search() == Search::none; }
  bool varies_in_time() const { return flow.history.has_value(); }  ///< whether the deck prescribes a change in time, so that nothing is steady
  static constexpr const char* any_search = "Steady, Periodic or Spectrum";  ///< the sections of all searches, for messages
  /// Returns true if a single particle has films of fluid next to it: at a wall, or between the particle and its periodic images.
  bool has_films_around_one() const { return wall.present || tube.present || domain.present; }
  Chosen sought() const;  ///< returns the section of search(), for messages about rejected combinations
  /// Returns the type of the flow, for messages about rejected combinations.
  Chosen flow_choice() const { return {flow.choice(), "Flow/type"}; }
  /// Returns the section that describes a duct, for messages about rejected combinations.
  Chosen duct_choice() const { return {tube.list(), "Tube or Channel"}; }
  /// Returns the medium, which replaces the free-space kernels: the plane wall of the section Wall, or a medium chosen by Domain/kind that a program
  /// built on this library has added. Null in all other scenes.
  std::shared_ptr<const stokes::Medium> medium() const;
  double snapshot_interval() const;        ///< simulated time between snapshots
  double next_snapshot(double now) const;  ///< next multiple of snapshot_interval() after `now`, but at most the final time
};

/// Returns the key or section of the deck that requires a coupled system of all particles; empty if no system is required. No system is required if
/// the scene has only solids, or if it is the motion or resistance problem of one rigid body, `kind`, which is then the only particle.
std::string_view why_in_system(const SharedOptions& shared, const ParticleKind& kind);

/// One particle of a scene, with the options that it shares with the others.
struct ParticleScene : SharedOptions, ParticleKind {
  ParticleScene() = default;
  ParticleScene(const SharedOptions& shared, const ParticleKind& kind) : SharedOptions(shared), ParticleKind(kind) {}

  /// smallest radius R_C of all particles, by which gaps are divided; not set for a particle without a Scene, or if the size of a particle is unknown
  std::optional<double> least_radius;

  /// Throws UserError if options of this particle contradict each other or shared options, or if the problem is too large. Scene::check() checks the
  /// shared options before. `found`: rejected combinations of the whole scene.
  void check(Rejections found = Rejections()) const;
  void reject(Rejections& to) const;  ///< adds the combinations of choices that the program rejects
  void reject_surroundings(Rejections& to) const;  ///< adds those about walls, ducts, posts and periodic cells only
  bool load_is_strong() const { return membrane.load == "strong"; }

  bool in_system() const { return !why_in_system(*this, *this).empty(); }  ///< see Scene

  /// Returns the options of the time integration, with `unit` set to the time scale 1/rate() of the particle.
  motion::TimeOptions time_options() const;
  bool reciprocal_forces() const;    ///< true if forces are computed by the reciprocal theorem, as set by `Particle/forces` or by default
  double contact_length(double gap) const { return gap * least_radius.value_or(radius()); }  ///< returns a gap in units of length
  double radius() const { return particle.shape.equivalent_radius(); }  ///< R_C, radius of the sphere of equal volume
  double rate() const;               ///< speed/R_C; if the speed is 0, modulus/(viscosity x R_C), or 1 for a rigid body; units 1/time
  /// speed in the capillary number: rate of the flow x R_C, or the mean velocity in a tube; 0 for a flow without gradient
  double speed() const;
  double unit_speed() const { return speed() > 0 ? speed() : rate() * radius(); }  ///< unit of velocities: speed(), or rate() x R_C if speed() is 0
  double modulus() const;            ///< shear modulus G_s, or the surface tension of a drop; units force/length; 0 for a rigid body
  bool elastic() const { return !particle.rigid() && !membrane.fluid_interface(); }  ///< true for a membrane, false for a drop or rigid body
  bool viscous_membrane() const { return !particle.rigid() && membrane.viscosity.any(); }
  bool maxwell_membrane() const { return viscous_membrane() && membrane.relaxation_time; }
  bool kelvin_voigt_membrane() const { return viscous_membrane() && !membrane.relaxation_time; }
  bool has_velocity_system() const { return particle.rigid() || particle.viscosity_ratio != 1 || kelvin_voigt_membrane(); }
  Vec3 body_force() const;           ///< density difference x gravity, units force/length^3
  /// Returns the key that gives a net force on the particle; empty if the net force is zero. The forces of registered loads are not known.
  std::string_view net_force() const;
  double bending_modulus() const;    ///< E_b, units force x length
  coupling::MeshMotion interface_motion() const;  ///< motion of the control points along the interface: as set in the deck, or the default of the law
};

/// Adds the choices that exclude the power balance (6.11) of all particles. `strong`: true for Membrane/load `strong`.
void reject_power(const SharedOptions& shared, bool strong, Rejections& to);

/// Options of all modules: the shared options and the options of each particle.
struct Scene : SharedOptions {
  /// Particles in the order of the deck, at least one after declare(). A deck with the section Particle has one particle without a name. In a scene
  /// of posts only, a single particle represents the size of the posts.
  std::vector<ParticleKind> particles;
  std::vector<std::string> idle_keys;  ///< sentences about keys that the deck gives although they have no effect
  std::vector<std::string> unusual_values;  ///< sentences about values whose size is unusual

  Scene() = default;
  explicit Scene(const Registry& parts) { registry = &parts; }

  /// Reads the deck. Sections are declared in an order in which each may use the sections before it: Flow, Tube and Channel before Surface, because
  /// the default mesh depends on the width of the duct; Domain before Solvers. Options that follow from several sections are set at the end
  /// (complete_derived). Then files are read and copies expanded, see prepare() in app/deck_files.cpp; check() comes last.
  void declare(deck::Section& root);

  /// Throws UserError if options of one or several sections contradict each other, or if the problem is too large.
  void check() const;

  /// Returns true if the deck has the section Particles, even with only one particle. The result affects the names of series and arrays, whether a
  /// single rigid body is solved without the coupled system, and the defaults of Adaptation/film resolution and Output/between steps.
  bool named() const { return !particles.front().name.empty(); }

  /// Return the scenes of all particles, and of the first one. In them, Solvers/rigid bodies is not `auto`.
  std::vector<ParticleScene> particle_scenes() const;
  ParticleScene first() const { return of(particles.front(), common()); }
  /// Returns the scene of the first particle that deforms, or the first particle if all are rigid.
  ParticleScene first_deforming() const;
  bool by_tractions() const;  ///< returns true if the unknowns of rigid bodies are tractions, by the integral equation of the first kind (2.40)

  /// Returns true if the particles are solved for in one coupled system. Otherwise the scene is the motion or resistance problem of one rigid body.
  bool in_system() const { return !why_in_system(*this, particles.front()).empty(); }
  /// Returns true if the scene is the resistance problem of one body with prescribed motion.
  bool is_resistance_problem() const { return !only_solids && particles.front().particle.motion == Motion::prescribed && !in_system(); }
  /// Returns true if the scene changes in time, so that its run can be resumed; false for steady problems, searches and spectra.
  bool has_time() const { return runs_in_time() && !only_solids && !is_resistance_problem(); }
  /// Returns true if gaps exist: between several particles, or between a particle and its periodic images.
  bool has_gaps() const { return particles.size() > 1 || domain.present; }

  motion::TimeOptions time_options() const { return first_deforming().time_options(); }  ///< see ParticleScene
  double rate() const { return first_deforming().rate(); }                               ///< see ParticleScene
  double least_radius() const;       ///< smallest radius R_C of all particles, by which gaps are divided
  bool adapts() const;               ///< returns true if the mesh of a particle may change
  bool lands_on_snapshots() const;   ///< true if steps are shortened so that they end at snapshots

 private:
  /// Data that follow from all particles and that each ParticleScene contains.
  struct Common {
    coupling::BodyEquation rigid_bodies;
    std::optional<double> least_radius;
  };
  Common common() const;
  ParticleScene of(const ParticleKind& kind, const Common& common) const;
};

/// Reasons that several rejections share.
namespace reason {
constexpr const char* rigid = "a rigid particle has no membrane and no fluid inside, and keeps its resting shape, which Particle/shape gives";
constexpr const char* prescribed = "the motion of the body is given, so that its position, orientation and force are not unknown";
constexpr const char* strong = "it needs loads by virtual work, `weak`";
constexpr const char* desingularised =
    "its identities hold in unbounded fluid for closed surfaces with a normal at all points; give `adaptive` or `fixed`";
constexpr const char* unsteady = "nothing is steady in a flow or a cell that changes in time";
constexpr const char* drift = "it is for a particle that deforms in unbounded fluid, in a flow whose gradient is uniform";
constexpr const char* interface = "only the interface of a drop slides over the fluid and can have a surfactant";
}  // namespace reason

/// Reasons why sections or keys cannot be read together. Scene::declare refuses them while it reads a deck, and reject_unread()
/// (scene/rejections.cpp) lists them.
namespace unread {
constexpr const char* two_ducts = "a scene has one duct; give one of them";
constexpr const char* two_periods = "both give the period along x1";
constexpr const char* one_and_several = "give it for each particle in Particles/<name>, or for all particles in Particles/defaults";
constexpr const char* two_meshes = "the file determines the spline space";
}  // namespace unread

/// Returns true if the key at this path may change when a run is resumed, because the data of the checkpoint do not depend on it. Keys of sections
/// that this function does not name may not change.
bool may_change_on_resume(const std::string& path);

/// Returns the table of all rejected combinations as Markdown, sorted by the first choice.
std::string rejection_table(const Registry& registry);

}  // namespace tanktread
