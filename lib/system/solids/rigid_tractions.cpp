#include "system/solids/rigid_tractions.hpp"

#include <utility>

#include <Eigen/LU>

#include "surface/geometry.hpp"
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

RigidTractions::RigidTractions(const spline::Space& space, const Net& rest, std::span<const Particle> particles, double viscosity,
                               const quadrature::Options& quadrature, const SolverOptions& solvers, const std::optional<stokes::PlaneWall>& wall,
                               Tube* tube, Ranks& ranks)
    : particles_(particles),
      viscosity_(viscosity),
      around_{tube},
      ranks_(ranks),
      own_points_(ranks.share(space.n_points)),
      between_(between_sites(space, rest)),
      layer_(stokes::Layer::Kernel::single_layer, space, space.collocation, quadrature),
      between_layer_(stokes::Layer::Kernel::single_layer, space, between_.places, quadrature),
      sites_(collocation_matrix(space)),
      mass_(space, 8),  // eight Gauss points per direction, because the area element is not a polynomial
      krylov_(solvers.of(solvers.velocity)),
      tolerance_(solvers.tolerance),
      bodies_(particles.size()) {
  for (stokes::Layer* layer : {&layer_, &between_layer_})
    if (wall) layer->set_wall(*wall);
  for (std::size_t p = 0; p < particles.size(); ++p)
    for (int k = 0; k < 6; ++k)
      if (!particles[p].rigid->prescribed) free_.push_back(static_cast<int>(6 * p) + k);
}

void RigidTractions::repeat(const stokes::PeriodicCell& cell) {
  for (stokes::Layer* layer : {&layer_, &between_layer_}) layer->repeat(cell);
  repeats_ = true;
}

/// Sets, for each body, the two vectors of the regularising term of (2.10): the flux vector b = dV/dx, and s (R c)/(b.c), with R c the values of a
/// velocity field c at the sites and s a scale. Any field c with nonzero flux b.c makes the system regular; the radial field about the mean of the
/// sites is used.
void RigidTractions::make_regular(const Net& x, const Net& at) {
  flux_ = outward_ = Net::Zero(x.rows(), 3);
  for (const Particle& body : particles_) {
    const Net own = body.block.rows(at), outward = own.rowwise() - own.colwise().mean();
    body.block.rows(flux_) = surface::Geometry(*body.space).volume_gradient(body.block.rows(x));
    body.block.rows(outward_) = 2 * body.radius / 3 / body.block.rows(flux_).cwiseProduct(outward).sum() * outward;
  }
}

/// Returns the regularised single-layer operator A of the bodies at the sites, without the images on a lattice and the response of a tube.
Eigen::MatrixXd RigidTractions::system() {
  const Eigen::Index n = flux_.size();
  Eigen::MatrixXd all = ranks_.assembled<Eigen::MatrixXd>(n, n, [&](Eigen::MatrixXd& own) {
    stokes::Rows<double> rows;
    layer_.assemble(own_points_, rows);
    for (std::size_t i = 0; i < own_points_.size(); ++i) own.middleRows<3>(3 * own_points_[i]) = rows.middleRows<3>(3 * static_cast<Eigen::Index>(i));
  });
  for (const Particle& body : particles_) {
    const Eigen::Index first = 3 * body.block.first_point, length = 3 * body.block.n_points;
    all.block(first, first, length, length) += flat(outward_).segment(first, length) * flat(flux_).segment(first, length).transpose();
  }
  return all;
}

/// Returns the product of f with the regularised single layer A that includes all lattice images.
Net RigidTractions::images_of(const Net& f) {
  Net u = ranks_.divided<Net>(static_cast<int>(f.rows()), 3, [&](std::span<const int> own, Net& rows) { layer_.apply(f, own, rows); });
  for (const Particle& body : particles_)
    body.block.rows(u) += body.block.rows(flux_).cwiseProduct(body.block.rows(f)).sum() * body.block.rows(outward_);
  if (around_.solids) u -= viscosity_ * by_solids(at_, around_.solids->respond(f, {}));
  return u;
}

/// Returns the velocity of a flow of the solids at points on the bodies.
Net RigidTractions::by_solids(const Net& at, const Solids::Flow& flow) {
  return ranks_.divided<Net>(static_cast<int>(at.rows()), 3, [&](std::span<const int> own, Net& u) {
    if (&at == &at_) around_.solids->velocities(flow, u);
    else around_.solids->velocity_at(at, own, flow, u);
  });
}

/// Returns the velocity without bodies: v_inf, and the flow that solids add to it.
Net RigidTractions::flow_at(const Net& at, const stokes::AmbientFlow& flow) {
  Net v = flow.velocities(at);
  if (around_.solids) v += by_solids(at, around_.solids->empty());
  return v;
}

void RigidTractions::factor() {
  factors_.reset();  // frees the old factors before the new matrix is allocated
  alone_ = system();
  if (around_.tube)
    factors_.emplace(alone_);
  else
    factors_.emplace(std::exchange(alone_, {}));
}

/// Returns the force densities that produce the given velocities at the sites, one per column, for the viscosity 1.
Eigen::MatrixXd RigidTractions::densities(const Eigen::MatrixXd& velocities) {
  reports_.clear();
  if (!repeats_ && !around_.tube) return factors_->solve(velocities);
  const Eigen::Index n = velocities.rows();
  const auto apply = [&](const double* in, double* out) {
    const Net f = Eigen::Map<const Net>(in, n / 3, 3);
    Eigen::Map<Net> u(out, n / 3, 3);
    if (repeats_)
      u = images_of(f);
    else
      u = as_net(alone_ * flat(f)) - viscosity_ * around_.tube->respond(f).velocity;
  };
  const auto precondition = [&](const double* in, double* out) {
    Eigen::Map<Eigen::VectorXd>(out, n) = factors_->solve(Eigen::Map<const Eigen::VectorXd>(in, n));
  };
  const LinearSystem system{{{"traction", n}}, apply, precondition};
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, velocities.cols());
  for (Eigen::Index k = 0; k < all.cols(); ++k) {
    if (velocities.col(k).isZero(0)) continue;
    Eigen::VectorXd f = all.col(k);
    reports_.push_back(krylov_.solve(system, velocities.col(k), f, tolerance_));
    all.col(k) = f;
  }
  return all;
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

/// Returns int N_A (v - v_inf - (1/mu) A f) dG, the collocation error weighted by the spline functions N_A. v: control values. `flow`: v_inf at the
/// Gauss points `between_`.
Net RigidTractions::left_over(const Net& x, const Net& f, const Net& v, const Net& flow) {
  between_layer_.place(x);
  const Net at = between_.values * x;
  const Tube::Response response = around_.tube ? around_.tube->respond(f) : Tube::Response();
  const Solids::Flow by_solids = around_.solids ? around_.solids->respond(f, {}) : Solids::Flow();
  const Net u = ranks_.divided<Net>(static_cast<int>(at.rows()), 3, [&](std::span<const int> own, Net& part) {
    between_layer_.apply(f, own, part);
    Net answer(part.rows(), 3);
    if (around_.tube) around_.tube->velocity_at(at, response, own, answer), part(own, Eigen::all) -= viscosity_ * answer(own, Eigen::all);
    if (around_.solids) around_.solids->velocity_at(at, own, by_solids, answer), part(own, Eigen::all) -= viscosity_ * answer(own, Eigen::all);
  });
  return between_.weights * (between_.values * v - flow - u / viscosity_);
}

void RigidTractions::solve(const Net& x, std::span<const Vec3> centres, std::span<const Rigid> driven, const stokes::AmbientFlow& flow) {
  const Eigen::Index n = 3 * x.rows(), m = 6 * static_cast<Eigen::Index>(particles_.size());
  layer_.place(x);
  const Net at = at_ = sites_ * x;
  if (around_.solids) around_.solids->place(x, at_, own_points_);
  Eigen::MatrixXd velocities = Eigen::MatrixXd::Zero(n, m + 1), fields = Eigen::MatrixXd::Zero(n, m);
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const auto column = static_cast<Eigen::Index>(6 * p);
    set_unit_motions(at, particles_[p].block, centres[p], velocities.middleCols<6>(column));
    set_unit_motions(x, particles_[p].block, centres[p], fields.middleCols<6>(column));
  }
  velocities.col(m) = flat(flow_at(at_, flow));
  make_regular(x, at);
  factor();
  const Eigen::MatrixXd of_all = viscosity_ * densities(velocities), z = of_all.leftCols(m);

  const Eigen::SparseMatrix<double>& mass = mass_.update(x);
  Eigen::MatrixXd work(n, m);  // product of column k with a density: work of this density in the unit motion k
  for (Eigen::Index k = 0; k < m; ++k) work.col(k) = flat(Net(mass * as_net(fields.col(k))));
  const Eigen::MatrixXd resistance = work.transpose() * z;
  Eigen::VectorXd motion = motions(resistance, -work.transpose() * of_all.col(m), driven);
  Eigen::VectorXd f = z * motion - of_all.col(m);
  const Net between = flow_at(between_.values * x, flow);
  const Eigen::VectorXd v = fields * motion;
  left_ = flat(left_over(x, as_net(f), as_net(v), between));
  const Eigen::VectorXd lacks = of_all.transpose() * left_, lacking = lacks.head(m);
  const Eigen::VectorXd change = freed(free_, resistance, -lacking);
  motion += change;
  f += z * change;
  const Eigen::VectorXd integrals = work.transpose() * f + lacking;
  density_ = as_net(f);
  if (around_.tube && flow.duct()) lacking_pressure_ = around_.tube->lacking_pressure(between_, between, flow.amplitude(), density_, lacks[m]);
  const Net weighted = mass * density_;
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const auto first = static_cast<Eigen::Index>(6 * p);
    const spline::Block& block = particles_[p].block;
    bodies_[p] = {{motion.segment<3>(first), motion.segment<3>(first + 3)}, integrals.segment<3>(first), integrals.segment<3>(first + 3),
                  block.rows(weighted).transpose() * (block.rows(x).rowwise() - centres[p].transpose())};
  }
  centres_.assign(centres.begin(), centres.end());
}

Mat3 RigidTractions::moment(std::size_t p) {
  if (around_.tube) return bodies_[p].moment;
  Eigen::MatrixXd velocities = Eigen::MatrixXd::Zero(left_.size(), strains);
  set_unit_strains(at_, particles_[p].block, centres_[p], velocities);
  return bodies_[p].moment + strain_of_products(viscosity_ * densities(velocities).transpose() * left_);
}

}  // namespace tanktread::coupling
