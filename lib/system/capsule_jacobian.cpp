// The Jacobian of Capsule: frozen operators, the membrane's tangent, and the systems of an implicit step.

#include <algorithm>
#include <cmath>
#include <utility>

#include "system/capsule.hpp"
#include "system/collocation.hpp"

namespace tanktread::coupling {

namespace {

/// Returns whether the particle's membrane resists area changes much more than shear: its area modulus exceeds `times` its shear modulus.
bool keeps_area(const Particle& one) {
  constexpr double times = 50;
  return !one.rigid && membrane::area_modulus(one.material.law) > times * membrane::modulus(one.material.law);
}

}  // namespace

void Capsule::freeze(const Net& at) {
  Net x = at;
  if (lattice_.cell) put_into_cell(x);
  const auto clock = phases_.time("assembly");
  ++work_.assemblies;
  frozen_at_ = at;
  corotation_ = {};
  stokes::Layer& layer = site_layer_ ? *site_layer_ : layer_;
  const auto assemble = [&](std::span<const int> targets, auto&&... of) { layer.assemble(targets, of...); };
  layer.place(x, stokes::Measure::reference);
  if (parameters_.solvers.frozen_operator == "nodal") {
    const Eigen::SparseMatrix<double> sites = collocation_matrix(space_);
    const NodalOperator::Surface surface{sites * x, sites, mass_matrix_.row_sums(unstressed_), mass_matrix_.row_sums(x), parameters_.symmetry};
    nodal_.assemble(own_points_, surface, 3, parameters_.quadrature.far_sum, assemble);
  } else {
    frozen_.assemble(own_points_, space_.n_points, assemble);
  }
  if (tube_) {
    place(x);
    tube_->freeze();
  }
  if (!double_layer_) return;
  stokes::Layer& double_layer = site_double_layer_ ? *site_double_layer_ : *double_layer_;
  double_layer.place(x);
  frozen_double_.assemble(own_points_, space_.n_points,
                          [&](std::span<const int> targets, stokes::Rows<float>& rows) { double_layer.assemble(targets, rows); });
}

double Capsule::frozen_bytes() const {
  const double pairs = std::pow(static_cast<double>(space_.n_points), 2);
  const int operators = (parameters_.solvers.frozen_operator == "assembled") + double_layer_.has_value();
  return FrozenOperator::bytes_a_pair * operators * pairs;
}

void Capsule::linearise(const Net& x) {
  const auto clock = phases_.time("tangent");
  ++work_.tangents;
  tangent_.update(x, own_elements_);
  if (frozen_at_.rows() == x.rows()) corotation_ = Corotation(particles(), frozen_at_, x);
  loads_.linearise(x, evaluation(x, {}, 0)->load_sums());
  if (viscous_) linearised_viscous_->update(x, own_elements_);
  if (area_) area_->place(x);
  if (interface_) {
    interface_->linearise(x, flux_vector(x));
  } else if (parameters_.volume.constraint != "none" && (flows_by_system() || std::ranges::any_of(particles(), keeps_area))) {
    flux_ = flux_vector(x);
    flux_response_ = symmetric(solved(mass_.reference(), flux_));
  }
  if (by_sites()) gradients_ = gradients_at(sites_ * x);
}

/// Returns the velocity gradients of the flow at x. If the scene is symmetric, only the gradients at fundamental points are set.
std::vector<Mat3> Capsule::gradients_at(const Net& x) const {
  const std::vector<int>& rows = parameters_.symmetry.fundamental();
  if (static_cast<Eigen::Index>(rows.size()) == x.rows()) return flow_.gradients(x);
  const std::vector<Mat3> found = flow_.gradients(x(rows, Eigen::all));
  std::vector<Mat3> all(static_cast<std::size_t>(x.rows()), Mat3::Zero());
  for (std::size_t k = 0; k < rows.size(); ++k) all[static_cast<std::size_t>(rows[k])] = found[k];
  return all;
}

/// Returns A f with the frozen single layer A (4.3).
Net Capsule::frozen_single_layer(const Net& f) {
  Net u = Net::Zero(f.rows(), 3);
  if (parameters_.solvers.frozen_operator != "nodal") {
    frozen_.apply(corotation_.back(f), u);
    replicate(u);
  } else {
    nodal_.apply(corotation_.back(f), u);
    gather(nodal_.shared(), u);
  }
  return corotation_.forth(u);
}

/// Applies the volume projection P (2.8) of the last linearisation to a rate of change. Without P, the response of a stiff membrane to volume
/// changes, which the fluids do not allow, would dominate the rate.
Net Capsule::without_flux(Net rate) const {
  if (flux_.size() > 0) constrain(rate, flux_, flux_response_);
  return rate;
}

/// Returns the displacement along which a volume is restored. By default it is the direction c of (2.8). If the membrane nearly conserves area, it is
/// the solution of an implicit step with the right-hand side c: c itself would change the area, and the resulting stress, proportional to the large
/// dilatation modulus, would affect the next step.
Net Capsule::inflation(const Net& c) {
  constexpr double rough = 1e-2;  // relative residual
  if (latest_shift_ == 0 || interface_ || c.rows() != flux_.rows() || std::ranges::none_of(particles(), keeps_area)) return c;
  const Net along = stiff_system(latest_shift_, c, rough, {});
  return along.allFinite() ? along : c;
}

/// Returns B J delta = P (grad v_inf delta - (1/mu) R^{-1} A M0^{-1} H delta) (4.3), and 0 in the rows of rigid bodies. P is the volume projection
/// (2.8), R the collocation matrix, A the frozen single layer, M0 the mass matrix, and H the membrane tangent. `work`, if given, is added to H delta.
Net Capsule::energy_part(const Net& delta, const Net& work) {
  Net h(delta.rows(), 3);
  tangent_.apply(delta, h);
  loads_.add_tangent(delta, h);
  rigid_.clear(h);
  replicate_sums(h);
  loads_.add_global_tangent(delta, h);
  if (work.size() > 0) h += work;
  const Net f = solved(mass_.reference(), std::move(h));
  Net u = frozen_single_layer(f);
  if (by_sites()) {
    u /= -parameters_.viscosity;
    if (tube_) u += tube_->frozen_response(f);
    const Net at_sites = sites_ * delta;
    for (Eigen::Index i = 0; i < u.rows(); ++i) u.row(i) += at_sites.row(i) * gradients_[static_cast<size_t>(i)].transpose();
    rigid_.clear(u);
    return without_flux(solved(collocation_, std::move(u)));
  }
  Net change = delta * flow_.gradient(Vec3::Zero()).transpose() - solved(collocation_, std::move(u)) / parameters_.viscosity;
  rigid_.clear(change);
  return without_flux(std::move(change));
}

/// Returns P B P v + (1 - P) v with the operator B of (4.2) frozen and the volume projection P (2.8). The rows of rigid bodies are unchanged and do
/// not contribute to other rows.
Net Capsule::frozen_viscous(const Net& v) {
  if (!double_layer_ && !viscous_) return v;
  const Net inside = without_flux(v);
  Net hv = Net::Zero(v.rows(), 3), deforming = inside, load;
  rigid_.clear(deforming);
  if (double_layer_) {
    frozen_double_.apply(corotation_.back(deforming), hv);
    replicate(hv);
    hv = corotation_.forth(hv);
  }
  if (viscous_) {
    load = solved(mass_.reference(), viscous_work(*linearised_viscous_, deforming));
    hv -= frozen_single_layer(load) / parameters_.viscosity;
  }
  rigid_.clear(hv);
  if (tube_) hv += tube_->frozen_response(load, inside);
  return v - without_flux(collocation_.solve(hv));
}

/// Returns J delta, the change of the fluid velocity due to the displacement delta (J: Jacobian). Solves B (J delta) = energy_part(delta), with B of
/// (4.2), to a smaller tolerance than the system of an implicit step, because each product with the matrix of that system may require this solve.
Net Capsule::fluid_velocity_change(const Net& delta, const Net& work) {
  const Net rhs = energy_part(delta, work);
  if (!double_layer_ && !viscous_) return rhs;
  const Eigen::Index n = delta.rows();
  const auto apply = [&](const double* in, double* out) { Eigen::Map<Net>(out, n, 3) = frozen_viscous(Eigen::Map<const Net>(in, n, 3)); };
  Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(rhs.data(), rhs.size());
  const Eigen::VectorXd right = v;
  work_.solver_iterations += inner_solver_.solve({velocity_blocks(), apply, {}}, right, v, 1e-3).iterations;
  return Eigen::Map<const Net>(v.data(), n, 3);
}

/// Solves the system of an implicit step for the displacement delta. B is the operator of (4.2), J the Jacobian and E its secant correction (4.13).
/// If all control points move with the fluid, the system is (B - shift (B J + E)) delta = B r (4.3), which does not require the inverse of B. If
/// control points slide along an interface, it is (1 - shift (N B^-1 B J + T W + E)) delta = r. Here N dv + T W delta is the change of the mesh
/// velocity (4.6) due to a change dv of the fluid velocity and the displacement delta.
Net Capsule::solve(double shift, const Net& r, double tolerance, const Secants& secants) {
  const auto clock = phases_.time("implicit solve");
  return stiff_system(shift, left(r), tolerance, secants);
}

/// Returns whether all points move with the fluid and the velocity is the solution of a linear system. The Jacobian then includes the volume
/// projection P (2.8). The projection is needed because a step of TR-BDF2 adds a correction, e2 of (4.30), that is computed with the Jacobian.
bool Capsule::flows_by_system() const { return (viscous_ || double_layer_) && !interface_ && rigid_.empty(); }

/// Returns whether the defect of a velocity is computed by (3.14), without solving for the velocity.
bool Capsule::defect_without_system() const { return flows_by_system() && schur(); }

Net Capsule::defect(const Net& x, const Net& u) {
  if (!defect_without_system()) return velocity(x) - u;
  ++work_.evaluations;
  if (!lattice_.cell || !x.allFinite()) return defect_here(x, u);
  Net in_cell = x, slower = u;
  const std::vector<Vec3> shifts = put_into_cell(in_cell);
  for (std::size_t p = 0; p < shifts.size(); ++p)
    particles()[p].block.rows(slower).rowwise() -= faster_beyond(shifts[p]).transpose();
  return defect_here(in_cell, slower);
}

/// Returns the defect P (w - B P u) - (1 - P) u of the velocity u (3.14). P is the volume projection (2.8), and B v = w is the linear system for the
/// velocity v at x (see solve_velocity). The viscous load due to u is added to the elastic load, so that only one sum over the surface is needed.
Net Capsule::defect_here(const Net& x, const Net& u) {
  if (!x.allFinite() || (tube_ && !enter_tube(x)) || !in_front_of_wall(x))
    return Net::Constant(x.rows(), 3, std::numeric_limits<double>::quiet_NaN());
  const bool constrained = parameters_.volume.constraint != "none";
  const Net b = constrained ? flux_vector(x) : Net();
  Net c = b, inside = u;
  Evaluation e(*this, x);
  Net f = membrane_load(e, x, constrained ? &c : nullptr);
  if (constrained) constrain(inside, b, c);
  if (viscous_) {
    viscous_->update(x, own_elements_);
    f += viscous_load(x, inside);
  }
  Net lacking = explicit_velocity(x, f, double_layer_ ? inside : Net(), nullptr) - inside;
  if (double_layer_) {
    const auto clock = phases_.time("velocity system");
    double_layer_->place(x);
    lacking += control_values(double_layer_of(inside));
  }
  if (constrained) constrain(lacking, b, c);
  return symmetric(lacking - (u - inside));
}

Net Capsule::correction(double shift, const Net& defect, double tolerance, const Secants& secants) {
  if (!defect_without_system()) return Dynamics::correction(shift, defect, tolerance, secants);
  const auto clock = phases_.time("implicit solve");
  return stiff_system(shift, shift * defect, tolerance, secants);
}

Net Capsule::missed(const Net& change, const Net& delta, double shift) {
  const auto clock = phases_.time("implicit solve");
  if (!defect_without_system()) return left(change + delta / shift) - rate_change(delta, {}).rate;
  return change + frozen_viscous(delta) / shift - energy_part(delta);
}

Capsule::RateChange Capsule::velocity_change(const Net& dx, const Net& work) {
  const Net dv = fluid_velocity_change(dx, work);
  if (!interface_) return {dv, {}};
  const Net du = interface_->derivative(dv, dx);
  return {du, dv - du};
}

Capsule::RateChange Capsule::rate_change(const Net& dx, const Net& work) {
  return interface_ ? velocity_change(dx, work) : RateChange{energy_part(dx, work), {}};
}

void Capsule::prepare_step(double shift) {
  latest_shift_ = shift;
  if (area_) area_->factor(shift);
}

/// Solves the linear system of the implicit step (see `solve`) with the right-hand side `rhs`. If no control points slide, both sides are multiplied
/// by B (4.2), so that `rhs` is B r, where r is the argument of `solve`. Otherwise `rhs` is r.
Net Capsule::stiff_system(double shift, const Net& rhs, double tolerance, const Secants& secants) {
  const Eigen::Index n = rhs.rows();
  const auto apply = [&](const double* in, double* out) {
    const Net delta = Eigen::Map<const Net>(in, n, 3);
    Eigen::Map<Net>(out, n, 3) = left(delta) - shift * (rate_change(delta, {}).rate + secants(delta));
  };
  prepare_step(shift);
  const auto keep_area = [&](const double* in, double* out) { Eigen::Map<Net>(out, n, 3) = step_preconditioner(Eigen::Map<const Net>(in, n, 3)); };
  return symmetric(solve_step(apply, area_ ? Apply(keep_area) : Apply(), rhs, tolerance));
}

Net Capsule::solve_step(const Apply& product, const Apply& precondition, const Net& rhs, double tolerance) {
  Eigen::VectorXd solution = Eigen::VectorXd::Zero(rhs.size());
  const LinearSystem system{{{"displacement", rhs.size()}}, product, precondition};
  const SolveReport report = step_solver_.solve(system, Eigen::Map<const Eigen::VectorXd>(rhs.data(), rhs.size()), solution, tolerance);
  ++work_.solves;
  work_.solver_iterations += report.iterations;
  return Eigen::Map<const Net>(solution.data(), rhs.rows(), 3);
}

void Capsule::improve_start(Net& y, const Net& before, double shift) {
  if (!area_) return;
  const auto clock = phases_.time("tangent");
  area_->bring(y, before, shift);
  y = symmetric(std::move(y));
}

Net Capsule::mesh_motion(const Net& delta) {
  if (!interface_ || !interface_->relaxes()) return {};
  const auto clock = phases_.time("tangent");
  return interface_->derivative(Net::Zero(delta.rows(), 3), delta);
}

Net Capsule::derivative(const Net& x, const Net& v, const Net& delta) {
  if (!has_frozen()) return difference(x, v, delta);
  const auto clock = phases_.time("stiffness");
  linearise(x);
  return symmetric(velocity_change(delta, {}).rate);
}

double Capsule::distance(const Net& from, const Net& to) const { return norm(Corotation::deformation(particles(), from, to)); }

double Capsule::norm(const Net& displacement) const {
  const double along = tube_ && !tube_->fixed() ? displacement.col(0).mean() : 0;
  double largest = 0;
  for (const Particle& particle : particles()) {
    const Net moved = particle.block.rows(displacement).rowwise() - Eigen::RowVector3d(along, 0, 0);
    const double norm = moved.norm() / (particle.radius * std::sqrt(static_cast<double>(particle.block.n_points)));
    largest = norm <= largest ? largest : norm;  // keeps NaN
  }
  return largest;
}

}  // namespace tanktread::coupling
