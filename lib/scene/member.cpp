#include "scene/member.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include "base/errors.hpp"
#include "scene/exact_body.hpp"
#include "scene/particles/drift.hpp"
#include "scene/tube.hpp"
#include "system/parallel/stop_together.hpp"

namespace tanktread {

namespace {

membrane::Material material(const ParticleScene& particle_scene, const Body& body) {
  if (particle_scene.particle.rigid()) return {body.law, {}, {}};
  const membrane::Options& given = particle_scene.membrane;
  return {body.law, {particle_scene.bending_modulus(), given.bending_reference == "unstressed", given.spontaneous_curvature.value_or(0)},
          particle_scene.kelvin_voigt_membrane() ? given.viscosity : membrane::SurfaceViscosity{}, given.area_order};
}

Eigen::MatrixXd numbers_of(const auto& values) {
  Eigen::MatrixXd numbers(values.size(), 1);
  for (std::size_t k = 0; k < values.size(); ++k) numbers(static_cast<Eigen::Index>(k)) = values[k];
  return numbers;
}

/// Returns true if the spaces are equal in everything that determines values and derivatives of fields. Equal extraction matrices share one pointer
/// (spline::share_extraction).
bool same(const spline::Space& a, const spline::Space& b) {
  return a.n_points == b.n_points && std::ranges::equal(a.elements, b.elements, [](const spline::Element& one, const spline::Element& other) {
    return one.degree == other.degree && one.points == other.points && one.extraction == other.extraction;
  });
}

/// Returns true if the nets differ only by a translation, up to round-off.
bool translated(const Net& a, const Net& b) {
  const Net change = b - a;
  return (change.rowwise() - change.row(0)).cwiseAbs().maxCoeff() < 1e-14 * (a.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff());
}

/// Sets the geometry and the membrane of member p. Shares each of them with an earlier member for which it is equal, or constructs it.
void share_or_make(std::vector<Member>& members, std::size_t p) {
  Member& member = members[p];
  const Body& body = *member.body;
  const membrane::Material own = material(member.scene, body);
  const std::span<const Member> before(members.data(), p);
  const auto in_space = std::ranges::find_if(before, [&](const Member& other) { return same(other.body->space, body.space); });
  member.geometry = in_space == before.end() ? std::make_shared<const surface::Geometry>(body.space) : in_space->geometry;
  const auto equal = std::ranges::find_if(before, [&](const Member& other) {
    return other.geometry == member.geometry && other.membrane->materials().all.front() == own &&
           translated(other.body->unstressed, body.unstressed);
  });
  member.membrane = equal == before.end() ? std::make_shared<const membrane::Membrane>(body.space, body.unstressed, membrane::Materials{{own}, {}})
                                          : equal->membrane;
}

}  // namespace

coupling::RigidDrive drive_of(const ParticleScene& particle_scene, const Body& body) {
  const ParticleOptions& particle = particle_scene.particle;
  const auto given = [](const std::optional<Vec3>& vector) { return vector.value_or(Vec3::Zero()); };
  return {particle.motion == Motion::prescribed, prescribed_motion(particle_scene),
          given(particle.force) + body.volume * particle_scene.body_force(), given(particle.torque)};
}

std::vector<Member> make_members(const Scene& scene) {
  std::vector<Member> all;
  std::vector<ParticleScene> scenes = scene.particle_scenes();
  for (ParticleScene& one : scenes) {
    coupling::stop_together();
    const auto equal = std::ranges::find_if(all, [&](const Member& before) { return alike(before.scene, one); });
    Body body = scenes.size() == 1
                    ? make_body(one)
                    : make_body_of_several(one, equal == all.end() ? nullptr : &*equal, all.empty() ? nullptr : all.front().body->duct);
    Member& member = all.emplace_back();
    member.name = one.name;
    member.scene = std::move(one);
    member.body = std::make_unique<Body>(std::move(body));
  }
  return all;
}

void follow(Member& member) {
  if (member.scene.adaptation.enabled) member.followed = spline::Locator(member.body->nested())(member.place);
}

void arrange(std::vector<Member>& members) {
  std::vector<spline::Space*> spaces;
  for (const Member& member : members) spaces.push_back(&member.body->space);
  spline::share_extraction(spaces);
  const std::vector<spline::Block> blocks = spline::blocks(std::vector<const spline::Space*>(spaces.begin(), spaces.end()));
  for (std::size_t p = 0; p < members.size(); ++p) {
    Member& member = members[p];
    member.block = blocks[p];
    if (members.size() == 1) continue;  // make_capsule() sets the geometry and the membrane of a single member
    Body& body = *member.body;
    body.symmetry = surface::Symmetry(body.space.n_points);  // no symmetry: a symmetry of one particle need not be a symmetry of all particles
    share_or_make(members, p);
  }
}

std::unique_ptr<Body> make_stacked_body(const std::vector<Member>& members) {
  if (members.size() == 1) return {};
  auto all = std::make_unique<Body>();
  std::vector<const spline::Space*> spaces;
  for (const Member& member : members) spaces.push_back(&member.body->space);
  all->space = spline::stacked(spaces);
  const Body& first = *members.front().body;
  all->flow = first.flow, all->duct = first.duct, all->plane = first.plane, all->law = first.law, all->modulus = first.modulus;
  all->radius = 0;
  for (Net Body::* const net : {&Body::rest, &Body::initial, &Body::unstressed}) {
    ((*all).*net).resize(all->space.n_points, 3);
    for (const Member& member : members) member.block.rows((*all).*net) = (*member.body).*net;
  }
  for (const Member& member : members) {
    all->radius = std::max(all->radius, member.body->radius);
    all->volume += member.body->volume;
    all->refit_error = std::max(all->refit_error, member.body->refit_error);
  }
  all->symmetry = surface::Symmetry(all->space.n_points);
  return all;
}

namespace {

/// Throws UserError if a load depends on the position of its particle although the particle is displaced: by periods of the lattice, or back to its
/// initial position (`Particle/drift` `held`).
void check_position(const ParticleScene& particle_scene, const coupling::LoadList& loads) {
  const auto refuse_if_changed = [&](const Eigen::Matrix3Xd& displacements, const char* by, const char* why) {
    const auto changes = [&](const auto& load) {
      return (load->rigid_conditions().template leftCols<3>() * displacements).norm() > 1e-9 * displacements.norm();
    };
    if (std::ranges::any_of(loads, changes))
      throw UserError("The loads" + (particle_scene.name.empty() ? "" : " of Particles/" + particle_scene.name) + " and " + by +
                      " contradict each other: a load that depends on the position of the particle " + why + ".");
  };
  if (const auto cell = particle_scene.domain.cell())
    refuse_if_changed(cell->vectors().leftCols(cell->n()), "Domain", "is not the same in all cells");
  if (holds_centre(particle_scene))
    refuse_if_changed(Mat3::Identity(), "Particle/drift `held`", "would never reach its balance, because the position is restored after each step");
}

/// Returns the data of one member for the coupled system.
coupling::Particle particle(const Member& member) {
  const ParticleScene& particle_scene = member.scene;
  const Body& body = *member.body;
  coupling::Particle particle;
  particle.path = particle_scene.path();
  particle.space = &body.space;
  particle.viscosity_ratio = particle_scene.particle.viscosity_ratio;
  particle.material = material(particle_scene, body);
  particle.loads = member.loads.all();
  check_position(particle_scene, particle.loads);
  particle.radius = body.radius;
  if (particle_scene.particle.rigid()) particle.rigid = drive_of(particle_scene, body);
  particle.by_traction = particle_scene.particle.rigid() && particle_scene.solvers.rigid_bodies == coupling::BodyEquation::first_kind;
  particle.interface_motion = particle_scene.interface_motion();
  particle.interface_speed = particle_scene.interface.relaxation * particle_scene.unit_speed();
  // In a search for a periodic motion that does not turn, the net does not turn, because a net that has turned would not recur.
  particle.interface_turns = !particle_scene.periodic.present || particle_scene.periodic.turn != 0;
  particle.kept_volume = body.volume;
  particle.measure = load_measure(particle_scene);
  return particle;
}

/// Returns the data of all members for the coupled system. The load of a rigid body may be per unstressed or per current area (`measure`). The
/// `measure` of the deforming particles is used, because it is cheapest if all layers use the same area.
std::vector<coupling::Particle> particles(const std::vector<Member>& members) {
  std::vector<coupling::Particle> all;
  for (const Member& member : members) all.push_back(particle(member));
  const auto deforms = std::ranges::find_if(all, [](const coupling::Particle& one) { return !one.rigid; });
  for (coupling::Particle& one : all)
    if (one.rigid && deforms != all.end()) one.measure = deforms->measure;
  return all;
}

}  // namespace

std::shared_ptr<coupling::Capsule> make_capsule(std::vector<Member>& members, const Body& all, Phases& phases, std::unique_ptr<coupling::Tube> tube,
                                                const std::optional<coupling::SolidScene>& solids) {
  const ParticleScene& particle_scene = members.front().scene;
  coupling::CapsuleParameters parameters;
  parameters.viscosity = particle_scene.flow.viscosity;
  for (Member& member : members) member.loads = make_loads(member.scene, *member.body, all.wall.get());
  parameters.particles = particles(members);
  parameters.strong_load = std::ranges::any_of(members, [](const Member& member) { return member.scene.load_is_strong(); });
  parameters.volume = particle_scene.volume;
  parameters.solvers = particle_scene.solvers;
  parameters.quadrature = particle_scene.quadrature;
  parameters.symmetry = all.symmetry;
  parameters.cell = particle_scene.domain.cell();
  parameters.medium = particle_scene.medium();
  parameters.solids = solids;
  for (const EquationParts::Chosen& one : particle_scene.equations) parameters.equations.push_back(one.make);
  const auto system = std::make_shared<coupling::Capsule>(all.space, all.unstressed, all.rest, all.flow, parameters, phases, std::move(tube));
  if (members.size() == 1) {
    members.front().geometry = {system, &system->geometry()};
    members.front().membrane = {system, &system->membrane()};
  }
  return system;
}

std::vector<RecordedParticle> recorded_particles(const std::vector<Member>& members, const Net& x, const Net& v) {
  std::vector<RecordedParticle> all;
  for (const Member& member : members)
    if (!member.scene.series.empty()) all.push_back({member.body->space, member.own(x), member.own(v)});
  return all;
}

/// Name of the surfactant's mass in checkpoints, although the mass is not an area: this name is taken, and another one would make checkpoints
/// unreadable. At the start the mass is equal to the area, where the concentration is 1.
constexpr const char* stored_mass = "initial area";

void store(const std::vector<Member>& members, output::Checkpoint& checkpoint) {
  for (const Member& member : members) {
    const Body& body = *member.body;
    checkpoint.arrays[member.label("unstressed")] = body.unstressed;
    checkpoint.arrays[member.label(stored_rest)] = body.rest;
    checkpoint.numbers[member.label("initial volume")] = body.volume;
    checkpoint.numbers[member.label("refit error")] = body.refit_error;
    if (member.scene.surfactant) checkpoint.numbers[member.label(stored_mass)] = member.surfactant_mass;
    if (!member.scene.adaptation.enabled) continue;
    checkpoint.arrays[member.label("mesh edges")] = numbers_of(body.mesh.edges);
    checkpoint.arrays[member.label("mesh spacing")] = numbers_of(body.mesh.spacing);
  }
}

spline::TMesh stored_mesh(spline::TMesh mesh, const output::Checkpoint& checkpoint, const std::string& prefix) {
  const Eigen::MatrixXd &spacing = checkpoint.arrays.at(prefix + "mesh spacing"), &bits = checkpoint.arrays.at(prefix + "mesh edges");
  if (static_cast<size_t>(bits.size()) != mesh.edges.size())
    throw UserError("Adaptation/enabled and Adaptation/levels cannot change when a run continues from a refined mesh.");
  for (Eigen::Index i = 0; i < bits.size(); ++i) mesh.edges[static_cast<size_t>(i)] = static_cast<std::uint8_t>(bits(i));
  for (Eigen::Index i = 0; i < spacing.size(); ++i) mesh.spacing[static_cast<size_t>(i)] = static_cast<int>(spacing(i));
  return mesh;
}

bool restore(const output::Checkpoint& checkpoint, std::vector<Member>& members) {
  bool another = false;
  for (Member& member : members) {
    member.body->volume = checkpoint.numbers.at(member.label("initial volume"));
    if (member.scene.surfactant) member.surfactant_mass = checkpoint.numbers.at(member.label(stored_mass));
    if (!checkpoint.arrays.contains(member.label("mesh edges"))) continue;
    another = true;
    lay_out(member.scene, stored_mesh(member.body->mesh, checkpoint, member.label("")), *member.body);
    member.body->unstressed = checkpoint.arrays.at(member.label("unstressed"));
    member.body->rest = member.body->initial = checkpoint.arrays.at(member.label(stored_rest));
    member.body->refit_error = checkpoint.numbers.at(member.label("refit error"));
  }
  return another;
}

}  // namespace tanktread
