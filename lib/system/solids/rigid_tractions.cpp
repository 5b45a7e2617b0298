#include "system/solids/rigid_tractions.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/LU>

#include "system/solids/rigid_body.hpp"

namespace tanktread::coupling {

namespace {

using Flat = Eigen::Map<const Eigen::VectorXd>;

Flat flat(const Net& net) { return {net.data(), net.size()}; }

Eigen::Map<const Net> as_net(const Eigen::Ref<const Eigen::VectorXd>& numbers) { return {numbers.data(), numbers.size() / 3, 3}; }

/// Sets six columns to the velocities of a body's unit motions at x, in the rows of the body. If x is a control net, they are control values.
void set_unit_motions(const Net& x, const spline::Block& block, const Vec3& centre, Eigen::Ref<Eigen::MatrixXd> columns) {
  const Net own = block.rows(x);
  for (int k = 0; k < 6; ++k) columns.col(k).segment(3 * block.first_point, 3 * block.n_points) = flat(rigid_velocity(own, unit_motion(k), centre));
}

constexpr int strains = 5;

/// Sets five columns to the velocities of the unit strain flows at the sites of a body.
void set_unit_strains(const Net& at, const spline::Block& block, const Vec3& centre, Eigen::Ref<Eigen::MatrixXd> columns) {
  const Net from_centre = block.rows(at).rowwise() - centre.transpose();
  for (int k = 0; k < strains; ++k) columns.col(k).segment(3 * block.first_point, 3 * block.n_points) = flat(Net(from_centre * unit_strain(k)));
}

std::vector<Particle> bodies_among(std::span<const Particle> particles) {
  std::vector<Particle> bodies;
  std::ranges::copy_if(particles, std::back_inserter(bodies), [](const Particle& one) { return one.rigid.has_value(); });
  return bodies;
}

std::vector<spline::Block> blocks_of(std::span<const Particle> particles) {
  std::vector<spline::Block> blocks;
  for (const Particle& one : particles) blocks.push_back(one.block);
  return blocks;
}

/// Returns the changes of the motions, six per body, that produce the missing forces and torques. Prescribed motions do not change.
Eigen::VectorXd freed(const std::vector<int>& free, const Eigen::MatrixXd& resistance, const Eigen::VectorXd& missing) {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(missing.size());
  if (free.empty()) return motion;
  const Eigen::MatrixXd part = resistance(free, free);
  const Eigen::VectorXd right = missing(free), solution = part.partialPivLu().solve(right);
  motion(free) = solution;
  return motion;
}

}  // namespace

RigidTractions::RigidTractions(const spline::Space& space, const Net& unstressed, const Net& rest, std::span<const Particle> particles,
                               double viscosity, const quadrature::Options& quadrature, const SolverOptions& solvers,
                               const std::optional<stokes::PlaneWall>& wall, Tube* tube, const std::vector<int>& own, Ranks& ranks)
    : n_particles_(particles.size()),
      particles_(bodies_among(particles)),
      viscosity_(viscosity),
      walls_{tube},
      ranks_(ranks),
      layer_(particles_, viscosity, quadrature, wall, own, ranks),
      between_(between_sites(space, rest, blocks_of(particles_))),
      between_layer_(stokes::Layer::Kernel::single_layer, space, between_.places, quadrature),
      measure_(coupling::measure(particles)),
      sites_(collocation_matrix(space)),
      mass_(space, 8),  // mass matrix by eight Gauss points per direction, because the area element is not a polynomial
      krylov_(solvers.of(solvers.velocity)),
      tolerance_(solvers.tolerance),
      bodies_(particles_.size()) {
  between_layer_.set_reference(unstressed, measured_on_present(particles));
  if (std::vector<double> contrasts = viscosity_contrasts(particles); !contrasts.empty())
    between_double_.emplace(stokes::Layer::Kernel::double_layer, space, between_.places, quadrature, std::move(contrasts));
  if (wall) between_layer_.set_wall(*wall);
  if (wall && between_double_) between_double_->set_wall(*wall);
  for (std::size_t p = 0; p < particles_.size(); ++p)
    for (int k = 0; k < 6; ++k)
      if (!particles_[p].rigid->prescribed) free_.push_back(static_cast<int>(6 * p) + k);
}

void RigidTractions::repeat(const stokes::PeriodicCell& cell) {
  between_layer_.repeat(cell);
  if (between_double_) between_double_->repeat(cell);
  repeats_ = true;
}

/// Returns B y (see Surroundings::product), the left-hand side of the system for the unknowns y, including the regularising term of (2.10).
Net RigidTractions::product(const Net& y) {
  Net all = around_.product(y, repeats_ ? Net() : layer_.velocity(y));
  if (repeats_) all += layer_.regular(y);
  return all;
}

/// Returns the unknowns y, one column per column of `velocities`. In rows of bodies, `velocities` are velocities at the sites; in other rows, they
/// are the right-hand side for the velocity of deformable particles. If the surroundings do not respond, solves only for the force densities and
/// copies the other rows.
Eigen::MatrixXd RigidTractions::densities(const Eigen::MatrixXd& velocities) {
  reports_.clear();
  if (!around_.responds) return layer_.solved(velocities);
  const Eigen::Index n = velocities.rows();
  const auto apply = [&](const double* in, double* out) { Eigen::Map<Net>(out, n / 3, 3) = product(Eigen::Map<const Net>(in, n / 3, 3)); };
  const auto precondition = [&](const double* in, double* out) {
    Eigen::Map<Eigen::VectorXd>(out, n) = layer_.solved(Eigen::Map<const Eigen::VectorXd>(in, n));
  };
  const LinearSystem system{{{"traction", n}}, apply, precondition};
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, velocities.cols());
  for (Eigen::Index k = 0; k < all.cols(); ++k) {
    if (velocities.col(k).isZero(0)) continue;
    Eigen::VectorXd y = all.col(k);
    reports_.push_back(krylov_.solve(system, velocities.col(k), y, tolerance_));
    all.col(k) = y;
  }
  return all;
}

/// Returns the force densities in the unknowns y, with zero in the rows of deformable particles.
Net RigidTractions::force_densities(const Net& y) const {
  Net f = Net::Zero(y.rows(), 3);
  for (const Particle& body : particles_) body.block.rows(f) = body.block.rows(y);
  return f;
}

/// Returns the unknowns y. If the surroundings do not respond, adds the velocity that the force densities cause on deformable particles.
Net RigidTractions::completed(const Eigen::VectorXd& unknowns) {
  Net y = as_net(unknowns);
  if (around_.responds || alone()) return y;
  Net lacking = product(force_densities(y));
  for (const Particle& body : particles_) body.block.rows(lacking).setZero();
  return y - lacking;
}

/// Returns the amplitudes of the unit motions: prescribed motions, and the motions that give the prescribed forces and torques. `held`: forces and
/// torques on bodies at rest.
Eigen::VectorXd RigidTractions::motions(const Eigen::MatrixXd& resistance, const Eigen::VectorXd& held, std::span<const Rigid> driven) const {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(held.size()), given = motion;
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const Rigid& rigid = driven[p];
    const auto first = static_cast<Eigen::Index>(6 * p);
    if (rigid.prescribed)
      motion.segment<6>(first) << rigid.motion.velocity, rigid.motion.angular_velocity;
    else
      given.segment<6>(first) << rigid.force, rigid.torque;
  }
  return motion + freed(free_, resistance, given - held - resistance * motion);
}

/// Returns int N_A (v - u) dG over the bodies, the collocation error weighted by the spline functions N_A, where u is the velocity of the fluid at
/// the Gauss points `between_`. `flow`: v_inf at these points. `v`: velocity of all particles.
Net RigidTractions::left_over(const Net& x, const Net& y, const Net& v, Net flow) {
  between_layer_.place(x, measure_);
  if (between_double_) between_double_->place(x);
  const Net at = between_.values * x, load = around_.load(y);
  const Tube::Response response = walls_.tube ? walls_.tube->respond(load, v) : Tube::Response();
  const Solids::Flow by_solids = walls_.solids ? walls_.solids->respond(load, v) + walls_.solids->empty() : Solids::Flow();
  flow += ranks_.divided<Net>(static_cast<int>(at.rows()), 3, [&](std::span<const int> own, Net& u) {
    between_layer_.apply(load, own, u);
    u /= -viscosity_;
    Net part(u.rows(), 3);
    const auto add = [&] { u(own, Eigen::all) += part(own, Eigen::all); };
    if (between_double_) between_double_->apply(v, own, part), add();
    if (walls_.tube) walls_.tube->velocity_at(at, response, own, part), add();
    if (walls_.solids) walls_.solids->velocity_at(at, own, by_solids, part), add();
  });
  return between_.weights * (between_.values * v - flow);
}

void RigidTractions::solve(const Net& x, std::span<const Vec3> centres, std::span<const Rigid> driven, const stokes::AmbientFlow& flow,
                           Surroundings around) {
  const Eigen::Index n = 3 * x.rows(), m = 6 * static_cast<Eigen::Index>(particles_.size());
  around_ = std::move(around);
  at_ = sites_ * x;
  layer_.place(x, at_, around_.responds && !repeats_);
  Eigen::MatrixXd velocities = Eigen::MatrixXd::Zero(n, m + 1), fields = Eigen::MatrixXd::Zero(n, m);
  const Net at_sites = sites_ * around_.flow;
  Net empty = -around_.flow;
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const auto column = static_cast<Eigen::Index>(6 * p);
    const spline::Block& block = particles_[p].block;
    set_unit_motions(at_, block, centres[p], velocities.middleCols<6>(column));
    set_unit_motions(x, block, centres[p], fields.middleCols<6>(column));
    block.rows(empty) = block.rows(at_sites);
  }
  velocities.col(m) = flat(empty);
  const Eigen::MatrixXd of_all = densities(velocities), z = of_all.leftCols(m);

  const Eigen::SparseMatrix<double>& mass = mass_.update(x);
  Eigen::MatrixXd work(n, m);  // the inner product of column k with a force density is the work of the density in unit motion k
  for (Eigen::Index k = 0; k < m; ++k) work.col(k) = flat(Net(mass * as_net(fields.col(k))));
  const Eigen::MatrixXd resistance = work.transpose() * z;
  Eigen::VectorXd motion = motions(resistance, -work.transpose() * of_all.col(m), driven);
  Eigen::VectorXd y = z * motion - of_all.col(m);
  Net v = completed(y);
  const Net unknowns = v;
  const Eigen::VectorXd moving = fields * motion;
  for (const Particle& body : particles_) body.block.rows(v) = body.block.rows(as_net(moving));
  const Net between = flow.velocities(between_.values * x);
  left_ = flat(left_over(x, unknowns, v, between));
  const Eigen::VectorXd lacks = of_all.transpose() * left_, lacking = lacks.head(m);
  const Eigen::VectorXd change = freed(free_, resistance, -lacking);
  motion += change;
  y += z * change;
  unknowns_ = completed(y);
  const Eigen::VectorXd integrals = work.transpose() * y + lacking;
  const Net f = force_densities(unknowns_);
  if (walls_.tube && flow.duct() && alone())
    lacking_pressure_ = walls_.tube->lacking_pressure(between_, between, flow.amplitude(), f, lacks[m]);
  const Net weighted = mass * f;
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const auto first = static_cast<Eigen::Index>(6 * p);
    const spline::Block& block = particles_[p].block;
    bodies_[p] = {{motion.segment<3>(first), motion.segment<3>(first + 3)}, integrals.segment<3>(first), integrals.segment<3>(first + 3),
                  block.rows(weighted).transpose() * (block.rows(x).rowwise() - centres[p].transpose())};
  }
  centres_.assign(centres.begin(), centres.end());
}

Mat3 RigidTractions::moment(std::size_t p) {
  if (walls_.tube) return bodies_[p].moment;
  Eigen::MatrixXd velocities = Eigen::MatrixXd::Zero(left_.size(), strains);
  set_unit_strains(at_, particles_[p].block, centres_[p], velocities);
  return bodies_[p].moment + strain_of_products(densities(velocities).transpose() * left_);
}

}  // namespace tanktread::coupling
