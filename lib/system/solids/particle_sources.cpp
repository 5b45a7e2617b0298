#include "system/solids/particle_sources.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "system/targets/collocation.hpp"

namespace tanktread::coupling {

using stokes::Layer;

ParticleSources::ParticleSources(const spline::Space& space, double viscosity, const quadrature::Options& quadrature,
                                 const stokes::PeriodicCell* cell, const stokes::Repetition& how)
    : single_layer(Layer::Kernel::single_layer, space, {}, quadrature),
      space_(space),
      viscosity_(viscosity),
      quadrature_(quadrature),
      how_(how),
      collocation_(collocation_matrix(space)),
      contrasts_(Eigen::VectorXd::Zero(space.n_points)) {
  if (cell) cell_ = *cell, single_layer.repeat(*cell_, how_);
}

void ParticleSources::set_reference(const Net& unstressed, stokes::Measure measure, std::vector<bool> per_current_area) {
  require_no_shape();
  single_layer.set_reference(unstressed, std::move(per_current_area));
  measure_ = measure;
}

void ParticleSources::set_contrasts(const Eigen::VectorXd& contrasts) {
  require_no_shape();
  contrasts_ = contrasts;
  double_layer.reset();
  if (contrasts.isZero(0)) return;
  double_layer.emplace(Layer::Kernel::double_layer, space_, stokes::Sites(), quadrature_);
  if (cell_) double_layer->repeat(*cell_, how_);
}

void ParticleSources::require_no_shape() const {
  if (sites_.rows() > 0) throw std::logic_error("sources need the reference and the contrasts of the particles before their shape");
}

void ParticleSources::set(const Net& unstressed, std::span<const Particle> particles) {
  set_reference(unstressed, measure(particles), loads_per_current_area(particles));
  set_contrasts(viscosity_contrasts_of_points(particles));
}

void ParticleSources::set_shape(const Net& x) {
  sites_ = collocation_ * x;
  single_layer.set_shape(x, measure_);
  if (double_layer) double_layer->set_shape(x);
}

SourceTargets ParticleSources::prepared(const Net& at, std::span<const int> rows, int first_image_row) {
  SourceTargets targets{.first_image_row = first_image_row};
  if (!double_layer) return targets;
  targets.corrections = double_layer->near(at, rows, first_image_row);
  targets.nearest.resize(static_cast<std::size_t>(std::min<Eigen::Index>(first_image_row, at.rows())));
  for (const int i : rows) {
    if (i >= first_image_row) continue;
    Eigen::Index nearest = 0;
    Net apart = sites_.rowwise() - at.row(i);
    for (Eigen::Index k = 0; cell_ && k < apart.rows(); ++k) apart.row(k) -= cell_->shift(apart.row(k).transpose()).transpose();
    apart.rowwise().squaredNorm().minCoeff(&nearest);
    targets.nearest[static_cast<std::size_t>(i)] = static_cast<int>(nearest);
  }
  return targets;
}

void ParticleSources::add_velocity(const Net& f, const Net& v, const Net& at, std::span<const int> rows, Net& sum, const SourceTargets& targets) {
  Net part(at.rows(), 3);
  if (f.size() > 0) {
    single_layer.apply(f, at, rows, part, nullptr, targets.first_image_row);
    for (const int i : rows) sum.row(i) -= part.row(i) / viscosity_;
  }
  if (v.size() == 0 || !double_layer) return;
  const Net q = strength(v);
  Net nearby = Net::Zero(at.rows(), 3);  // subtracted from q. u does not change (2.3), but the integrand is smaller
  nearby.topRows(static_cast<Eigen::Index>(targets.nearest.size())) = Net(collocation_ * q)(targets.nearest, Eigen::all);
  double_layer->apply(q, nearby, at, rows, part, targets.corrections ? &*targets.corrections : nullptr, targets.first_image_row);
  for (const int i : rows) sum.row(i) += part.row(i);
}

stokes::Evaluations ParticleSources::evaluations() const {
  const stokes::Evaluations sum = single_layer.evaluations();
  return double_layer ? sum + double_layer->evaluations() : sum;
}

}  // namespace tanktread::coupling
