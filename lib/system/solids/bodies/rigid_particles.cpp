#include "system/solids/bodies/rigid_particles.hpp"

#include <algorithm>
#include <stdexcept>

#include <Eigen/Geometry>

#include "base/small_matrices.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {

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
    body.double_layer.emplace(*particle.space, x, body.rest, quadrature, alike == bodies_.end() ? nullptr : &alike->dual());
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

const BodyDensity& RigidParticles::Body::dual() const {
  if (!double_layer) throw std::logic_error("a rigid body whose unknown is the traction has no double layer");
  return *double_layer;
}

RigidMotion RigidParticles::Body::turned(const RigidMotion& at_rest) const { return {turn * at_rest.velocity, turn * at_rest.angular_velocity}; }

RigidMotion RigidParticles::Body::load(const Net* work) const {
  const RigidDrive all = drive(work);
  return dual().with_integrals(turn.transpose() * all.force, turn.transpose() * all.torque);
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
    if (body.double_layer && !body.rigid.prescribed) body.block.rows(load) -= body.field(body.turned(body.load(work)));
}

void RigidParticles::add_load_correction(Net& v, const Net* work) const {
  for (const Body& body : bodies_)
    if (body.double_layer && !body.rigid.prescribed)
      body.block.rows(v) += body.dual().of_load(body.load(work)) * body.turn.transpose() / body.viscosity;
}

void RigidParticles::complete(const Net& w, Net& v) const {
  for (const Body& body : bodies_) {
    if (!body.double_layer) continue;
    const BodyDensity& dual = body.dual();
    const Net own = body.block.rows(w) * body.turn;
    const RigidMotion mean = dual.mean(own);
    body.block.rows(v) += dual.of_density(own) * body.turn.transpose() - Net(body.block.rows(w));
    body.block.rows(v) += body.rigid.prescribed ? Net(dual.of_load(mean) * body.turn.transpose() / body.radius) : body.field(body.turned(mean));
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
      const double factor = -body.viscosity / body.radius;
      const RigidMotion at_rest{body.turn.transpose() * mean.velocity, body.turn.transpose() * mean.angular_velocity};
      const RigidMotion integrals = body.turned(body.dual().integrals(at_rest));
      body.force = factor * integrals.velocity, body.torque = factor * integrals.angular_velocity;
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

/// Computes int df r dGamma in closed form for the load df = -(a + b x r). The vectors a and b follow from the force and torque on body p.
Mat3 RigidParticles::load_moment(std::size_t p) const {
  const Body& of = body(p);
  const RigidMotion load = of.dual().with_integrals(of.turn.transpose() * of.force, of.turn.transpose() * of.torque);
  return -of.turn * of.dual().moment(load) * of.turn.transpose();
}

}  // namespace tanktread::coupling
