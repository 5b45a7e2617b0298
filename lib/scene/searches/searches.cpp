#include "scene/searches/searches.hpp"

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "base/errors.hpp"
#include "base/small_matrices.hpp"
#include "deck/document.hpp"
#include "deck/words.hpp"
#include "scene/series/surface_fields.hpp"

namespace tanktread {

namespace {

/// Returns the linear conditions on a common rigid motion of all particles under which every load (Load::rigid_conditions), and the force and torque
/// on every rigid body, move with their particle, one row per condition.
membrane::RigidConditions conditions(std::span<const coupling::Particle> particles) {
  std::vector<membrane::RigidConditions> all;
  for (const coupling::Particle& particle : particles) {
    for (const auto& load : particle.loads) all.push_back(load->rigid_conditions());
    if (particle.rigid)
      for (const Vec3& fixed : {particle.rigid->force, particle.rigid->torque}) all.push_back(membrane::fixed_direction(fixed));
  }
  return membrane::stacked(all);
}

/// Returns the lattice vectors of a periodic scene. Returns none if the scene is not periodic, or if it has a tube or channel.
std::vector<Vec3> lattice_vectors(const SharedOptions& shared) {
  std::vector<Vec3> all;
  if (!shared.domain.present || shared.tube.present) return all;
  const stokes::PeriodicCell cell = shared.domain.cell().value();
  for (int d = 0; d < cell.n(); ++d) all.push_back(cell.vectors().col(d));
  return all;
}

/// Returns what turns a particle at all times: the torque on it, or a flow with a uniform gradient and nonzero vorticity. Returns nothing if neither
/// does. A load that turns a particle must be asked here.
std::optional<Chosen> turned_by(const ParticleScene& particle_scene) {
  if (const auto& torque = particle_scene.particle.torque; torque && !torque->isZero(0)) return "Particle/torque";
  if (particle_scene.flow.type == "duct") return {};
  const stokes::AmbientFlow ambient(particle_scene.flow);
  const Mat3 gradient = ambient.gradient(Vec3::Zero());
  if (!ambient.affine() || (gradient - gradient.transpose()).norm() <= 1e-12 * gradient.norm()) return {};
  return particle_scene.flow_choice();
}

/// Returns true if the flow, in all its directions over time, has another velocity gradient after the rotation about the origin.
bool changes(const stokes::AmbientFlow& ambient, const Mat3& rotation) {
  for (const stokes::AmbientFlow& flow : ambient.rotated_copies())
    for (const Vec3& x : {Vec3(0, 0, 0), Vec3(0.1, 0.5, -0.4), Vec3(0.2, -0.1, 0.3)}) {
      const Mat3 gradient = flow.gradient(x);
      if ((flow.gradient(rotation * x) - rotation * gradient * rotation.transpose()).norm() > 1e-9 * gradient.norm()) return true;
    }
  return false;
}

/// Returns the choice of the deck that the rotation by Periodic/turn about x2 changes: a duct, posts, a wall, a lattice, the flow, or a force or
/// torque. Returns nothing if the rotation is the identity or changes none of them. The forces of registered loads are not known.
std::optional<Chosen> changed_by_turn(const ParticleScene& one) {
  const Mat3 rotation = Eigen::AngleAxisd(one.periodic.turn * std::numbers::pi / 180, Vec3::UnitY()).toRotationMatrix();
  if (rotation.isIdentity()) return {};
  const auto moves = [&](const Vec3& vector) { return (rotation * vector - vector).norm() > 1e-9 * vector.norm(); };
  if (one.tube.present) return one.duct_choice();
  if (!one.posts.empty()) return "Particle/shape `cylinder`";
  const std::vector<stokes::PlaneWall> walls = one.wall.planes();
  const auto is_wall = [&](const stokes::PlaneWall& image) {
    return std::ranges::any_of(walls, [&](const stokes::PlaneWall& wall) {
      return (wall.normal() - rotation * image.normal()).norm() < 1e-9 && std::abs(wall.height(rotation * image.point())) < 1e-9 * one.radius();
    });
  };
  if (!std::ranges::all_of(walls, is_wall)) return "Wall";
  for (const Vec3& vector : lattice_vectors(one))
    if (const Vec3 image = rotation * vector; (image - one.domain.cell()->shift(image)).norm() > 1e-9 * vector.norm()) return "Domain";
  if (changes(stokes::AmbientFlow(one.flow), rotation)) return one.flow_choice();
  if (moves(one.body_force())) return "Particle/density difference";
  if (moves(one.particle.force.value_or(Vec3::Zero()))) return "Particle/force";
  if (moves(one.particle.torque.value_or(Vec3::Zero()))) return "Particle/torque";
  if (std::ranges::any_of(one.membrane.forces.all, moves, &membrane::PatchForce::force)) return "Membrane/forces";
  return {};
}

}  // namespace

void reject_searches(const ParticleScene& particle_scene, Rejections& to) {
  const bool search = !particle_scene.runs_in_time(), steady = particle_scene.steady.present, drop = particle_scene.membrane.fluid_interface();
  const std::string &resting = particle_scene.particle.shape.shape, &stress_free = particle_scene.membrane.stress_free;
  const std::string& unstressed = stress_free == "resting" ? resting : stress_free;
  to.pair(steady && particle_scene.periodic.present, "Steady", "Periodic", "a steady shape has no period; give one of them");
  to.add(particle_scene.continuation.present && !steady, "Continuation needs a section Steady, because it continues steady shapes.");
  if (!particle_scene.registry->equations.empty())
    to.pair(search && !particle_scene.equations.empty(), particle_scene.sought(), "Equations",
            "an added equation may keep a quantity that distinguishes between steady shapes, so that they are not isolated");
  to.pair(search && particle_scene.varies_in_time() && !particle_scene.periodic.present, {particle_scene.sought().here, "Steady or Spectrum"},
          "Flow/history", reason::unsteady);
  to.pair(particle_scene.time.steady_tolerance && particle_scene.flow.history && particle_scene.flow.history->type == "sine", "Time/steady tolerance",
          "Flow/history/type `sine`", reason::unsteady);
  to.pair(search && particle_scene.volume.constraint != coupling::VolumeConservation::exact, particle_scene.sought(),
          {"Volume/constraint `" + deck::word(coupling::volume_constraints, particle_scene.volume.constraint) + "`",
           "Volume/constraint other than `exact`"},
          "the volume must be conserved exactly, because it distinguishes between steady shapes");
  to.pair(search && drop && particle_scene.interface_motion() == coupling::MeshMotion::material, particle_scene.sought(),
          "Interface/motion `material`", "mesh points that move along the interface with the fluid do not become steady; give `normal` or `relaxed`");
  const std::optional<Chosen> turns = turned_by(particle_scene), changed = changed_by_turn(particle_scene);
  const Chosen turner(turns ? turns->here : "", "Flow/type");
  to.pair(steady && particle_scene.elastic() && unstressed != "sphere" && turns, {particle_scene.sought().here, "Steady"}, turner,
          "the particle is turned, and a membrane whose unstressed shape is not a sphere swings or tumbles while it tank-treads; use Periodic");
  to.pair(particle_scene.periodic.present && changed, "Periodic/turn",
          {changed ? changed->here : "", "Tube, Channel, posts, or a flow, Wall, Domain, force or torque that the rotation about x2 changes"},
          "the rotation about x2 must not change flow, walls, forces and torques; give 0");
  to.pair(particle_scene.spectrum.near && particle_scene.spectrum.method == "krylov", "Spectrum/near", "Spectrum/method `krylov`",
          "that method finds the modes nearest to Spectrum/shift; give that key, or `dense`");
  to.pair(particle_scene.maxwell_membrane() && steady && turns, "Steady with Membrane/relaxation time", turner,
          "the membrane tank-treads around its steady shape, so that the strain of its material points is not steady");
}

std::vector<coupling::RigidMotion> free_motions(const Scene& scene, const stokes::AmbientFlow& flow, double size,
                                                std::span<const coupling::Particle> particles, int kinds) {
  const membrane::RigidConditions of_loads = conditions(particles);
  if (scene.tube.present)
    switch (scene.tube.kind()) {
      case surface::DuctKind::straight_tube:
        return of_loads.col(0).isZero(0) ? std::vector{coupling::unit_motion(0)} : std::vector<coupling::RigidMotion>();
      case surface::DuctKind::channel: return {};
    }
  Net places(4, 3);
  places << size, 0, 0, 0, size, 0, 0, 0, size, size, size, size;
  // A rotation changes every lattice vector that is not parallel to the rotation axis.
  const std::vector<Vec3> lattice = lattice_vectors(scene);
  const Net v = flow.velocities(places);
  const std::vector<Mat3> gradients = flow.gradients(places);
  const auto of_lattice = static_cast<Eigen::Index>(3 * lattice.size());
  // Rows: the change of the velocity at four points (12), the wall (1), the lattice vectors (3 each) and the conditions of the loads.
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(13 + of_lattice + of_loads.rows(), 6);
  // A wall excludes translations along its normal. The periods along the wall exclude rotations.
  if (scene.wall.present) change.row(12).head<3>() = scene.rate() * scene.wall.normal.normalized();
  change.bottomRows(of_loads.rows()) = scene.rate() * of_loads;
  change.bottomRightCorner(of_loads.rows(), 3) /= size;
  for (int k = 0; k < 6; ++k) {
    const coupling::RigidMotion motion = coupling::unit_motion(k);
    const double unit = k < 3 ? 1 : 1 / size;
    const Net moved = coupling::rigid_velocity(places, motion, Vec3::Zero());
    for (int i = 0; i < 4; ++i)
      change.block<3, 1>(3 * i, k) =
          unit * (gradients[static_cast<std::size_t>(i)] * moved.row(i).transpose() - motion.angular_velocity.cross(Vec3(v.row(i).transpose())));
    for (std::size_t d = 0; d < lattice.size(); ++d)
      change.block<3, 1>(13 + 3 * static_cast<Eigen::Index>(d), k) = scene.rate() / size * motion.angular_velocity.cross(lattice[d]);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(change.leftCols(kinds), Eigen::ComputeFullV);
  std::vector<coupling::RigidMotion> free;
  for (int k = 0; k < kinds; ++k) {
    if (svd.singularValues()[k] > 1e-9 * std::max(scene.rate(), svd.singularValues()[0])) continue;
    Eigen::Vector<double, 6> motion = Eigen::Vector<double, 6>::Zero();
    motion.head(kinds) = svd.matrixV().col(k);
    free.push_back({motion.head<3>(), motion.tail<3>() / size});
  }
  return free;
}

double steady_step(const Scene& scene) {
  constexpr double most_relaxation_times = 10;
  if (scene.steady.step) return *scene.steady.step;
  double step = 0.5 / scene.rate();
  for (const ParticleScene& one : scene.particle_scenes())
    if (!one.particle.rigid()) step = std::min(step, most_relaxation_times * one.flow.viscosity * one.radius() / one.modulus());
  return step;
}

std::vector<motion::Conserved> conserved_quantities(const coupling::CoupledMotion& motion, const coupling::State& x) {
  const Net of_all = motion.capsule().geometry().volume_gradient(motion.shape(x));
  std::vector<motion::Conserved> kept;
  for (const coupling::Particle& particle : motion.capsule().particles()) {
    if (particle.rigid) continue;
    Net gradient = Net::Zero(of_all.rows(), 3);
    particle.block.rows(gradient) = particle.block.rows(of_all);
    kept.push_back({motion.state_of(gradient), motion::ModeKind::volume});
  }
  for (std::size_t k = 0; k < motion.fields().size(); ++k)
    if (coupling::State gradient = motion.conserved(k); !gradient.empty()) kept.push_back({std::move(gradient), motion::ModeKind::mass});
  return kept;
}

namespace {

/// Returns the number that the deck sets for the key at `path`. `of`: name of the key whose value is `path`, for example Continuation/parameter; used
/// in the error message. Throws UserError if the deck has no such number.
double number_of(const Scene& scene, const std::string& deck, const std::string& path, const std::string& of) {
  deck::Document read = deck::read_text(deck);
  Scene again(*scene.registry);
  read.declare(again);
  const auto values = read.values();
  const auto found = values.find(path);
  if (found == values.end()) throw UserError(of + " must be the path of a key that this deck gives, but is " + deck::in_quotes(path) + ".");
  char* end = nullptr;
  const double value = std::strtod(found->second.c_str(), &end);
  if (end == found->second.c_str() || *end != 0) throw UserError(of + " must be the path of a number, but " + path + " is " + found->second + ".");
  return value;
}

}  // namespace

Scene scene_of_branch(const Scene& scene, const ChangedScene& changed, const Parameters& parameters) {
  const motion::ContinuationOptions& branch = scene.continuation;
  std::vector<std::string> settings{branch.parameter + "=" + deck::real_text(parameters[0])};
  if (branch.second_parameter) settings.push_back(*branch.second_parameter + "=" + deck::real_text(parameters[1]));
  return with_field_lengths_of(scene, changed(settings));
}

Parameters first_parameters(const Scene& scene, const std::string& deck, const ChangedScene& changed) {
  const motion::ContinuationOptions& branch = scene.continuation;
  const double first = number_of(scene, deck, branch.parameter, "Continuation/parameter");
  if (first == branch.to) throw UserError("Continuation/to must differ from " + branch.parameter + ", where the branch begins.");
  const double second = branch.second_parameter ? number_of(scene, deck, *branch.second_parameter, "Continuation/second parameter") : 0;
  scene_of_branch(scene, changed, {branch.to, second});
  for (const double last : branch.second_values.value_or(std::vector<double>())) scene_of_branch(scene, changed, {first, last});
  return {first, second};
}

}  // namespace tanktread
