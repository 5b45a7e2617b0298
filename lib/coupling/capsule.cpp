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
      membrane_(space, unstressed, parameters.law),
      tangent_(membrane_),
      layer_(space, parameters.quadrature),
      collocation_(parameters.solvers.direct),
      mass_(parameters.solvers.direct),
      current_mass_(parameters.solvers.direct),
      krylov_(parameters.solvers.krylov, parameters.solvers.belos) {
  const surface::Share share = surface::share(space, surface::partition(space, ranks.size()), ranks.rank());
  own_points_ = share.points;
  own_elements_ = share.elements;
  ranks_.own(own_points_, space.n_points);
  collocation_.factor(collocation_matrix(space));
  mass_.factor(mass_matrix_.update(unstressed));
  layer_.set_reference(unstressed);
  volume0_ = geometry_.volume(initial);
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
  current_mass_.factor(mass_matrix_.update(x));
  return current_mass_.solve(d);
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
    layer_.apply(x, f, parameters_.strong_load ? stokes::Measure::current : parameters_.measure, own_points_, u);
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
  if (parameters_.volume.constraint != "none") {
    const Net b = flux_vector(x), c = mass_.solve(b);
    v -= dot(b, v) / dot(b, c) * c;
  }
  return v;
}

void Capsule::freeze(const Net& x) {
  const auto clock = phases_.time("assembly");
  ++work_.assemblies;
  frozen_.assemble(own_points_, space_.n_points, [&](std::span<const int> targets, stokes::Rows<float>& rows) {
    layer_.assemble(x, stokes::Measure::reference, targets, rows);
  });
}

void Capsule::linearise(const Net& x) {
  const auto clock = phases_.time("tangent");
  ++work_.tangents;
  tangent_.update(x, own_elements_);
}

/// J delta = grad v_inf delta - R^{-1} A M0^{-1} H delta                                                      (4.3)
Net Capsule::jacobian(const Net& delta) {
  Net h(delta.rows(), 3), u(delta.rows(), 3);
  tangent_.apply(delta, h);
  ranks_.replicate(h);
  const Net f = mass_.solve(h);
  frozen_.apply(f, u);
  ranks_.replicate(u);
  return delta * flow_.gradient(Vec3::Zero()).transpose() - collocation_.solve(u) / parameters_.viscosity;
}

Net Capsule::solve(double shift, const Net& r, double tolerance) {
  const auto clock = phases_.time("implicit solve");
  const Eigen::Index n = r.rows();
  const auto apply = [&](const double* in, double* out) {
    const Net delta = Eigen::Map<const Net>(in, n, 3);
    Eigen::Map<Net>(out, n, 3) = delta - shift * jacobian(delta);
  };
  Eigen::VectorXd solution = Eigen::VectorXd::Zero(3 * n);
  const Eigen::VectorXd rhs = Eigen::Map<const Eigen::VectorXd>(r.data(), r.size());
  const SolveReport report = krylov_.solve(apply, rhs, solution, tolerance);
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

Mat3 Capsule::stresslet(const Net& x) {
  const Mat3 moment = energy_gradient(x).transpose() * x;
  return 0.5 * (moment + moment.transpose()) - moment.trace() / 3 * Mat3::Identity();
}

double Capsule::volume_error(const Net& x) const { return geometry_.volume(x) / volume0_ - 1; }

}  // namespace tanktread::coupling
