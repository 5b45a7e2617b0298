#include "scene/domain.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <Eigen/LU>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/section.hpp"
#include "scene/scene.hpp"
#include "scene/series/diagnostics.hpp"
#include "stokes/flow/ambient_flow.hpp"

namespace tanktread {

void DomainOptions::declare(deck::Section& section) {
  if (registered && !registered->empty()) declare_medium(section);
  if (medium) return;
  section.key("periodic", periodic, deck::Choice{"x1 x2 x3", "x1 x2", "x1 x3", "x2 x3", "x1", "x2", "x3"},
              "directions in which particles and flow are periodic. If all three are periodic, the mean velocity over the cell, particles "
              "included, equals the ambient flow, and a net force on the particles is balanced by a uniform pressure gradient");
  section.key("side lengths", side_lengths, deck::any(), "length",
              "side lengths of a rectangular periodic cell along x1, x2, x3. The length along a direction that is not periodic has no effect. With "
              "Tube or Channel only the first length is used, the period along x1");
  section.key("lattice vectors", lattice_vectors, deck::any(), "length",
              "vectors of the periods of a cell that is not rectangular, at time zero: nine numbers, first the vector for x1, then for x2, "
              "then for x3. The flow convects the lattice");
}

int DomainOptions::directions() const { return static_cast<int>(std::ranges::count(periodic, 'x')); }

/// Returns the lattice vectors as columns. The vectors of periodic directions come first, and the other columns are zero.
Mat3 DomainOptions::vectors() const {
  Mat3 vectors = Mat3::Zero();
  int n = 0;
  for (int d = 0; d < 3; ++d) {
    if (periodic.find(static_cast<char>('1' + d)) == std::string::npos) continue;
    const auto along = static_cast<std::size_t>(d);
    vectors.col(n++) = side_lengths ? Vec3((*side_lengths)[along] * Vec3::Unit(d)) : Vec3(lattice_vectors.value().row(d).transpose());
  }
  return vectors;
}

namespace {

/// Returns true if the flow fits the lattice: if it is affine, or if its velocity is equal in all cells. If the direction of the flow changes in
/// time, the velocities are compared for several directions. `vectors`: the lattice vectors as columns.
bool repeats(const stokes::AmbientFlow& flow, const Eigen::Ref<const Eigen::MatrixXd>& vectors) {
  if (flow.affine()) return true;
  const Net places = vectors.norm() * (Net(4, 3) << 0.1, 0.2, -0.3, 0.5, -0.1, 0.2, -0.4, 0.3, 0.6, 0.2, 0.7, 0.1).finished();
  for (const stokes::AmbientFlow& one : flow.rotated_copies())
    for (Eigen::Index d = 0; d < vectors.cols(); ++d) {
      const Net here = one.velocities(places), there = one.velocities(places.rowwise() + vectors.col(d).transpose());
      if ((there - here).norm() > 1e-9 * here.norm()) return false;
    }
  return true;
}

}  // namespace

bool DomainOptions::deforms(const stokes::FlowOptions& flow) const {
  const Mat3 all = vectors();
  const auto columns = all.leftCols(directions());
  const Mat3 gradient = stokes::AmbientFlow(flow).cell_gradient();
  return (gradient * columns).norm() > 1e-12 * gradient.norm() * columns.norm();
}

void DomainOptions::check(const stokes::FlowOptions& flow, const std::string& duct) const {
  if (medium && flow.type != "duct") check_flow(flow, *medium, "Domain/kind `" + kind + "`");
  if (!present) return;
  if (!duct.empty()) return check_duct(duct);
  if (side_lengths.has_value() == lattice_vectors.has_value())
    throw UserError(side_lengths ? "Domain/side lengths and Domain/lattice vectors contradict each other: give one of them."
                                 : "Domain needs Domain/side lengths or Domain/lattice vectors.");
  refuse(flow.type == "duct", "Domain", flow.choice(), "the flow of a duct needs a section Tube or Channel");
  if (side_lengths && side_lengths->size() != 3) throw UserError("Domain/side lengths needs three numbers, along x1, x2 and x3.");
  const Mat3 all = vectors();
  const auto columns = all.leftCols(directions());
  double product = 1;
  for (int d = 0; d < directions(); ++d) {
    if (side_lengths && !(columns.col(d).sum() > 0)) throw UserError("Domain/side lengths must be positive in the directions of Domain/periodic.");
    product *= columns.col(d).squaredNorm();
  }
  const double volume = std::sqrt(std::max(0., (columns.transpose() * columns).determinant()));
  if (!(volume > 1e-6 * std::sqrt(product)))
    throw UserError(formatted("Domain/lattice vectors must span a cell, but those given have no volume: it is %.3g.", volume));
}

void DomainOptions::reject_duct(const std::string& duct, Rejections& to) const {
  to.pair(periodic != "x1", {"Domain/periodic `" + periodic + "`", "Domain/periodic of another direction than x1"}, duct,
          "a tube or channel is periodic along x1 only: give `x1`");
  to.pair(lattice_vectors.has_value(), "Domain/lattice vectors", duct, "give the period along x1 as Domain/side lengths");
}

/// Throws UserError if the keys do not describe a periodic duct. Ducts can only be periodic along x1: tubes of constant cross-section, and channels
/// whose profile returns to the cross-section at the start.
void DomainOptions::check_duct(const std::string& duct) const {
  Rejections found;
  reject_duct(duct, found);
  found.throw_if_any();
  if (!side_lengths) throw UserError("Domain needs Domain/side lengths, the period of " + duct + " along x1.");
  if (!(side_lengths->front() > 0)) throw UserError("Domain/side lengths must be positive in the directions of Domain/periodic.");
}

void DomainOptions::reject(const ParticleScene& particle_scene, Rejections& to) const {
  if (medium || to.every()) reject_medium(particle_scene, to);
  if (!present && !to.every()) return;
  if (to.every()) reject_duct("Tube or Channel", to);
  to.pair(!particle_scene.tube.present && !to.every() && !repeats(stokes::AmbientFlow(particle_scene.flow), vectors().leftCols(directions())),
          {"Domain/periodic `" + periodic + "`", "Domain/periodic"}, particle_scene.flow_choice(),
          "the flow must be the same in every cell, except for a uniform gradient");
  if (particle_scene.tube.present) return;
  const bool prescribed = particle_scene.particle.motion == Motion::prescribed;
  const std::string force = prescribed ? particle_scene.particle.choice() : std::string(particle_scene.net_force());
  to.pair(!to.every() && !particle_scene.runs_in_time() && deforms(particle_scene.flow), particle_scene.sought(), particle_scene.flow_choice(),
          reason::unsteady);
  to.pair(particle_scene.quadrature.rule == quadrature::LayerRule::desingularised, "Domain", "Quadrature/rule `desingularised`",
          reason::desingularised);
  to.pair(directions() < 3 && !particle_scene.wall.solid && !force.empty(),
          {"Domain/periodic `" + periodic + "`", "Domain/periodic of one or two directions"},
          {force, "Particle/motion `prescribed`, Particle/density difference, Particle/force, or Membrane/forces with a net force"},
          "a net force in every cell needs a lattice that is periodic in three directions, or walls");
}

std::optional<stokes::PeriodicCell> DomainOptions::cell() const {
  if (!present) return {};
  return stokes::PeriodicCell(vectors(), directions());
}

void DomainRow::set_stress(double viscosity, const Mat3& gradient, const stokes::PeriodicCell& of, const Mat3& plane, double volume,
                           const Mat3& stresslet, const Vec3& force) {
  const Mat3 strain = (gradient + gradient.transpose()) / 2;
  volume_fraction = volume / of.volume();
  stress = stresslet / of.volume();
  const Vec3 normal = (plane * stress * plane.transpose()).diagonal();
  normal_stress_differences << normal[0] - normal[2], normal[2] - normal[1];
  pressure_gradient = force / of.volume();
  relative_viscosity = strain.isZero(0) ? std::numeric_limits<double>::quiet_NaN()
                                        : 1 + stress.cwiseProduct(strain).sum() / (2 * viscosity * strain.squaredNorm());
}

void DomainRow::add_columns(const SharedOptions& shared, Columns& to) const {
  if (!to.when(shared.domain.present)) return;
  to.add(cell.reshaped(), "1_x1 1_x2 1_x3 2_x1 2_x2 2_x3 3_x1 3_x2 3_x3",
         {"cell_", "length",
          "component # (number of the vector, then direction) of the period vectors of the periodic cell at this time, the shortest of the "
          "lattice: as it deforms, they change places; in directions that are not periodic, they are unit vectors"});
  if (!to.when(shared.domain.directions() == 3)) return;
  to.add(volume_fraction, {"volume_fraction", "1", "volume of the particles divided by the volume of the periodic cell"});
  to.add(components(stress), "11 22 33 12 13 23",
         {"particle_stress_", "force/length^2",
          "component # of the contribution of the particles to the mean stress, without its trace and, if Particle/torque is given, without its "
          "antisymmetric part (6.9)"});
  to.add(pressure_gradient, "x1 x2 x3",
         {"pressure_gradient_", "force/length^3",
          "component # of the uniform pressure gradient that balances the force of the particles on the fluid; with posts or walls, the given "
          "pressure gradient that drives the flow"});
  if (!to.when(has_intrinsic_viscosity(shared))) return;
  to.add(relative_viscosity,
         {"relative_viscosity", "1", "effective viscosity of the suspension divided by the viscosity of the outer fluid (6.10)",
          "the rate of strain of the flow is zero at this time"});
  to.add(normal_stress_differences, "1 2",
         {"normal_stress_difference_", "force/length^2",
          "normal stress difference # of the particle stress: 1 is component 11 minus 33, 2 is component 33 minus 22, where 1 is the "
          "direction of a simple shear flow, 3 that of its velocity gradient and 2 the normal of both; in other flows in a plane, 1 and 3 are the "
          "axes of that plane"});
}

/// Reads the kind of the domain and the section of the chosen medium. Throws UserError if the deck has keys of another kind.
void DomainOptions::declare_medium(deck::Section& section) {
  deck::Choice kinds{"lattice"};
  std::ranges::copy(registered->names(), std::back_inserter(kinds));
  section.key("kind", kind, kinds,
              "`lattice`: fluid and particles are periodic. Other kinds: boundaries of the fluid that this program adds");
  const auto make = registered->read(section, kind, "kind");
  medium = make ? make() : nullptr;
  for (const char* key : {"periodic", "side lengths", "lattice vectors"})
    if (medium && section.given(key))
      throw UserError(section.path(key) + " belongs to Domain/kind `lattice`, but Domain/kind is `" + kind + "`.");
}

void DomainOptions::reject_medium(const ParticleScene& particle_scene, Rejections& to) const {
  const Chosen added("Domain/kind `" + kind + "`", "Domain/kind of an added medium");
  to.pair(particle_scene.tube.present, added, particle_scene.duct_choice(), "a duct encloses all of its fluid");
  to.pair(particle_scene.wall.present, added, "Wall", "a plane wall is a medium itself");
  to.pair(particle_scene.quadrature.rule != quadrature::LayerRule::adaptive, added,
          {"Quadrature/rule `" + deck::word(quadrature::layer_rules, particle_scene.quadrature.rule) + "`",
           "Quadrature/rule `fixed` or `desingularised`"},
          "integrals close to its boundaries need quadrature to a tolerance; give `adaptive`");
  to.pair(!particle_scene.runs_in_time(), particle_scene.sought(), added,
          "a deformable particle next to a boundary moves away from it or towards it, so that no shape is steady");
  to.pair(particle_scene.particle.drift == "held", added, "Particle/drift `held`", reason::drift);
}

void check_flow(const stokes::FlowOptions& flow, const stokes::Medium& medium, const std::string& name) {
  for (const stokes::AmbientFlow& ambient : stokes::AmbientFlow(flow).rotated_copies())
    if (const std::string reason = medium.refusal(ambient); !reason.empty())
      throw UserError(name + " and Flow/type `" + flow.type + "` contradict each other: " + reason);
}

}  // namespace tanktread
