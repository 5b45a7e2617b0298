#include "system/solids/bodies/body_density.hpp"

#include <vector>

#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include "base/indices.hpp"
#include "base/small_matrices.hpp"
#include "membrane/direct_solver.hpp"
#include "membrane/mass.hpp"
#include "stokes/layer.hpp"
#include "surface/geometry.hpp"
#include "system/parallel/stop_together.hpp"
#include "system/targets/collocation.hpp"

namespace tanktread::coupling {

namespace {

/// Returns the single layer A f at the given sites, for each of six densities f.
std::array<Net, 6> single_layer_at(const stokes::Sites& sites, const spline::Space& space, const Net& surface, const std::array<Net, 6>& f,
                                   const quadrature::Options& quadrature) {
  stokes::Layer layer(stokes::Layer::Kernel::single_layer, space, sites, quadrature);
  layer.set_shape(surface);
  const std::vector<int> all = indices(sites.size());
  std::array<Net, 6> u;
  u.fill(Net(sites.size(), 3));
  for (std::size_t k = 0; k < f.size(); ++k) layer.apply(f[k], all, u[k]);
  return u;
}

/// Returns the product of `weights`, shape (N, sites), and the double-layer matrix H at the sites. Row 3 a + c of the product belongs to row a of the
/// weights and velocity component c. To save memory, the rows of H are assembled in chunks.
Eigen::MatrixXd weighted_double_layer(const stokes::Sites& sites, const Eigen::SparseMatrix<double>& weights, const spline::Space& space,
                                      const Net& surface, const quadrature::Options& quadrature) {
  constexpr int at_a_time = 512;
  using Strided = Eigen::Map<const stokes::Rows<double>, 0, Eigen::OuterStride<>>;
  stokes::Layer layer(stokes::Layer::Kernel::double_layer, space, sites, quadrature);
  layer.set_shape(surface);
  const int n_sites = static_cast<int>(sites.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3 * weights.rows(), surface.size());
  stokes::Rows<double> rows;
  for (int first = 0; first < n_sites; first += at_a_time) {
    const int last = std::min(first + at_a_time, n_sites);
    stop_together([&] { layer.assemble(indices(last - first, first), rows); });
    for (int c = 0; c < 3; ++c)
      sum(Eigen::seq(c, Eigen::last, 3), Eigen::all) +=
          weights.middleCols(first, last - first) * Strided(rows.row(c).data(), last - first, rows.cols(), Eigen::OuterStride<>(3 * rows.cols()));
  }
  return sum;
}

}  // namespace

SelfCorrection::SelfCorrection(const spline::Space& space, const Net& surface, const quadrature::Options& quadrature) {
  const auto [places, at_places, weights] = between_sites(space, surface);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> mass(weights * at_places);
  membrane::DirectSolver interpolation;
  interpolation.factor(collocation_matrix(space));
  const Vec3 centre = surface::measures(space, surface).centroid;
  for (std::size_t k = 0; k < 6; ++k) loads[k] = rigid_velocity(surface, unit_motion(static_cast<int>(k)), centre);
  const std::array<Net, 6> at_sites = single_layer_at(space.collocation, space, surface, loads, quadrature);
  const std::array<Net, 6> everywhere = single_layer_at(places, space, surface, loads, quadrature);
  for (std::size_t k = 0; k < 6; ++k) loads[k] = mass.solve(weights * (everywhere[k] - at_places * interpolation.solve(at_sites[k])));

  const int n = space.n_points;
  if (n > most_points) return;
  Eigen::SparseMatrix<double> identity(n, n);
  identity.setIdentity();
  const Eigen::MatrixXd projected = weighted_double_layer(places, weights, space, surface, quadrature);
  const Eigen::MatrixXd collocated = weighted_double_layer(space.collocation, identity, space, surface, quadrature);
  density.resize(3 * n, 3 * n);
  for (int column = 0; column < 3 * n; ++column) {
    const auto field = [&](const Eigen::MatrixXd& of) { return as_net(of.col(column)); };
    const Net correction = mass.solve(field(projected)) - interpolation.solve(Net(field(collocated)));
    density.col(column) = flat(correction);
  }
}

namespace {

/// Returns the matrix of the cross product with r: cross(r) v = r x v.
Mat3 cross(const Vec3& r) {
  Mat3 matrix;
  matrix << 0, -r[2], r[1], r[2], 0, -r[0], -r[1], r[0], 0;
  return matrix;
}

}  // namespace

BodyDensity::BodyDensity(const spline::Space& space, const Net& x, const Net& rest, const quadrature::Options& quadrature, const BodyDensity* like)
    : correction_(like ? like->correction_ : std::make_shared<const SelfCorrection>(space, x, quadrature)) {
  const Eigen::SparseMatrix<double> mass = membrane::MassMatrix(space, 8).update(x);
  weight_ = mass * Eigen::VectorXd::Ones(x.rows());
  moment_ = mass * rest;
  first_ = moment_.colwise().sum().transpose();
  second_ = moment_.transpose() * rest;
  inertia_ << weight_.sum() * Mat3::Identity(), -cross(first_), cross(first_), second_.trace() * Mat3::Identity() - second_;
}

RigidMotion BodyDensity::with_integrals(const Vec3& force, const Vec3& torque) const {
  const Eigen::Matrix<double, 6, 1> motions = inertia_.partialPivLu().solve((Eigen::Matrix<double, 6, 1>() << force, torque).finished());
  return {motions.head<3>(), motions.tail<3>()};
}

RigidMotion BodyDensity::mean(const Net& w) const {
  const Mat3 moments = w.transpose() * moment_;  // int w r
  return with_integrals(w.transpose() * weight_, axial_vector(moments));
}

Eigen::VectorXd BodyDensity::mean_functional(int k) const {
  const Eigen::Matrix<double, 6, 1> row = inertia_.inverse().row(k).transpose();
  Net functional = weight_ * row.head<3>().transpose();
  for (Eigen::Index a = 0; a < functional.rows(); ++a) functional.row(a) += row.tail<3>().cross(Vec3(moment_.row(a).transpose())).transpose();
  return flat(functional);
}

RigidMotion BodyDensity::integrals(const RigidMotion& field) const {
  const Eigen::Matrix<double, 6, 1> of = inertia_ * (Eigen::Matrix<double, 6, 1>() << field.velocity, field.angular_velocity).finished();
  return {of.head<3>(), of.tail<3>()};
}

Mat3 BodyDensity::moment(const RigidMotion& field) const {
  return field.velocity * first_.transpose() + cross(field.angular_velocity) * second_;
}

Net BodyDensity::of_load(const RigidMotion& load) const {
  Net sum = Net::Zero(weight_.size(), 3);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    sum += load.velocity[i] * correction_->loads[k] + load.angular_velocity[i] * correction_->loads[3 + k];
  }
  return sum;
}

Net BodyDensity::of_density(const Net& w) const {
  if (correction_->density.size() == 0) return Net::Zero(w.rows(), 3);
  return as_net(Eigen::VectorXd(correction_->density * flat(w)));
}

}  // namespace tanktread::coupling
