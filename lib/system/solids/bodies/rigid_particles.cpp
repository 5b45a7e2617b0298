#include "system/solids/bodies/rigid_particles.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include "base/indices.hpp"
#include "base/small_matrices.hpp"
#include "membrane/direct_solver.hpp"
#include "membrane/mass.hpp"
#include "stokes/layer.hpp"
#include "surface/geometry.hpp"
#include "system/parallel/stop_together.hpp"
#include "system/rigid_motion.hpp"
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

RigidParticles::RigidParticles(std::span<const Particle> particles, const Net& rest, double viscosity,
                               const quadrature::Options& quadrature) {
  for (const Particle& particle : particles) {
    of_particle_.push_back(particle.rigid ? static_cast<int>(bodies_.size()) : -1);
    if (!particle.rigid) continue;
    Body& body = bodies_.emplace_back();
    body.block = particle.block;
    body.rigid = *particle.rigid;
    body.radius = particle.radius, body.viscosity = viscosity;
    const Net x = particle.block.rows(rest);
    body.rest_centre = body.centre = surface::measures(*particle.space, x).centroid;
    body.rest = x.rowwise() - body.centre.transpose();
    if (particle.by_traction) continue;
    const auto alike = std::ranges::find_if(bodies_, [&](const Body& other) {
      return other.double_layer && other.rest.rows() == body.rest.rows() && (other.rest - body.rest).norm() <= 1e-12 * body.rest.norm();
    });
    DoubleLayer dual;
    dual.self_correction = alike == bodies_.end() ? std::make_shared<const SelfCorrection>(*particle.space, x, quadrature)
                                                  : alike->dual().self_correction;
    const Eigen::SparseMatrix<double> mass = membrane::MassMatrix(*particle.space, 8).update(x);
    dual.weight = mass * Eigen::VectorXd::Ones(x.rows());
    dual.moment = mass * body.rest;
    dual.first = dual.moment.colwise().sum().transpose();
    dual.second = dual.moment.transpose() * body.rest;
    const Mat3 turning = dual.second.trace() * Mat3::Identity() - dual.second;
    dual.inertia << dual.weight.sum() * Mat3::Identity(), -cross(dual.first), cross(dual.first), turning;
    body.double_layer = std::move(dual);
  }
}

bool RigidParticles::prescribed() const {
  return std::ranges::any_of(bodies_, [](const Body& body) { return body.rigid.prescribed; });
}

void RigidParticles::fit_to(Net& x) {
  if (!x.allFinite()) return;
  for (Body& body : bodies_) {
    auto rows = body.block.rows(x);
    const Eigen::RowVector3d mean = rows.colwise().mean(), rest_mean = body.rest.colwise().mean();
    body.turn = rotation_between(body.rest, rows);
    body.centre = (mean - rest_mean * body.turn.transpose()).transpose();
    rows = (body.rest * body.turn.transpose()).rowwise() + body.centre.transpose();
  }
}

const RigidParticles::DoubleLayer& RigidParticles::Body::dual() const {
  if (!double_layer) throw std::logic_error("a rigid body whose unknown is the traction has no double layer");
  return *double_layer;
}

RigidMotion RigidParticles::Body::with_integrals(const Vec3& f, const Vec3& t) const {
  Motions right;
  right << turn.transpose() * f, turn.transpose() * t;
  const Motions motions = dual().inertia.partialPivLu().solve(right);
  return {turn * motions.head<3>(), turn * motions.tail<3>()};
}

RigidMotion RigidParticles::Body::mean(const Net& w) const {
  const auto rows = block.rows(w);
  const Mat3 moments = turn * (dual().moment.transpose() * rows);  // int r w
  return with_integrals(rows.transpose() * dual().weight, axial_vector(moments.transpose()));
}

Net RigidParticles::Body::field(const RigidMotion& of) const { return rigid_velocity(rest * turn.transpose(), of, Vec3::Zero()); }

void RigidParticles::push(const Net& work) {
  for (Body& body : bodies_) body.pushed = work.size() > 0 ? Net(body.block.rows(work)) : Net();
}

RigidDrive RigidParticles::Body::given() const {
  RigidDrive all = rigid;
  all.motion.velocity -= cell_velocity;
  add_forces(pushed, all);
  return all;
}

RigidDrive RigidParticles::Body::drive(const Net* work) const {
  if (!work) return given();
  RigidDrive only{.prescribed = rigid.prescribed};
  add_forces(-block.rows(*work), only);
  return only;
}

void RigidParticles::Body::add_forces(const Net& forces, RigidDrive& to) const {
  for (Eigen::Index a = 0; a < forces.rows(); ++a) {
    const Vec3 here = forces.row(a).transpose();
    to.force += here;
    to.torque += Vec3(turn * rest.row(a).transpose()).cross(here);
  }
}

void RigidParticles::add_velocity(const Net& w, bool with_given, Net& v) const {
  for (const Body& body : bodies_) {
    if (!body.double_layer) continue;
    if (!body.rigid.prescribed) body.block.rows(v) += body.field(body.mean(w));
    else if (with_given) body.block.rows(v) += body.field(body.given().motion);
  }
}

void RigidParticles::add_load(Net& load, const Net* work) const {
  for (const Body& body : bodies_)
    if (const RigidDrive given = body.drive(work); body.double_layer && !given.prescribed)
      body.block.rows(load) -= body.field(body.with_integrals(given.force, given.torque));
}

Net RigidParticles::Body::single_layer_correction(const RigidMotion& load) const {
  const Vec3 a = turn.transpose() * load.velocity, b = turn.transpose() * load.angular_velocity;
  const std::array<Net, 6>& loads = dual().self_correction->loads;
  Net sum = Net::Zero(rest.rows(), 3);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    sum += a[i] * loads[k] + b[i] * loads[3 + k];
  }
  return sum * turn.transpose();
}

Net RigidParticles::Body::double_layer_correction(const Net& w) const {
  const Eigen::MatrixXd& correction = dual().self_correction->density;
  if (correction.size() == 0) return Net::Zero(rest.rows(), 3);
  const Net own = block.rows(w) * turn;
  const Eigen::VectorXd sum = correction * flat(own);
  return as_net(sum) * turn.transpose();
}

void RigidParticles::add_load_correction(Net& v, const Net* work) const {
  for (const Body& body : bodies_)
    if (const RigidDrive given = body.drive(work); body.double_layer && !given.prescribed)
      body.block.rows(v) += body.single_layer_correction(body.with_integrals(given.force, given.torque)) / body.viscosity;
}

void RigidParticles::complete(const Net& w, Net& v) const {
  for (const Body& body : bodies_) {
    if (!body.double_layer) continue;
    body.block.rows(v) += body.double_layer_correction(w) - Net(body.block.rows(w));
    const RigidMotion mean = body.mean(w);
    body.block.rows(v) += body.rigid.prescribed ? Net(body.single_layer_correction(mean) / body.radius) : body.field(mean);
  }
}

Net RigidParticles::completing_load(const Net& w) const {
  Net load = Net::Zero(w.rows(), 3);
  for (const Body& body : bodies_)
    if (body.double_layer && body.rigid.prescribed) body.block.rows(load) = body.viscosity / body.radius * body.field(body.mean(w));
  return load;
}

void RigidParticles::move_into_cell(std::span<const CellShift> shifts) {
  for (std::size_t p = 0; p < shifts.size(); ++p)
    if (is_rigid(p)) bodies_[static_cast<std::size_t>(of_particle_[p])].cell_velocity = shifts[p].velocity;
}

void RigidParticles::move_out_of_cell(std::span<const CellShift> shifts) {
  for (std::size_t p = 0; p < shifts.size(); ++p) {
    if (!is_rigid(p)) continue;
    Body& body = bodies_[static_cast<std::size_t>(of_particle_[p])];
    body.centre += shifts[p].position;
    body.motion.velocity += shifts[p].velocity;
    body.cell_velocity = Vec3::Zero();
  }
}

void RigidParticles::store_density(Net& v) {
  for (Body& body : bodies_) {
    if (!body.double_layer) continue;
    const RigidMotion mean = body.mean(v);
    body.density = body.block.rows(v);
    const RigidDrive given = body.given();
    body.force = given.force, body.torque = given.torque;
    if (body.rigid.prescribed) {
      Motions of_body, integrals;
      of_body << body.turn.transpose() * mean.velocity, body.turn.transpose() * mean.angular_velocity;
      integrals = -body.viscosity / body.radius * body.dual().inertia * of_body;
      body.force = body.turn * integrals.head<3>(), body.torque = body.turn * integrals.tail<3>();
    }
    body.motion = body.rigid.prescribed ? given.motion : mean;
    body.block.rows(v) = body.field(body.motion);
  }
}

void RigidParticles::set_motion(std::size_t p, const RigidMotion& motion, const Vec3& force, const Vec3& torque, Net& v) {
  Body& body = bodies_[static_cast<std::size_t>(of_particle_[p])];
  body.motion = motion, body.force = force, body.torque = torque;
  body.block.rows(v) = body.field(motion);
}

Eigen::VectorXd RigidParticles::mean_functional(std::size_t p, int k) const {
  const DoubleLayer& of = body(p).dual();
  const Motions row = of.inertia.inverse().row(k).transpose();
  Net functional = of.weight * row.head<3>().transpose();
  for (Eigen::Index a = 0; a < functional.rows(); ++a) functional.row(a) += row.tail<3>().cross(Vec3(of.moment.row(a).transpose())).transpose();
  return flat(functional);
}

/// Computes int df r dGamma in closed form for the load df = -(a + b x r). The vectors a and b follow from the force and torque on body p.
Mat3 RigidParticles::load_moment(std::size_t p) const {
  const Body& of = body(p);
  const RigidMotion load = of.with_integrals(of.force, of.torque);
  const Mat3 second = of.turn * of.dual().second * of.turn.transpose();
  return -(load.velocity * (of.turn * of.dual().first).transpose() + cross(load.angular_velocity) * second);
}

}  // namespace tanktread::coupling
