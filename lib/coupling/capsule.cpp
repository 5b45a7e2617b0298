#include "coupling/capsule.hpp"

#include <cmath>

#include "coupling/collocation.hpp"
#include "surface/partition.hpp"

namespace tanktread::coupling {

namespace {

double dot(const Net& a, const Net& b) { return a.cwiseProduct(b).sum(); }

}  // namespace

Capsule::Capsule(const spline::Space& space, const Net& unstressed, const Net& initial, const stokes::AmbientFlow& flow,
                 const CapsuleParameters& parameters, Ranks& ranks, Phases& phases)
    : space_(space),
      flow_(flow),
      parameters_(parameters),
      ranks_(ranks),
      phases_(phases),
      geometry_(space),
      mass_matrix_(space),
      membrane_(space, unstressed, parameters.law, 4, parameters.bending),
      tangent_(membrane_),
      layer_(space, parameters.quadrature),
      collocation_(parameters.solvers.direct),
      mass_(parameters.solvers.direct),
      krylov_(parameters.solvers.krylov, parameters.solvers.belos),
      inner_krylov_(parameters.solvers.krylov, parameters.solvers.belos) {
  const surface::Share share = surface::share(space, surface::partition(space, ranks.size()), ranks.rank());
  own_points_ = share.points;
  own_elements_ = share.elements;
  ranks_.own(own_points_, space.n_points);
  collocation_.factor(collocation_matrix(space));
  mass_.factor(mass_matrix_.update(unstressed));
  layer_.set_reference(unstressed);
  if (parameters.viscosity_ratio != 1) double_layer_.emplace(space, parameters.quadrature);
  volume0_ = geometry_.volume(initial);
  if (parameters.interface_motion != "material")
    interface_.emplace(space, unstressed, parameters.interface_motion, parameters.interface_speed, layer_, own_points_, own_elements_,
                       collocation_, parameters.solvers.direct, ranks_);
}

Capsule::~Capsule() = default;

Net Capsule::ambient(const Net& x) const {
  Net v(x.rows(), 3);
  for (Eigen::Index i = 0; i < x.rows(); ++i) v.row(i) = flow_.velocity(x.row(i).transpose()).transpose();
  return v;  // exact: every flow without a tube is affine, and the basis sums to one
}

Net Capsule::energy_gradient(const Net& x) {
  Net d(x.rows(), 3);
  membrane_.load(x, own_elements_, d);
  ranks_.replicate(d);
  return d;
}

Net Capsule::load(const Net& x) {
  const auto clock = phases_.time("membrane");
  if (parameters_.strong_load) {
    Net t = Net::Zero(x.rows(), 3);
    membrane_.strong_load(x, own_points_, t);
    ranks_.replicate(t);
    return collocation_.solve(t);
  }
  const Net d = energy_gradient(x);
  const auto projection = phases_.time("projection");
  if (parameters_.measure == stokes::Measure::reference) return mass_.solve(d);
  return mass_.solve(mass_matrix_.update(x), d);
}

Net Capsule::flux_vector(const Net& x) {
  const auto clock = phases_.time("volume");
  Net b(x.rows(), 3);
  geometry_.volume_gradient(x, own_elements_, b);
  ranks_.replicate(b);
  return b;
}

Net Capsule::velocity(const Net& x) {
  ++work_.evaluations;
  const Net f = load(x);
  Net u(x.rows(), 3);
  {
    const auto clock = phases_.time("single layer");
    layer_.apply(x, f, measure(), own_points_, u);
  }
  {
    const auto clock = phases_.time("exchange");
    ranks_.replicate(u);
  }
  Net v = ambient(x);
  {
    const auto clock = phases_.time("projection");
    v -= collocation_.solve(u) / parameters_.viscosity;
  }
  const bool constrained = parameters_.volume.constraint != "none";
  const Net b = constrained ? flux_vector(x) : Net(), c = constrained ? mass_.solve(b) : Net();
  if (constrained) v -= dot(b, v) / dot(b, c) * c;
  if (double_layer_) v = solve_velocity(x, b, c, v);
  if (!interface_) return v;
  const auto clock = phases_.time("interface motion");
  v = interface_->velocity(x, v);
  if (constrained) v -= dot(b, v) / dot(b, c) * c;  // interpolation of the normal motion lets a little flux in
  return v;
}

/// B v = v - (1 - lambda) R^-1 (H v), from what the double layer gives at the sites.
Net Capsule::viscous(const Net& v, const Net& hv) const { return v - (1 - parameters_.viscosity_ratio) * collocation_.solve(hv); }

/// P B P v = rhs, rhs = P rhs; b and c are empty where the volume is free.
Net Capsule::solve_velocity(const Net& x, const Net& b, const Net& c, Net rhs) {
  const auto clock = phases_.time("double layer");
  const Eigen::Index n = x.rows();
  const bool assembled = parameters_.solvers.double_layer == "assembled";
  if (assembled) double_layer_->assemble(x, own_points_, double_rows_);
  const auto project = [&](Net& v) {
    if (b.size() > 0) v -= dot(b, v) / dot(b, c) * c;
  };
  const auto apply = [&](const double* in, double* out) {
    Net v = Eigen::Map<const Net>(in, n, 3), hv(n, 3);
    project(v);
    if (assembled) {
      const Eigen::VectorXd rows = double_rows_ * Eigen::Map<const Eigen::VectorXd>(v.data(), v.size());
      for (size_t k = 0; k < own_points_.size(); ++k) hv.row(own_points_[k]) = rows.segment<3>(3 * static_cast<Eigen::Index>(k)).transpose();
    } else {
      double_layer_->apply(x, v, own_points_, hv);
    }
    ranks_.replicate(hv);
    v = viscous(v, hv);
    project(v);
    Eigen::Map<Net>(out, n, 3) = v;
  };
  Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(rhs.data(), rhs.size());
  const Eigen::VectorXd right = v;
  const SolveReport report = krylov_.solve(apply, right, v, parameters_.solvers.tolerance);
  work_.velocity_iterations += report.iterations;
  if (v.allFinite()) {
    require_convergence(report, "the velocity at viscosity ratio " + std::to_string(parameters_.viscosity_ratio), parameters_.solvers.tolerance);
  }
  Net solution = Eigen::Map<const Net>(v.data(), n, 3);
  project(solution);
  return solution;
}

void Capsule::freeze(const Net& x) {
  const auto clock = phases_.time("assembly");
  ++work_.assemblies;
  frozen_.assemble(own_points_, space_.n_points, [&](std::span<const int> targets, stokes::Rows<float>& rows) {
    layer_.assemble(x, stokes::Measure::reference, targets, rows);
  });
  if (!double_layer_) return;
  frozen_double_.assemble(own_points_, space_.n_points,
                          [&](std::span<const int> targets, stokes::Rows<float>& rows) { double_layer_->assemble(x, targets, rows); });
}

void Capsule::linearise(const Net& x) {
  const auto clock = phases_.time("tangent");
  ++work_.tangents;
  tangent_.update(x, own_elements_);
  if (interface_) interface_->linearise(x);
}

/// B J delta = grad v_inf delta - R^{-1} A M0^{-1} H delta                                                    (4.3)
Net Capsule::energy_part(const Net& delta) {
  Net h(delta.rows(), 3), u(delta.rows(), 3);
  tangent_.apply(delta, h);
  ranks_.replicate(h);
  frozen_.apply(mass_.solve(h), u);
  ranks_.replicate(u);
  return delta * flow_.gradient(Vec3::Zero()).transpose() - collocation_.solve(u) / parameters_.viscosity;
}

/// B v with B frozen.
Net Capsule::frozen_viscous(const Net& v) {
  if (!double_layer_) return v;
  Net hv(v.rows(), 3);
  frozen_double_.apply(v, hv);
  ranks_.replicate(hv);
  return viscous(v, hv);
}

/// dv = B^-1 (B J delta), the inner system solved well below the tolerance of the outer one.
Net Capsule::fluid_velocity_change(const Net& delta) {
  const Net rhs = energy_part(delta);
  if (!double_layer_) return rhs;
  const Eigen::Index n = delta.rows();
  const auto apply = [&](const double* in, double* out) { Eigen::Map<Net>(out, n, 3) = frozen_viscous(Eigen::Map<const Net>(in, n, 3)); };
  Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(rhs.data(), rhs.size());
  const Eigen::VectorXd right = v;
  work_.solver_iterations += inner_krylov_.solve(apply, right, v, 1e-3).iterations;
  return Eigen::Map<const Net>(v.data(), n, 3);
}

/// Material motion: (B - shift B J) delta = B r, so that B need not be inverted. Otherwise (1 - shift (N B^-1 B J + T W)) delta = r (4.6).
Net Capsule::solve(double shift, const Net& r, double tolerance) {
  const auto clock = phases_.time("implicit solve");
  const Eigen::Index n = r.rows();
  const auto apply = [&](const double* in, double* out) {
    const Net delta = Eigen::Map<const Net>(in, n, 3);
    Eigen::Map<Net> result(out, n, 3);
    if (interface_)
      result = delta - shift * interface_->derivative(fluid_velocity_change(delta), delta);
    else
      result = frozen_viscous(delta) - shift * energy_part(delta);
  };
  Eigen::VectorXd solution = Eigen::VectorXd::Zero(3 * n);
  const Net rhs = interface_ ? r : frozen_viscous(r);
  const SolveReport report = krylov_.solve(apply, Eigen::Map<const Eigen::VectorXd>(rhs.data(), rhs.size()), solution, tolerance);
  ++work_.solves;
  work_.solver_iterations += report.iterations;
  return Eigen::Map<const Net>(solution.data(), n, 3);
}

void Capsule::restore_volume(Net& x) {
  if (parameters_.volume.constraint != "exact") return;
  for (int k = 0; k < 2; ++k) {
    const Net b = flux_vector(x), c = mass_.solve(b);
    x += (volume0_ - geometry_.volume(x)) / dot(b, c) * c;
  }
}

double Capsule::norm(const Net& displacement) const {
  return displacement.norm() / (parameters_.radius * std::sqrt(static_cast<double>(displacement.rows())));
}

Mat3 Capsule::stresslet(const Net& x, const Net& v) {
  Mat3 moment = energy_gradient(x).transpose() * x;  // int df x dG, since x = sum N_A x_A
  if (double_layer_) moment -= 2 * (1 - parameters_.viscosity_ratio) * parameters_.viscosity * v.transpose() * geometry_.volume_gradient(x);
  return 0.5 * (moment + moment.transpose()) - moment.trace() / 3 * Mat3::Identity();
}

stokes::Evaluations Capsule::kernel_evaluations() const {
  stokes::Evaluations sum = layer_.evaluations();
  if (!double_layer_) return sum;
  const stokes::Evaluations& other = double_layer_->evaluations();
  return {sum.far + other.far, sum.near + other.near, sum.self + other.self};
}

double Capsule::volume_error(const Net& x) const { return geometry_.volume(x) / volume0_ - 1; }

}  // namespace tanktread::coupling
