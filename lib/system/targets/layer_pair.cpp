#include "system/targets/layer_pair.hpp"

#include <algorithm>
#include <utility>

#include "system/targets/collocation.hpp"

namespace tanktread::coupling {

using stokes::Layer;

LayerPair::LayerPair(const spline::Space& space, const stokes::Sites& points, const Net& unstressed, std::span<const Particle> particles,
                     const quadrature::Options& quadrature, double viscosity, const stokes::Medium* medium)
    : single_layer(Layer::Kernel::single_layer, space, points, quadrature), measure(coupling::measure(particles)), viscosity_(viscosity) {
  single_layer.set_reference(unstressed, loads_per_current_area(particles));
  if (std::vector<double> contrasts = viscosity_contrasts(particles); !contrasts.empty()) {
    double_layer.emplace(Layer::Kernel::double_layer, space, points, quadrature, std::move(contrasts));
    if (points.empty()) collocation_ = collocation_matrix(space);
  }
  if (!medium) return;
  single_layer.set_medium(*medium);
  if (double_layer) double_layer->set_medium(*medium);
}

void LayerPair::repeat(const stokes::PeriodicCell& cell, const stokes::Repetition& how) {
  cell_ = cell;
  single_layer.repeat(cell, how);
  if (double_layer) double_layer->repeat(cell, how);
}

void LayerPair::set_shape(const Net& x) {
  single_layer.set_shape(x, measure);
  if (!double_layer) return;
  double_layer->set_shape(x);
  if (collocation_.size() > 0) sites_ = collocation_ * x;
}

PointsOff LayerPair::prepared(Net at, std::vector<int> own, int first_image_row) {
  PointsOff points{.at = std::move(at), .own = std::move(own), .first_image_row = first_image_row};
  if (!double_layer) return points;
  points.near = double_layer->near(points.at, points.own, first_image_row);
  points.nearest.resize(static_cast<std::size_t>(std::min<Eigen::Index>(first_image_row, points.at.rows())));
  for (const int i : points.own) {
    if (i >= first_image_row) continue;
    Eigen::Index nearest = 0;
    Net apart = sites_.rowwise() - points.at.row(i);
    for (Eigen::Index k = 0; cell_ && k < apart.rows(); ++k) apart.row(k) -= cell_->shift(apart.row(k).transpose()).transpose();
    apart.rowwise().squaredNorm().minCoeff(&nearest);
    points.nearest[static_cast<std::size_t>(i)] = static_cast<int>(nearest);
  }
  return points;
}

/// Adds the single layer of f and the double layer of v to rows `own` of `sum`. `apply(layer, density, u)` computes these rows of one layer.
template <class Apply>
void LayerPair::add_layers(const Net& f, const Net& v, std::span<const int> own, const Apply& apply, Net& sum) {
  Net part(sum.rows(), 3);
  if (f.size() > 0) {
    apply(single_layer, f, part);
    for (const int i : own) sum.row(i) -= part.row(i) / viscosity_;
  }
  if (v.size() == 0 || !double_layer) return;
  apply(*double_layer, v, part);
  for (const int i : own) sum.row(i) += part.row(i);
}

void LayerPair::add(const Net& f, const Net& v, std::span<const int> own, Net& sum) {
  add_layers(f, v, own, [&](Layer& layer, const Net& density, Net& u) { layer.apply(density, own, u); }, sum);
}

void LayerPair::add(const Net& f, const Net& v, const PointsOff& points, Net& sum) {
  const auto apply = [&](Layer& layer, const Net& density, Net& u) {
    if (&layer == &single_layer) return layer.apply(density, points.at, points.own, u, nullptr, points.first_image_row);
    Net nearby = Net::Zero(points.at.rows(), 3);  // subtracted from v. u does not change (2.3), but the integrand is smaller
    nearby.topRows(static_cast<Eigen::Index>(points.nearest.size())) = Net(collocation_ * density)(points.nearest, Eigen::all);
    layer.apply(density, nearby, points.at, points.own, u, points.near ? &*points.near : nullptr, points.first_image_row);
  };
  add_layers(f, v, points.own, apply, sum);
}

stokes::Evaluations LayerPair::evaluations() const {
  const stokes::Evaluations sum = single_layer.evaluations();
  return double_layer ? sum + double_layer->evaluations() : sum;
}

}  // namespace tanktread::coupling
