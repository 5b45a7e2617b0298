#include "coupling/rigid_tractions.hpp"

#include <Eigen/LU>

#include "base/dense_factors.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {

namespace {

using Flat = Eigen::Map<const Eigen::VectorXd>;

Flat flat(const Net& net) { return {net.data(), net.size()}; }

Eigen::Map<const Net> as_net(const Eigen::Ref<const Eigen::VectorXd>& numbers) { return {numbers.data(), numbers.size() / 3, 3}; }

/// The six unit motions of a body in its rows of six columns, at points or as control values.
void set_unit_motions(const Net& x, const spline::Block& block, const Vec3& centre, Eigen::Ref<Eigen::MatrixXd> columns) {
  const Net own = block.rows(x);
  for (int k = 0; k < 6; ++k) columns.col(k).segment(3 * block.first_point, 3 * block.n_points) = flat(rigid_velocity(own, unit_motion(k), centre));
}

/// The motions, of those that are free, that take this much force and torque; 0 of the others.
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
                               const quadrature::Options& quadrature, const std::optional<stokes::PlaneWall>& wall, Ranks& ranks)
    : particles_(particles),
      viscosity_(viscosity),
      ranks_(ranks),
      own_points_(ranks.share(space.n_points)),
      between_(between_sites(space, rest)),
      layer_(stokes::Layer::Kernel::single_layer, space, space.collocation, quadrature),
      between_layer_(stokes::Layer::Kernel::single_layer, space, between_.places, quadrature),
      sites_(collocation_matrix(space)),
      mass_(space, 8),  // eight points: the area is no polynomial
      bodies_(particles.size()) {
  for (stokes::Layer* layer : {&layer_, &between_layer_})
    if (wall) layer->set_wall(*wall);
  for (std::size_t p = 0; p < particles.size(); ++p)
    for (int k = 0; k < 6; ++k)
      if (!particles[p].rigid->prescribed) free_.push_back(static_cast<int>(6 * p) + k);
}

/// A at the sites, which are `at`, with s (R c) b^T/(b.c) of each body.
Eigen::MatrixXd RigidTractions::system(const Net& x, const Net& at) {
  const Eigen::Index n = 3 * x.rows();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
  stokes::Rows<double> rows;
  layer_.assemble(own_points_, rows);
  for (std::size_t i = 0; i < own_points_.size(); ++i) all.middleRows<3>(3 * own_points_[i]) = rows.middleRows<3>(3 * static_cast<Eigen::Index>(i));
  ranks_.add({all.data(), static_cast<std::size_t>(all.size())});
  for (const Particle& body : particles_) {
    const Eigen::Index first = 3 * body.block.first_point, length = 3 * body.block.n_points;
    const Net flux = surface::Geometry(*body.space).volume_gradient(body.block.rows(x));
    // Any velocity with a flux makes the system regular; that away from the middle is one.
    const Net own = body.block.rows(at), outward = (own.rowwise() - own.colwise().mean()) / body.radius;
    const double weight = 2 * body.radius / 3 / flux.cwiseProduct(outward).sum();
    all.block(first, first, length, length) += weight * flat(outward) * flat(flux).transpose();
  }
  return all;
}

/// Amplitudes of unit motions: those that are given, and those with which force and torque are; `held`: forces and torques of bodies that stay.
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

/// int N_A (v - v_inf - (1/mu) A f) dG, v that of these control values.
Net RigidTractions::left_over(const Net& x, const Net& f, const Net& v, const stokes::AmbientFlow& flow) {
  between_layer_.place(x);
  Net u = Net::Zero(between_.values.rows(), 3);
  between_layer_.apply(f, ranks_.share(static_cast<int>(u.rows())), u);
  ranks_.add({u.data(), static_cast<std::size_t>(u.size())});
  return between_.weights * (between_.values * v - flow.velocities(between_.values * x) - u / viscosity_);
}

void RigidTractions::solve(const Net& x, std::span<const Vec3> centres, std::span<const Rigid> driven, const stokes::AmbientFlow& flow) {
  const Eigen::Index n = 3 * x.rows(), m = 6 * static_cast<Eigen::Index>(particles_.size());
  layer_.place(x);
  const Net at = sites_ * x;
  Eigen::MatrixXd velocities = Eigen::MatrixXd::Zero(n, m + 1), fields = Eigen::MatrixXd::Zero(n, m);
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const auto column = static_cast<Eigen::Index>(6 * p);
    set_unit_motions(at, particles_[p].block, centres[p], velocities.middleCols<6>(column));
    set_unit_motions(x, particles_[p].block, centres[p], fields.middleCols<6>(column));
  }
  velocities.col(m) = flat(flow.velocities(at));
  const Eigen::MatrixXd of_all = viscosity_ * DenseFactors(system(x, at)).solve(velocities), z = of_all.leftCols(m);

  const Eigen::SparseMatrix<double>& mass = mass_.update(x);
  Eigen::MatrixXd work(n, m);  // of a density with each unit motion
  for (Eigen::Index k = 0; k < m; ++k) work.col(k) = flat(Net(mass * as_net(fields.col(k))));
  const Eigen::MatrixXd resistance = work.transpose() * z;
  Eigen::VectorXd motion = motions(resistance, -work.transpose() * of_all.col(m), driven);
  Eigen::VectorXd f = z * motion - of_all.col(m);
  const Eigen::VectorXd v = fields * motion, lacking = z.transpose() * flat(left_over(x, as_net(f), as_net(v), flow));
  const Eigen::VectorXd change = freed(free_, resistance, -lacking);
  motion += change;
  f += z * change;
  const Eigen::VectorXd integrals = work.transpose() * f + lacking;
  density_ = as_net(f);
  const Net weighted = mass * density_;
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const auto first = static_cast<Eigen::Index>(6 * p);
    const spline::Block& block = particles_[p].block;
    bodies_[p] = {{motion.segment<3>(first), motion.segment<3>(first + 3)}, integrals.segment<3>(first), integrals.segment<3>(first + 3),
                  block.rows(weighted).transpose() * (block.rows(x).rowwise() - centres[p].transpose())};
  }
}

}  // namespace tanktread::coupling
