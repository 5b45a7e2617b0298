#include "system/coupled_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tanktread::coupling {

CoupledMotion::CoupledMotion(Capsule& capsule, std::vector<FieldOnParticle> fields)
    : capsule_(capsule), fields_(std::move(fields)), layout_(layout(capsule.symmetry())), step_(layout_) {
  std::vector<Block> unknowns = capsule.jacobian().with_added(layout_->blocks());
  if (unknowns.size() > layout_->blocks().size()) step_ = std::make_shared<const Layout>(std::move(unknowns));
}

std::shared_ptr<const Layout> CoupledMotion::layout(const surface::Symmetry& symmetry, const Vec3& of_planes) const {
  const std::vector<Particle>& particles = capsule_.particles();
  std::vector<Block> blocks;
  for (const Particle& particle : particles) blocks.push_back({"shape", static_cast<int>(blocks.size()), particle.block.n_points});
  for (const auto& [p, field, name, length] : fields_) {
    const Eigen::Index n = field->size();
    const double scale = (length > 0 ? length : particles[p].radius) * std::sqrt(particles[p].block.n_points / static_cast<double>(n));
    blocks.push_back({name, static_cast<int>(p), n, 1, Parity::scalar, 1 / scale});
  }
  const auto images = [&](BlockId id, const surface::Image& g) {
    return id.at < particles.size() ? images_of_points(g) : fields_[id.at - particles.size()].field->images(g);
  };
  return std::make_shared<Layout>(std::move(blocks), symmetry, images, of_planes);
}

bool CoupledMotion::knows_images(const surface::Symmetry& symmetry) const {
  return std::ranges::none_of(fields_, [&](const FieldOnParticle& on) {
    return std::ranges::any_of(symmetry.images(), [&](const surface::Image& g) { return on.field->images(g).empty(); });
  });
}

/// Returns the rows of a net that belong to the particle of field k; an empty net stays empty.
Net CoupledMotion::rows(std::size_t k, const Net& net) const {
  return net.rows() > 0 ? Net(capsule_.particles()[fields_[k].particle].block.rows(net)) : Net();
}

State CoupledMotion::state_of(const Net& net) const {
  State y(layout_);
  shape(y) = net;
  return y;
}

State CoupledMotion::start(const Net& net) const {
  State y = state_of(net);
  for (std::size_t k = 0; k < fields_.size(); ++k) y.set(id(k), fields_[k].field->start(rows(k, net)));
  return y;
}

void CoupledMotion::set_fields(const State& y) {
  for (std::size_t k = 0; k < fields_.size(); ++k) fields_[k].field->set_state(shape_at(k, y), coefficients(y, k));
}

void CoupledMotion::set_state(const State& y) {
  if (fields_.empty()) return;
  set_fields(y);
  Net load = Net::Zero(capsule_.n_points(), 3);
  for (const FieldOnParticle& on : fields_) capsule_.particles()[on.particle].block.rows(load) -= on.field->load();
  capsule_.set_forces(&Capsule::Forces::fields, std::move(load));
}

State CoupledMotion::velocity(const State& y) {
  if (!y.allFinite()) return not_a_number(y);
  set_state(y);
  const Net x = shape(y), u = capsule_.velocity(x);
  if (!u.allFinite()) return not_a_number(y);
  State rate = state_of(u);
  const Net slip = slip_at(x);
  for (std::size_t k = 0; k < fields_.size(); ++k) rate.set(id(k), fields_[k].field->rate(rows(k, slip)));
  return rate;
}

std::string CoupledMotion::why_undefined() const {
  const std::string& crossing = capsule_.solver().crossing();
  return crossing.empty() ? Dynamics::why_undefined() : crossing;
}

/// Returns the velocity of the fluids minus the velocity of the control points, for the fields; empty if no control point slides or there are no
/// fields.
Net CoupledMotion::slip_at(const Net& x) {
  if (fields_.empty() || !capsule_.slides()) return {};
  const std::shared_ptr<Evaluation> e = capsule_.evaluate(x);
  return e->fluid_velocity() - e->velocity();
}

State CoupledMotion::defect(const State& y, const State& u) {
  if (!defect_spares_system()) return Dynamics::defect(y, u);
  if (!y.allFinite()) return not_a_number(y);
  set_state(y);
  State missing = state_of(capsule_.defect(shape(y), shape(u)));
  for (std::size_t k = 0; k < fields_.size(); ++k) missing.set(id(k), fields_[k].field->rate({}) - coefficients(u, k));
  return missing;
}

void CoupledMotion::freeze(const State& y) {
  capsule_.freeze(shape(y));
  for (std::size_t k = 0; k < fields_.size(); ++k) fields_[k].field->freeze(shape_at(k, y));
}

void CoupledMotion::linearise(const State& y) {
  set_state(y);
  const Net slip = slip_at(shape(y));
  for (std::size_t k = 0; k < fields_.size(); ++k) fields_[k].field->linearise(rows(k, slip));
  capsule_.linearise(shape(y));
}

/// Multiplies the change of shape in delta by the operator B of (4.2). Does not modify the changes of the fields. Returns a vector of the step.
BlockVector CoupledMotion::velocity_product(State delta) {
  const CapsuleJacobian::RateChange product = capsule_.jacobian().velocity_product(shape(std::as_const(delta)));
  shape(delta) = product.rate;
  return in_step(std::move(delta), product.added);
}

/// Returns the vector of an implicit step with a change of state, and with unknowns or rows of the added equations, which are zero if `added` is
/// empty.
BlockVector CoupledMotion::in_step(State delta, const Eigen::VectorXd& added) const {
  if (step_ == layout_) return delta;
  BlockVector all(step_);
  all.numbers().head(layout_->size()) = delta.numbers();
  all.numbers().tail(added.size()) = added;
  return all;
}

/// Returns the change of state in a vector of an implicit step.
State CoupledMotion::state_in(BlockVector step) const {
  if (step_ == layout_) return step;
  State delta(layout_);
  delta.numbers() = step.numbers().head(layout_->size());
  return delta;
}

/// Returns the unknowns or rows of the added equations in a vector of an implicit step.
Eigen::VectorXd CoupledMotion::added_in(const BlockVector& step) const { return step.numbers().tail(step_->size() - layout_->size()); }

/// Returns the left-hand side of an implicit step, delta - shift J delta with the Jacobian J (4.33). If no control points slide along an interface,
/// the rows of the shape are multiplied by B (4.2), so that no linear system with B needs to be solved, and each layer is applied once.
BlockVector CoupledMotion::step(const State& delta, const Eigen::VectorXd& added, double shift) {
  const FieldChange fields = field_change(delta);
  const CapsuleJacobian::RateChange change = capsule_.jacobian().step_change(shape(delta), added, shift, fields.load);
  State result = state_of(change.rate);
  for (std::size_t k = 0; k < fields_.size(); ++k)
    result.set(id(k), coefficients(delta, k) - shift * field_rate(k, delta, fields, change.slip));
  return in_step(std::move(result), change.added);
}

CoupledMotion::FieldChange CoupledMotion::field_change(const State& delta) const {
  FieldChange change;
  if (!fields_.empty()) change.load = Net::Zero(capsule_.n_points(), 3);
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    const membrane::Field& field = *fields_[k].field;
    const Net dx = shape_at(k, delta);
    change.values.push_back(field.value_change(dx, coefficients(delta, k)));
    capsule_.particles()[fields_[k].particle].block.rows(change.load) += field.load_change(dx, change.values.back());
  }
  return change;
}

/// Returns the change of the rate of field k. `slip`: change of the slip velocity of all particles; empty if no control points slide.
Eigen::VectorXd CoupledMotion::field_rate(std::size_t k, const State& delta, const FieldChange& fields, const Net& slip) const {
  return fields_[k].field->rate_change(shape_at(k, delta), fields.values[k], rows(k, slip));
}

/// Applies an approximate inverse of step(), for the shift of the latest linear system.
BlockVector CoupledMotion::preconditioned(const BlockVector& r, double shift) const {
  State delta = state_in(r);
  const CapsuleJacobian::RateChange change = capsule_.jacobian().step_preconditioner(shape(std::as_const(delta)), added_in(r));
  shape(delta) = change.rate;
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    const membrane::Field& field = *fields_[k].field;
    Eigen::VectorXd q = coefficients(delta, k);
    if (field.follows_shape()) {
      const Net dx = shape_at(k, delta);
      q += shift * field.rate_change(dx, field.value_change(dx, Eigen::VectorXd::Zero(q.size())), {});
    }
    delta.set(id(k), field.solve(shift, q));
  }
  return in_step(std::move(delta), change.added);
}

/// Solves step(delta) - shift secants(delta) = rhs for the change of state delta.
State CoupledMotion::system(double shift, const BlockVector& rhs, double tolerance, const Secants& secants) {
  const auto clock = capsule_.phases().time("implicit solve");
  const auto apply = on_blocks(step_, [&](const BlockVector& unknowns) -> BlockVector {
    const State delta = state_in(unknowns);
    return step(delta, added_in(unknowns), shift) - shift * in_step(secants(delta));
  });
  Apply precondition;
  if (!fields_.empty() || capsule_.jacobian().has_preconditioner())
    precondition = on_blocks(step_, [&](const BlockVector& r) { return preconditioned(r, shift); });
  BlockVector found(step_);
  found.numbers() = capsule_.jacobian().solve_step(shift, apply, precondition, rhs.numbers(), tolerance);
  State delta = state_in(std::move(found));
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    Eigen::VectorXd q = coefficients(delta, k);
    fields_[k].field->conserve(rhs.value(id(k)), q);
    delta.set(id(k), q);
  }
  return symmetric(std::move(delta));
}

State CoupledMotion::solve(double shift, const State& r, double tolerance, const Secants& secants) {
  return system(shift, velocity_product(r), tolerance, secants);
}

State CoupledMotion::correction(double shift, const State& defect, double tolerance, const Secants& secants) {
  return defect_spares_system() ? system(shift, shift * defect, tolerance, secants) : Dynamics::correction(shift, defect, tolerance, secants);
}

State CoupledMotion::jacobian_error(const State& change, const State& delta, double shift) {
  const auto clock = capsule_.phases().time("implicit solve");
  return state_in((defect_spares_system() ? in_step(change) : velocity_product(change)) + step(delta, {}, shift) / shift);
}

State CoupledMotion::derivative(const State& y, const State& v, const State& delta) {
  if (!capsule_.has_frozen() || !capsule_.solver().equations().empty()) return difference(y, v, delta);
  set_state(y);
  if (capsule_.slides()) capsule_.evaluate(shape(y));  // because the change of the mesh motion depends on the fluid velocity
  const auto clock = capsule_.phases().time("stiffness");
  linearise(y);
  const FieldChange fields = field_change(delta);
  const CapsuleJacobian::RateChange change = capsule_.jacobian().velocity_change(shape(delta), fields.load);
  State rate = state_of(change.rate);
  for (std::size_t k = 0; k < fields_.size(); ++k) rate.set(id(k), field_rate(k, delta, fields, change.slip));
  return symmetric(std::move(rate));
}

State CoupledMotion::mesh_motion(const State& delta) {
  const Net motion = capsule_.mesh_motion(shape(delta));
  return motion.rows() > 0 ? state_of(motion) : State();
}

void CoupledMotion::restore_constraints(State& y) {
  Net x = shape(y);
  capsule_.restore_constraints(x);
  shape(y) = x;
}

void CoupledMotion::improve_start(State& y, const State& before, double shift) {
  Net x = shape(y);
  capsule_.improve_start(x, shape(before), shift);
  shape(y) = x;
}

State CoupledMotion::slid(const State& y, const Net& along) {
  set_fields(y);
  State change = state_of(along);
  for (std::size_t k = 0; k < fields_.size(); ++k) change.set(id(k), fields_[k].field->relabelled(rows(k, along)));
  return change;
}

State CoupledMotion::conserved(std::size_t k) const {
  const Eigen::VectorXd of_q = fields_[k].field->conserved();
  if (of_q.size() == 0) return {};
  State gradient(layout_);
  gradient(id(k)) = (*layout_)[id(k)].unit * of_q;
  return gradient;
}

std::vector<State> CoupledMotion::relabellings(const State& y) {
  std::vector<State> all;
  for (const Net& slide : capsule_.relabellings(shape(y))) all.push_back(slid(y, slide));
  return all;
}

State CoupledMotion::symmetric(State rate) const {
  layout_->complete(rate);
  return rate;
}

double CoupledMotion::norm(const State& displacement) const {
  double largest = capsule_.norm(shape(displacement));
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    const Eigen::VectorXd changes = coefficients(displacement, k);
    const double changed = changes.norm() / std::sqrt(static_cast<double>(changes.size()));
    largest = changed <= largest ? largest : changed;  // written so that the maximum is NaN if a norm is NaN
  }
  return largest;
}

}  // namespace tanktread::coupling
