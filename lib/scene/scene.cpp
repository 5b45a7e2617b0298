#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"
#include "deck/units.hpp"
#include "deck/words.hpp"
#include "system/solids/shared_walls.hpp"

namespace tanktread {

namespace {

/// Declares the sections Equations, Output, Expect and Accuracy.
void declare_results(deck::Section& root, Scene& scene) {
  scene.equations = scene.registry->equations.read(root, "Equations", "equations that this program adds; none without this section");
  const auto results = [&scene](deck::Section& section) {
    scene.output.declare(section);
    scene.series = scene.registry->series.read(section, "series", "series that this program adds to the record; none without this section");
  };
  root.section("Output", results, "output files of the run");
  root.section("Expect", scene.expect, "expected values of output series, with tolerances");
  root.optional_section("Accuracy", scene.accuracy,
                        "requested accuracy: the run is repeated on finer meshes, with finer tolerances, until the estimated errors meet it");
}

/// Declares the section Particles and adds its particles to `all`. `defaults`: values before any key is read.
void declare_several(deck::Section& section, std::vector<ParticleKind>& all, const ParticleKind& defaults, const Registry& registry) {
  section.each(
      "one of several particles. It has the keys of Particle and sections Membrane, Surface, Interface and Adaptation, as in a deck with one "
      "particle. Keys that are not set are taken from the particle that its key `like` names, or otherwise from Particles/defaults",
      [&](const std::string& name, deck::Section& inner) {
        if (name.find_first_of("/=") != name.npos) throw UserError(inner.path() + ": the name of a particle must not contain `/` or `=`.");
        if (name == "." || name == "..") throw UserError(inner.path() + ": the name of a particle must not be `.` or `..`.");
        all.emplace_back(defaults).name = name;
        all.back().declare(inner, registry);
      },
      true);
  if (section.documenting()) all.clear();
  else if (all.empty()) throw UserError(section.path() + " names no particle.");
}

/// Adds the keys of several sections that have no effect together.
void list_idle_keys(Scene& scene) {
  const auto has_weight = [](const ParticleKind& one) { return one.particle.density_difference.has_value(); };
  const auto add = [&](bool idle, const std::string& key, const std::string& why) {
    if (idle) scene.idle_keys.push_back(key + " has no effect " + why + ": remove the key.");
  };
  add(scene.flow.gravity && std::ranges::none_of(scene.particles, has_weight), "Flow/gravity", "without Particle/density difference");
  const bool all_rigid = std::ranges::all_of(scene.particles, [](const ParticleKind& one) { return one.particle.rigid(); });
  add(scene.volume_given && all_rigid && scene.named(), "Volume", "on rigid bodies");
  const bool tractions = scene.by_tractions(), unconstrained = !scene.volume.constrained();
  add(scene.solvers.volume != "auto" && (all_rigid || tractions || unconstrained), "Solvers/volume",
      all_rigid ? "on rigid bodies" : unconstrained ? "with Volume/constraint `none`" : "with the tractions on rigid bodies as unknowns");
  add(scene.solvers.tube != "schur" && scene.tube.present && tractions && scene.in_system(), "Solvers/tube",
      "with the tractions on rigid bodies as unknowns");
  add(scene.only_solids && scene.output.power_balance, "Output/power balance", "in a scene of posts only");
  add(scene.output.view && (scene.only_solids || scene.is_resistance_problem()), "Output/view direction", "without a moving particle");
  add(scene.only_solids && !scene.equations.empty(), "Equations", "in a scene of posts only");
  add(scene.only_solids && !scene.series.empty(), "Output/series", "in a scene of posts only");
  add(scene.tube.present && !surface::properties(scene.tube.kind()).may_iterate && scene.solvers.wall == "iterative", "Solvers/wall `iterative`",
      "on the wall of a straight tube, which is always factored");
  add(scene.solvers.rigid_bodies == coupling::BodyEquation::second_kind && !scene.in_system(), "Solvers/rigid bodies `second kind`",
      "on a rigid body alone, whose tractions are the unknowns");
}

/// Sets the members of options that follow from several sections and that no section reads while it is declared.
void complete_derived(Scene& scene) {
  if (scene.spectrum.present || scene.steady.present) scene.quadrature.choose_smooth_sums();
  scene.periodic.driven = scene.varies_in_time();
  if (const auto& sides = scene.domain.side_lengths; scene.tube.present && scene.domain.present && sides && !sides->empty())
    scene.tube.period = sides->front();
  scene.wall.solid = scene.wall.present && scene.domain.present && !scene.tube.present;
  scene.flow.plates = scene.wall.plates();
  for (ParticleKind& kind : scene.particles) kind.complete_film_resolution(scene.has_films_around_one());
}

/// Declares the sections of particles. Returns the particles of the section Particles. If the deck does not have this section, returns the single
/// particle of the section Particle. `only`: on input the default values of this particle; the values of the section Particle replace them.
std::vector<ParticleKind> declare_particles(deck::Section& root, ParticleKind& only, const Registry& registry) {
  std::vector<ParticleKind> all;
  const bool several = root.given("Particles");
  if (several) {
    for (const char* list : {"Particle", "Membrane", "Surface", "Interface", "Adaptation"})
      refuse(root.given(list), std::string(list), "Particles", unread::one_and_several);
  } else {
    only.implied = !root.given("Particle") && !root.given("Membrane");
    root.section("Particle", only.particle, "resting shape, initial shape and motion of the particle");
    only.declare_sections(root, registry);
  }
  root.optional_section("Particles", [&](deck::Section& section) { declare_several(section, all, only, registry); },
                        "several particles, instead of the sections Particle, Membrane, Surface, Interface and Adaptation");
  if (!several) all = {only};
  return all;
}

}  // namespace

void Scene::declare(deck::Section& root) {
  if (deck::UnitOptions given; root.optional_section("Units", given,
                                                     "physical units of the deck: the meaning of a length, time or force of 1. With this section a "
                                                     "value may have a unit, `5.3 uN/m`, and results are labelled with SI units"))
    root.take(units = std::make_shared<const deck::Units>(given));
  flow.registered = &registry->flows, domain.registered = &registry->media;
  root.section("Flow", flow, "the ambient flow and the outer fluid");
  tube.present = root.optional_section("Tube", tube, "a straight tube along x1 around the particle; none without this section");
  refuse(tube.present && root.given("Channel"), "Channel", "Tube", unread::two_ducts);
  surface::TubeOptions documented;
  const auto channel = [&one = root.given("Channel") ? tube : documented](deck::Section& section) {
    one.channel.emplace();
    one.declare(section);
  };
  if (root.optional_section("Channel", channel, "a tube whose cross-section varies along a centre line, which may bend; none without this section"))
    tube.present = true;
  ParticleKind only;  // options of the particle in the section Particle
  if (tube.present) only.duct_half_width = tube.half_width();  // used when the section Surface is declared
  const bool several = root.given("Particles");
  particles = declare_particles(root, only, *registry);
  volume_given = root.given("Volume");
  constexpr const char* cell = "periodic cell of fluid and particles, whose lattice the flow convects; nothing is periodic without this section";
  domain.present = root.optional_section("Domain", domain, cell) && !domain.medium;
  if (tube.present && !tube.channel && tube.periodic_length) {
    refuse(domain.present, "Tube/periodic length", "Domain", unread::two_periods);
    domain.present = true, domain.periodic = "x1", domain.side_lengths = std::vector<double>{*tube.periodic_length};
  }
  if (several || domain.present || root.documenting())
    root.section("Contact", contact, "limits for the gaps between particles, or between a particle and its periodic images");
  else if (root.given("Contact"))
    throw UserError("Contact needs Particles or Domain, because a single particle has no gaps to other particles.");
  wall.present = root.optional_section("Wall", wall, "a plane no-slip wall, or two in a periodic Domain; none without this section");
  const bool any_deforms = !std::ranges::all_of(particles, [](const ParticleKind& kind) { return kind.particle.rigid(); });
  if (any_deforms || volume_given || root.documenting()) root.section("Volume", volume, "conservation of the particle's volume");
  root.section("Quadrature", quadrature, "numerical integration of the boundary integrals of the flow");
  root.section("Time", time, "time integration: scheme, step length and end of the run");
  steady.present = root.optional_section("Steady", steady, "search for the steady shape that the initial shape leads to, instead of a run in time");
  continuation.present =
      root.optional_section("Continuation", continuation,
                            "continuation of the steady shape along a parameter of the deck; every point of the branch gives one row of the series "
                            "and one snapshot");
  periodic.present = root.optional_section(
      "Periodic", periodic,
      "search for a periodic motion that the initial shape leads to, instead of a run in time. The particle may be elsewhere after a period if "
      "flow and walls are the same there, for example further along a periodic tube");
  spectrum.present = root.optional_section(
      "Spectrum", spectrum,
      "growth rates of small perturbations of a steady shape, instead of a run in time. The shape is the result of Steady, or, without Steady, the "
      "initial shape, which should be steady");
  solvers.in_lattice = domain.present && !tube.present, solvers.in_duct = tube.present;  // used when the section Solvers is declared
  root.section("Symmetry", symmetry, "use of the symmetries of flow, particles and mesh");
  root.section("Solvers", solvers, "solvers of linear and nonlinear systems");
  declare_results(root, *this);
  idle_keys = root.idle_keys(), unusual_values = root.unusual_values();
  if (root.documenting()) return;
  complete_derived(*this);
  walls = std::make_shared<coupling::SharedWalls>();
  take_posts(*this);
  list_idle_keys(*this);
}

motion::TimeOptions ParticleScene::time_options() const {
  motion::TimeOptions in_its_unit = time;
  in_its_unit.unit = 1 / rate();
  return in_its_unit;
}

coupling::MeshMotion ParticleScene::interface_motion() const {
  return interface.motion.value_or(membrane.fluid_interface() ? coupling::MeshMotion::relaxed : coupling::MeshMotion::material);
}

double ParticleScene::speed() const { return flow.speed(radius()); }
double ParticleScene::rate() const {
  if (speed() > 0) return speed() / radius();
  return particle.rigid() ? 1 : modulus() / (flow.viscosity * radius());
}

double ParticleScene::modulus() const {
  if (particle.rigid()) return 0;
  return tube.present ? membrane.modulus(flow.viscosity, speed(), 1.0) : membrane.modulus(flow.viscosity, flow.rate(), radius());
}

Vec3 ParticleScene::body_force() const { return particle.density_difference.value_or(0.) * flow.gravity.value_or(Vec3::Zero()); }
std::string_view ParticleScene::net_force() const {
  if (!body_force().isZero(0)) return "Particle/density difference";
  if (!membrane.forces.total().isZero(0)) return "Membrane/forces";
  return particle.force && !particle.force->isZero(0) ? "Particle/force" : "";
}

double ParticleScene::bending_modulus() const { return membrane.bending(modulus(), radius()); }

bool ParticleScene::reciprocal_forces() const {
  return particle.forces ? *particle.forces == "reciprocal" : quadrature.rule == quadrature::LayerRule::adaptive;
}

Chosen SharedOptions::sought() const {
  const char* section = any_search;
  switch (search()) {
    case Search::none: break;
    case Search::steady: section = "Steady"; break;
    case Search::periodic: section = "Periodic"; break;
    case Search::spectrum: section = "Spectrum"; break;
  }
  return {section, any_search};
}

std::shared_ptr<const stokes::Medium> SharedOptions::medium() const {
  const auto plane = wall.plane();
  return plane ? std::make_shared<stokes::PlaneWall>(*plane) : domain.medium;
}

double SharedOptions::snapshot_interval() const { return output.interval.value_or(time.final_time / 20.0); }

double SharedOptions::next_snapshot(double now) const {
  const double interval = snapshot_interval(), next = (std::floor(now / interval * (1 + 1e-12)) + 1) * interval;
  return next < time.final_time * (1 - 1e-12) ? next : time.final_time;
}

Scene::Common Scene::common() const {
  Common all{by_tractions() ? coupling::BodyEquation::first_kind : coupling::BodyEquation::second_kind, {}};
  const auto sized = [](const ParticleKind& one) { return one.particle.shape.sized(); };
  if (std::ranges::all_of(particles, sized)) all.least_radius = least_radius();
  return all;
}

ParticleScene Scene::of(const ParticleKind& kind, const Common& common) const {
  ParticleScene particle_scene(*this, kind);
  particle_scene.solvers.rigid_bodies = common.rigid_bodies;
  particle_scene.least_radius = common.least_radius;
  return particle_scene;
}

std::vector<ParticleScene> Scene::particle_scenes() const {
  const Common of_all = common();
  std::vector<ParticleScene> scenes;
  for (const ParticleKind& kind : particles) scenes.push_back(of(kind, of_all));
  return scenes;
}

ParticleScene Scene::first_deforming() const {
  const auto found = std::ranges::find_if(particles, [](const ParticleKind& kind) { return !kind.particle.rigid(); });
  return of(found == particles.end() ? particles.front() : *found, common());
}

std::string_view why_in_system(const SharedOptions& shared, const ParticleKind& kind) {
  if (shared.only_solids) return {};
  if (!kind.name.empty()) return "Particles";
  if (!kind.particle.rigid()) return "Particle/motion";
  if (shared.domain.present) return "Domain";
  if (shared.output.power_balance) return "Output/power balance";
  if (!shared.runs_in_time()) return SharedOptions::any_search;
  if (shared.tube.repulsion) return "repulsion";
  if (shared.varies_in_time() && kind.particle.motion == Motion::prescribed) return "Flow/history";
  if (!shared.series.empty()) return "Output/series";
  if (!shared.equations.empty()) return "Equations";
  return shared.flow.user && !shared.flow.user->affine() ? "Flow/type" : "";
}

/// Returns true if the unknowns of rigid bodies are tractions (Solvers/rigid bodies `first kind`). `auto` selects `first kind` for two to four bodies
/// of up to 1500 control points, all with adaptive meshes or with integrals of a tolerance of at most 1e-7, or for the only particle in a duct, of up
/// to 2000, or with a prescribed motion next to plates or posts. For a film of a tenth of the radius, `first kind` needs a third of the points of
/// `second kind`. With 1538 points both take the same time for a sphere of 0.8 tube radii, and the pressure drop has errors of 2e-8 and 1e-5. Eight
/// settling spheres whose meshes grow to 3088 points take seven times as long with `first kind`. For a sphere with gaps of a quarter of its radius to
/// two plates, the drag across them has errors of 6e-5 and 6e-4 (218 points) in twice the time. If the sphere settles, a run takes four times as
/// long.
bool Scene::by_tractions() const {
  using enum coupling::BodyEquation;
  if (solvers.rigid_bodies != automatic || !runs_in_time()) return solvers.rigid_bodies == first_kind;
  const auto resistance = [&] { return (wall.solid || !posts.empty()) && particles.front().particle.motion == Motion::prescribed; };
  const bool alone = particles.size() == 1 && (tube.present ? solvers.eliminates_walls() : resistance());
  const bool accurate = quadrature.rule == quadrature::LayerRule::adaptive && quadrature.tolerance <= 1e-7;
  double bodies = 0, points = 0;
  for (const ParticleKind& kind : particles) {
    if (!kind.particle.rigid()) continue;
    if (!kind.adaptation.enabled && !accurate && !alone) return false;
    ++bodies, points += kind.particle.shape.imported ? kind.particle.shape.imported->space.n_points : kind.surface.n_points();
  }
  return alone ? bodies > 0 && points <= 2000 : bodies > 1 && bodies <= 4 && points <= 1500;
}

double Scene::least_radius() const {
  double least = std::numeric_limits<double>::infinity();
  const spline::SplineSurface* before = nullptr;  // surface from a file, which copies of a particle share
  for (const ParticleKind& kind : particles) {
    const surface::ParticleShape& shape = kind.particle.shape;
    if (shape.imported && shape.imported.get() == before) continue;
    before = shape.imported.get();
    least = std::min(least, shape.equivalent_radius());
  }
  return least;
}

bool Scene::adapts() const {
  return std::ranges::any_of(particles, [](const ParticleKind& kind) { return kind.adaptation.enabled; });
}

bool Scene::lands_on_snapshots() const {
  return output.between_steps ? *output.between_steps == "land" : !time.fixed_step || (adapts() && !named());
}

bool may_change_on_resume(const std::string& path) {
  // Particles/<name>/Interface/motion is treated like Interface/motion; the name begins after the 10 characters of `Particles/`.
  const std::string_view key = std::string_view(path).substr(path.starts_with("Particles/") ? path.find('/', 10) + 1 : 0);
  const auto is_in = [key](std::string_view section) { return key.starts_with(section); };
  // Keys of the sections in `free` on which checkpoints, or files that grow with the run, depend.
  constexpr std::string_view fixed[] = {"Contact/limiter",      "Interface/fields/", "Interface/surfactant/",
                                        "Output/power balance", "Output/series/",    "Output/view direction"};
  constexpr std::string_view free[] = {
      "Accuracy/", "Adaptation/", "Contact/", "Continuation/", "Expect/", "Interface/", "Output/", "Periodic/", "Quadrature/", "Solvers/",
      "Spectrum/", "Steady/", "Symmetry/", "Time/", "Units/", "Channel/contact gap", "Tube/contact gap", "Wall/contact gap"};
  return std::ranges::any_of(free, is_in) && std::ranges::none_of(fixed, is_in);
}

}  // namespace tanktread
