#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Teuchos_ParameterList.hpp>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/units.hpp"
#include "deck/words.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "surface/channel.hpp"
#include "system/ranks.hpp"
#include "system/solvers/frozen_operator.hpp"

namespace tanktread {

namespace {

/// The list Output.
struct OutputList {
  Scene& scene;

  void declare(deck::Section& section) {
    scene.output.declare(section);
    scene.series = scene.registry->series.read(section, "series", "series that this program adds to the record, none without this list");
  }
};

/// The list Channel.
struct ChannelList {
  surface::TubeOptions& tube;

  void declare(deck::Section& section) {
    tube.channel.emplace();
    tube.declare(section);
  }
};

/// The list Particles.
struct Kinds {
  std::vector<ParticleKind>& all;
  const Registry* registry;

  void declare(deck::Section& section) {
    section.each(
        "one of several particles: keys of Particle, and lists Membrane, Surface, Interface and Adaptation as they stand in a deck with one. What "
        "it does not say itself it takes from the list that its key `like` names, or from Particles/defaults",
        [this](const std::string& name, deck::Section& inner) {
          all.emplace_back().name = name;
          all.back().registry = registry;
          all.back().declare(inner);
        },
        true);
    if (section.documenting()) all.clear();
    else if (all.empty()) throw UserError(section.path() + " names no particle.");
  }
};

constexpr double most_bytes = 64e9;  // of the assembled operators of one surface, on all ranks together
constexpr double doubles = 72;       // bytes of three rows and columns of one
constexpr double most_vector_bytes = 4e9;  // of an iterative solver, on one rank

/// Control points of the particle, and of the wall of its tube.
double points(const Scene& scene) {
  const auto& imported = scene.particle.shape.imported;
  return imported ? imported->space.n_points : scene.surface.n_points();
}

double wall_points(const Scene& scene) {
  const int along = scene.tube.channel ? surface::Channel(scene.tube).elements() : scene.tube.axial_elements;
  return scene.tube.azimuthal_elements * (along + 3.0);
}

/// Bytes a pair of control points of what the particle's layers are assembled in: rows of doubles, and frozen operators of six entries of 16 bits.
/// `auto` assembles nothing that is too large.
double bytes_a_pair(const Scene& scene) {
  if (scene.particle.rigid()) return doubles;
  const bool viscous = scene.particle.viscosity_ratio != 1;
  const int frozen = scene.time.assembles() ? (scene.solvers.frozen_operator == "assembled") + viscous : 0;
  return doubles * ((viscous + scene.viscous_membrane()) * (scene.solvers.double_layer == "assembled") + (scene.interface_motion() == "relaxed")) +
         coupling::FrozenOperator::bytes_a_pair * frozen;
}

/// The system for the velocity loses a digit to rounding with each power of ten: in a tube, where that shows first, it stagnates at 1e15 times the
/// tolerance.
void check_viscosity_ratio(const Scene& scene) {
  const double ratio = scene.particle.viscosity_ratio, most = 1e14 * scene.solvers.tolerance;
  if (ratio > most)
    throw UserError(formatted("Particle/viscosity ratio must be at most %.3g, 1e14 times Solvers/tolerance, for rounding grows with it, but is %.3g; "
                              "a particle that does not deform is rigid: Particle/motion `free`.",
                              most, ratio));
}

/// `keys` say how many points there are: `must` is what they must be.
void check_bytes(const std::string& keys, const std::string& must, double n_points, double bytes) {
  if (bytes * n_points * n_points > most_bytes)
    throw UserError(keys + " must " + must +
                    formatted(": the layers of %.0f control points take %.0f GB assembled, more than %.0f.", n_points,
                              bytes * n_points * n_points / 1e9, most_bytes / 1e9));
}

void check_size(const Scene& scene) {
  const double bytes = bytes_a_pair(scene), most = std::floor(std::sqrt(most_bytes / bytes));
  const std::string few = formatted("give at most %.0f control points", most);
  if (scene.particle.shape.imported)
    check_bytes("Particle/file", few, points(scene), bytes);
  else if (scene.surface.polar())
    check_bytes("Surface/azimuthal elements and Surface/meridional elements", few, points(scene), bytes);
  else
    check_bytes("Surface/elements per side",
                formatted("be at most %.0f, but is %d", std::floor(std::sqrt((most - 2) / 6)), *scene.surface.elements_per_side),
                points(scene), bytes);
  if (!scene.tube.present || (scene.tube.channel && scene.solvers.wall != "factored")) return;
  check_bytes(scene.tube.list() + "/azimuthal elements and " + scene.tube.list() + "/axial elements",
              formatted("give at most %.0f control points", most_wall_points()), wall_points(scene), doubles * coupling::Ranks().size());
}

/// Vectors that every rank keeps for the iterative solver, and the matrix of their products.
void check_vectors(const Scene& scene, const std::string& path, const std::shared_ptr<Teuchos::ParameterList>& list) {
  const double unknowns = 3 * (points(scene) + (scene.tube.present ? wall_points(scene) : 0));
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

/// Keys that need each other, or that have no meaning beside another one.
void check_motion(const Scene& scene) {
  const ParticleOptions& particle = scene.particle;
  if (particle.motion != Motion::prescribed && (particle.velocity || particle.angular_velocity))
    throw UserError(std::string("Particle/") + (particle.velocity ? "velocity" : "angular velocity") +
                    " belongs to Particle/motion `prescribed`, but Particle/motion is " + text(particle.motion) + ".");
  if (particle.motion != Motion::free && (particle.force || particle.torque))
    throw UserError(std::string("Particle/") + (particle.force ? "force" : "torque") + " is for Particle/motion `free`, but Particle/motion is " +
                    text(particle.motion) + (particle.rigid() ? ": a body that moves as told takes whatever force that needs."
                                                              : ": on what deforms a force is spread, by Particle/density difference and "
                                                                "Flow/gravity."));
  if (particle.density_difference && !scene.flow.gravity) throw UserError("Particle/density difference needs Flow/gravity.");
  if (scene.flow.type == "duct" && !scene.tube.present) throw UserError("Flow/type `duct` needs a list Tube, at least Tube/section, or Channel.");
  if (scene.adaptation.film_resolution && scene.name.empty() && !scene.wall.present && !scene.tube.present && !scene.domain.present)
    throw UserError("Adaptation/film resolution is for several particles, in a lattice, or beside a wall: there are no films between others.");
  if (std::isnan(scene.time.final_time) && (particle.motion != Motion::prescribed || scene.in_system()) && scene.runs_in_time())
    throw UserError("Time/final time is missing: when the run ends, in the deck's unit of time.");
  if (scene.periodic.present && std::isnan(scene.periodic.period))
    throw UserError("Periodic/period is missing: the expected one, in the deck's unit of time.");
  if (const auto& history = scene.flow.history; scene.periodic.present && history && history->frequency) {
    const double cycles = scene.periodic.period * *history->frequency;
    if (cycles < 0.5 || std::abs(cycles - std::round(cycles)) > 1e-9 * cycles)
      throw UserError(formatted("Periodic/period must be a multiple of the period of Flow/history, %.10g, but is %.10g.", 1 / *history->frequency,
                                scene.periodic.period));
  }
}

/// Whether a flow with the same gradient everywhere has a vorticity.
bool turns(const Scene& scene) {
  if (scene.flow.type == "duct") return false;
  const stokes::AmbientFlow ambient(scene.flow);
  const Mat3 gradient = ambient.gradient(Vec3::Zero());
  return ambient.affine() && (gradient - gradient.transpose()).norm() > 1e-12 * gradient.norm();
}

std::string contradiction(const std::string& one, const std::string& other, const std::string& why) {
  return one + " and " + other + " contradict each other: " + why + ".";
}

/// Throws UserError for two choices that cannot be made together.
void refuse(bool both, const std::string& one, const std::string& other, const std::string& why) {
  if (both) throw UserError(contradiction(one, other, why));
}

/// Every pair of choices, of whatever lists, that cannot be made together.
void check_contradictions(const Scene& scene) {
  std::vector<std::string> found;
  const auto refuse = [&found](bool both, const std::string& one, const std::string& other, const std::string& why) {
    if (both) found.push_back(contradiction(one, other, why));
  };
  const ParticleOptions& particle = scene.particle;
  const bool rigid = particle.rigid(), told = particle.motion == Motion::prescribed, held = particle.drift == "held";
  const bool adapts = scene.adaptation.enabled, tube = scene.tube.present, weight = particle.density_difference.has_value();
  const bool drop = scene.membrane.law == "surface tension", strong = scene.load_is_strong();
  const bool desingularised = scene.quadrature.rule == "desingularised", degenerate = scene.surface.polar() && scene.surface.poles == "plain";
  const bool steady = !scene.runs_in_time(), wall = scene.wall.present;
  const std::string sought = scene.sought();
  const std::string motion = "Particle/motion " + text(particle.motion), flow = "Flow/type `" + scene.flow.type + "`";
  const std::string sliding = "Interface/motion `" + scene.interface_motion() + "`", law = "Membrane/law `" + scene.membrane.law + "`";
  refuse(scene.steady.present && scene.periodic.present, "Steady", "Periodic", "what rests has no period");
  refuse(steady && scene.tube.channel && scene.flow.held == "flow rate", sought, "Flow/held `flow rate`",
         "what is carried along in a channel rests only where a pressure drop does not push it through");
  refuse(steady && told, sought, motion, "a body that moves as told has no place or attitude to be found");
  if (scene.continuation.present && !scene.steady.present) found.emplace_back("Continuation needs a list Steady: it continues steady shapes.");
  refuse(steady && scene.flow.history && !scene.periodic.present, sought, "Flow/history", "nothing is steady in a flow that changes");
  refuse(steady && scene.domain.present, sought, "Domain", "the lattice moves along with the flow");
  refuse(steady && scene.volume.constraint != "exact", sought, "Volume/constraint `" + scene.volume.constraint + "`", "the volume tells which shape");
  refuse(steady && drop && scene.interface_motion() == "material", sought, "Interface/motion `material`",
         "points that go with the fluid along an interface do not rest");
  const std::string& unstressed = scene.membrane.stress_free == "resting" ? particle.shape.shape : scene.membrane.stress_free;
  refuse(scene.steady.present && !drop && !rigid && unstressed != "sphere" && turns(scene), sought, flow,
         "the flow turns, and a membrane that is no sphere where it is unstressed swings or tumbles as it treads");
  const std::string confined = scene.tube.list();
  const bool couette = tube && !scene.tube.channel && scene.flow.type == "simple shear" && !scene.flow.history;
  refuse(tube && !couette && scene.flow.type != "duct" && scene.flow.type != "quiescent", confined, flow,
         "that flow fills unbounded space; in a tube Flow/type is `duct`, `quiescent` or, in a straight one and unchanging, `simple shear`, "
         "with which the wall goes along");
  refuse(tube && desingularised, "Quadrature/rule `desingularised`", confined, "the wall is not closed");
  const std::string repulsion = confined + "/repulsion";
  refuse(scene.tube.repulsion && told, repulsion, motion, "a body that moves as told takes whatever force that needs");
  refuse(scene.domain.present && tube, "Domain", confined, "a tube does not repeat");
  refuse(scene.contact.limiter && steady, "Contact/limiter", sought, "it holds gaps after steps in time");
  const std::pair<bool, std::string> works[] = {{scene.contact.limiter, "Contact/limiter"}, {weight, "Particle/density difference"},
                                                {scene.tube.repulsion.has_value(), repulsion}};
  for (const auto& [with, what] : works)
    refuse(with && strong, what, "Membrane/load `strong`", "its forces act by the work that they do, `weak`");
  refuse(scene.domain.present && desingularised, "Domain", "Quadrature/rule `desingularised`", "its identities are those of unbounded space");
  refuse(scene.domain.present && scene.domain.directions() < 3 && (told || weight || particle.force),
         "Domain/periodic `" + scene.domain.periodic + "`",
         told ? motion : weight ? "Particle/density difference" : "Particle/force",
         "the velocity of a net force in every cell is known in a lattice of three directions only");
  refuse(wall && tube, "Wall", "Tube", "images are of one plane in a fluid that is unbounded otherwise");
  refuse(wall && scene.domain.present, "Wall", "Domain", "images in a wall of a scene that repeats are not there");
  refuse(wall && scene.quadrature.rule != "adaptive", "Wall", "Quadrature/rule `" + scene.quadrature.rule + "`",
         "a film at a wall takes rules by tolerance, `adaptive`");
  refuse(wall && steady, sought, "Wall", "beside a wall nothing that deforms keeps its distance from it");
  refuse(wall && held, "Wall", "Particle/drift `held`", "its distance from the wall matters");
  refuse(weight && told, "Particle/density difference", motion, "a body that moves as told takes whatever force that needs");
  refuse(scene.viscous_membrane() && tube && scene.solvers.tube != "schur", "Membrane viscosity", "Solvers/tube `" + scene.solvers.tube + "`",
         "the system of all blocks leaves the membrane's own load out; `schur` has it");
  refuse(scene.solvers.wall != "auto" && tube && !scene.tube.channel, "Solvers/wall", confined, "the wall of a straight tube is factored");
  refuse(scene.solvers.wall == "iterative" && scene.solvers.tube != "schur", "Solvers/wall `iterative`", "Solvers/tube `" + scene.solvers.tube + "`",
         "that takes the factored wall");
  refuse(scene.flow.held != "flow rate" && scene.solvers.tube != "schur", "Flow/held `" + scene.flow.held + "`",
         "Solvers/tube `" + scene.solvers.tube + "`", "the system of all blocks holds the flow rate; `schur` may hold either");
  refuse(scene.solvers.projection != "collocation" && (tube || wall || rigid), "Solvers/projection `" + scene.solvers.projection + "`",
         tube ? "Tube" : wall ? "Wall" : motion, "it is for what deforms away from walls");
  refuse(rigid && scene.membrane_given, "Membrane", motion, "a rigid particle has no membrane");
  refuse(rigid && scene.volume_given, "Volume", motion, "a rigid particle keeps its volume");
  refuse(rigid && particle.viscosity_ratio != 1, "Particle/viscosity ratio", motion, "there is no fluid in a rigid particle");
  refuse(rigid && particle.shape.initial, "Particle/initial shape", motion, "a rigid particle has the shape that it has");
  refuse(told && scene.time.steady_tolerance, "Time/steady tolerance", motion, "a body that moves as told does not come to rest");
  refuse(adapts && particle.shape.imported, "Adaptation/enabled", "Particle/shape `file`", "a spline space from a file has no mesh to refine");
  refuse(scene.volume.constraint == "none" && !strong && scene.membrane.load_measure == "reference", "Volume/constraint `none`",
         "Membrane/load measure `reference`", "the load per reference area (3.7) needs `flux` or `exact`");
  refuse(!drop && strong && degenerate, "Membrane/load `strong`", "Surface/poles `plain`", "a degenerate element has no load at a pole");
  refuse(desingularised && degenerate, "Quadrature/rule `desingularised`", "Surface/poles `plain`",
         "a degenerate element has no normal at its pole");
  refuse(!drop && scene.interface_motion() != "material", sliding, law, "an elastic membrane moves with the fluid, `material`");
  const std::string surfactant = "Interface/surfactant", memory = "Membrane/relaxation time";
  refuse(scene.surfactant && (rigid || !drop), surfactant, rigid ? motion : law, "it is on the interface of a drop");
  refuse(scene.maxwell_membrane() && scene.steady.present && turns(scene), "Steady with " + memory, flow,
         "the membrane tank-treads through its steady shape, so that no point of it keeps its strain");
  refuse(held && scene.flow.type == "parabolic", "Particle/drift `held`", flow, "it is for flows whose gradient is the same everywhere");
  refuse(held && (tube || rigid), "Particle/drift `held`", tube ? confined : motion,
         "it is for particles that deform in a flow whose gradient is the same everywhere");
  require_none(std::move(found));
}

/// The balance of power is that of all particles (6.11).
void check_power(const Scene& scene) {
  if (!scene.output.power_balance || !scene.name.empty()) return;
  const std::string word = "Output/power balance";
  refuse(!scene.tube.present && !stokes::AmbientFlow(scene.flow).affine(), word, "Flow/type `" + scene.flow.type + "`",
         "it is for flows of one gradient, and for tubes");
  refuse(scene.alone().front().load_is_strong(), word, "Membrane/load `strong`", "it takes the load by the work that it does, `weak`");
  refuse(scene.solvers.rigid_bodies == "first kind", word, "Solvers/rigid bodies `first kind`", "nothing deforms");
}

/// What tractions of the first kind cannot do.
void check_first_kind(const Scene& scene) {
  const std::string word = "Solvers/rigid bodies `first kind`";
  double n_points = 0;
  for (const Scene& one : scene.alone()) {
    if (!one.particle.rigid())
      throw UserError(word + " is for rigid bodies alone, but " + (one.name.empty() ? "Particle" : "Particles/" + one.name) + " deforms.");
    n_points += points(one);
  }
  check_bytes("Solvers/rigid bodies", "be `second kind`", n_points, 2 * doubles);
}

/// What cannot be done with several particles yet, and each of them by itself.
void check_several(const Scene& scene) {
  const std::vector<Scene> alone = scene.alone();
  const bool strong = alone.front().load_is_strong();
  for (Scene one : alone) {
    one.volume_given = one.volume_given && !one.particle.rigid();  // it is the others'
    const std::string list = "Particles/" + one.name;
    if (one.load_is_strong() != strong) throw UserError(list + "/Membrane/load: one way of taking the load is for all particles.");
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

/// Throws UserError for parts that the program adds where they cannot act.
void check_registered(const Scene& scene) {
  const std::string motion = "Particle/motion " + text(scene.particle.motion), flow = "Flow/type `" + scene.flow.type + "`";
  refuse(!scene.loads.empty() && scene.load_is_strong(), "Membrane/loads", "Membrane/load `strong`", "loads act by the work that they do, `weak`");
  refuse(!scene.fields.empty() && scene.particle.rigid(), "Interface/fields", motion, "fields are on what deforms");
  if (scene.in_system()) return;
  refuse(!scene.series.empty(), "Output/series", motion, "the one body has a record of its own; give it in a list Particles");
  refuse(scene.flow.user && !scene.flow.user->affine(), flow, motion,
         "the one body is solved for in flows of the second degree; give it in a list Particles");
}

/// Lengths that the mesh must be able to have.
void check_adaptation(const Scene& scene) {
  if (!scene.adaptation.enabled) return;
  // The side of a square that is one element's share of the sphere of equal volume.
  const double area = 4 * std::numbers::pi * scene.radius() * scene.radius();
  scene.adaptation.check(static_cast<int>(scene.surface.n_points()), std::sqrt(area / scene.surface.n_elements()));
}

}  // namespace

void Scene::declare(deck::Section& root) {
  if (deck::UnitOptions given; root.optional_section("Units", given,
                                                     "what 1 of the deck's units is; with this list a value may have a unit of its own, "
                                                     "`5.3 uN/m`, and results say what they are in SI units"))
    root.take(units = std::make_shared<const deck::Units>(given));
  OutputList results{*this};
  flow.registered = &registry->flows;
  root.section("Flow", flow, "the ambient flow and the outer fluid");
  const bool several = root.given("Particles");
  if (several) {
    for (const char* list : {"Particle", "Membrane", "Surface", "Interface", "Adaptation"})
      if (root.given(list))
        throw UserError(std::string(list) + " and Particles contradict each other: each particle has its own, in Particles/<name>, and what "
                                            "they share is said once in Particles/defaults.");
  } else {
    root.section("Particle", particle, "the particle at rest");
    declare_lists(root);
  }
  if (Kinds kinds{particles, registry}; several || root.documenting())
    root.section("Particles", kinds, "several particles, in place of the lists Particle, Membrane, Surface, Interface and Adaptation");
  else
    root.mention("Particles");
  if (several || root.given("Domain") || root.documenting())
    root.section("Contact", contact, "what happens where particles come close, several of them or images in a lattice");
  volume_given = root.given("Volume");
  const bool deforming = !particle.rigid();
  tube.present = root.optional_section("Tube", tube, "a straight tube along x1 around the particle; none without this list");
  surface::TubeOptions documented;
  ChannelList channel{root.given("Channel") ? tube : documented};
  if (tube.present && root.given("Channel")) throw UserError("Channel and Tube contradict each other: a scene has one wall.");
  if (root.optional_section("Channel", channel, "a tube whose section changes along a centre line, which may bend; none without this list"))
    tube.present = true;
  domain.present =
      root.optional_section("Domain", domain, "the lattice that particles repeat on, moved along by the flow; unbounded space without this list");
  wall.present = root.optional_section("Wall", wall, "a plane wall that the fluid sticks to; none without this list");
  if ((wall.present || tube.present || domain.present) && name.empty() && !adaptation.film_resolution) adaptation.film_resolution = 0.7;
  if (deforming || volume_given) root.section("Volume", volume, "how its volume is kept");
  root.section("Quadrature", quadrature, "how integrals of the fluid are taken");
  root.section("Time", time, "integration in time");
  steady.present = root.optional_section("Steady", steady, "in place of a run in time: the shape at rest that the initial one leads to");
  continuation.present =
      root.optional_section("Continuation", continuation, "of the steady shape along a number of the deck; a row and a snapshot each point");
  periodic.present = root.optional_section(
      "Periodic", periodic, "in place of a run in time: the shape that the initial one leads to and that comes back after a period");
  spectrum.present = root.optional_section(
      "Spectrum", spectrum,
      "in place of a run in time: how fast small changes of the steady shape, or without Steady of the initial one, which should be at rest, grow or "
      "decay");
  periodic.driven = flow.history.has_value();
  root.section("Symmetry", symmetry, "what of the scene is solved for");
  root.section("Solvers", solvers, "solvers of linear systems");
  root.section("Output", results, "results");
  root.section("Expect", expect, "expected results");
}

std::vector<Scene> Scene::alone() const {
  if (particles.empty()) return {*this};
  Scene common = *this;
  std::vector<ParticleKind>().swap(common.particles);  // a list that is cleared keeps its room, in each of them
  std::vector<Scene> scenes(particles.size(), common);
  for (std::size_t p = 0; p < particles.size(); ++p) static_cast<ParticleKind&>(scenes[p]) = particles[p];
  return scenes;
}

void Scene::check() const {
  quadrature.check();
  if (solvers.rigid_bodies == "first kind") check_first_kind(*this);
  if (!particles.empty()) return check_several(*this), check_power(*this);
  flow.check();
  check_motion(*this);
  if (tube.present) tube.check();
  if (domain.present) domain.check(flow);
  if (wall.present) wall.check(flow);
  particle.shape.check();
  surface.check();
  check_viscosity_ratio(*this);
  if (!particle.rigid()) membrane.check();
  if (surfactant) surfactant->check(), surfactant->diffusivity_of(flow.rate(), radius());
  if (snapshot_interval() < 1e-6 * time.final_time)
    throw UserError("Output/interval must be at least a millionth of Time/final time, " + deck::number_text(1e-6 * time.final_time) + ", but is " +
                    deck::number_text(snapshot_interval()) + ".");
  check_contradictions(*this);
  check_registered(*this);
  modulus();
  motion::TimeOptions in_its_unit = time;
  in_its_unit.unit = 1 / rate();
  in_its_unit.check();
  check_adaptation(*this);
  check_size(*this);
  check_vectors(*this, "Solvers", solvers.belos);
  for (const coupling::IterativeOptions* system : {&solvers.velocity, &solvers.traction, &solvers.implicit_step, &solvers.spectrum})
    check_vectors(*this, system->path, system->belos);
  check_power(*this);
}

std::string Scene::interface_motion() const {
  return interface.motion.value_or(membrane.law == "surface tension" ? "relaxed" : "material");
}

double Scene::radius() const { return particle.shape.equivalent_radius(); }

double Scene::least_radius() const {
  const auto radius_of = [](const ParticleKind& kind) { return kind.particle.shape.equivalent_radius(); };
  return particles.empty() ? radius() : radius_of(std::ranges::min(particles, {}, radius_of));
}

double Scene::speed() const { return flow.speed(radius()); }

double Scene::rate() const {
  if (!particles.empty()) return alone().front().rate();
  if (speed() > 0) return speed() / radius();
  return particle.rigid() ? 1 : modulus() / (flow.viscosity * radius());
}

double Scene::modulus() const {
  if (particle.rigid()) return 0;
  return tube.present ? membrane.modulus(flow.viscosity, speed(), 1.0) : membrane.modulus(flow.viscosity, flow.rate(), radius());
}

Vec3 Scene::body_force() const { return particle.density_difference.value_or(0.) * flow.gravity.value_or(Vec3::Zero()); }

double Scene::bending_modulus() const { return membrane.bending(modulus(), radius()); }

bool Scene::reciprocal_forces() const { return particle.forces ? *particle.forces == "reciprocal" : quadrature.rule == "adaptive"; }

bool Scene::lands_on_snapshots() const {
  return output.between_steps ? *output.between_steps == "land" : !time.fixed_step || adaptation.enabled;
}

double Scene::snapshot_interval() const { return output.interval.value_or(time.final_time / 20.0); }

double most_wall_points() { return std::floor(std::sqrt(most_bytes / (doubles * coupling::Ranks().size()))); }

bool may_change_on_resume(const std::string& path) {
  if (path == "Tube/contact gap" || path == "Channel/contact gap" || path == "Wall/contact gap" || path == "Contact/limit") return true;
  if (path.starts_with("Particles/")) {
    const std::string of_particle = path.substr(path.find('/', std::string("Particles/").size()) + 1);
    return (of_particle.starts_with("Interface/") && !of_particle.starts_with("Interface/fields/")) || of_particle.starts_with("Adaptation/");
  }
  for (const char* fixed :
       {"Flow", "Domain", "Particle", "Membrane", "Surface", "Volume", "Tube", "Channel", "Wall", "Interface/fields", "Output/series"})
    if (path.rfind(std::string(fixed) + "/", 0) == 0) return false;
  return true;
}

}  // namespace tanktread
