#include "system/targets/layer_pair.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "system/targets/collocation.hpp"

namespace tanktread::coupling {

using stokes::Layer;

namespace {

Net rows_of_nodes(const stokes::NodeVectors& columns) {
  Net net(static_cast<Eigen::Index>(columns[0].size()), 3);
  for (int c = 0; c < 3; ++c) net.col(c) = Eigen::Map<const Eigen::VectorXd>(columns[c].data(), net.rows());
  return net;
}

/// Returns the integrals of each basis function times a field. `values`: the field at the nodes, times area and quadrature weight.
Net moments(const Layer& layer, const Net& values) {
  Net found;
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd column = layer.moments({values.col(c).begin(), values.col(c).end()});
    found.conservativeResize(column.size(), 3);
    found.col(c) = column;
  }
  return found;
}

}  // namespace

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

Net LayerPair::weights_of_load(const std::function<Net(const Net& x)>& field) const {
  const auto& weights = single_layer.weights();
  return moments(single_layer, Eigen::Map<const Eigen::VectorXd>(weights.data(), single_layer.n_nodes()).asDiagonal() *
                                   field(rows_of_nodes(single_layer.nodes())));
}

Net LayerPair::weights_of_velocity(const std::function<Net(const Net& x, const Net& n)>& field) const {
  return moments(*double_layer, field(rows_of_nodes(double_layer->nodes()), rows_of_nodes(double_layer->normals())));
}

Net LayerPair::at_nodes(const Net& field) {
  std::vector<double> values[3];
  single_layer.values(field, values);
  return rows_of_nodes(values);
}

stokes::Evaluations LayerPair::evaluations() const {
  const stokes::Evaluations sum = single_layer.evaluations();
  return double_layer ? sum + double_layer->evaluations() : sum;
}

}  // namespace tanktread::coupling
