#include "stokes/layer_sources.hpp"

#include <cassert>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "stokes/kernels/pair_kernel.hpp"

namespace tanktread::stokes {
namespace {

/// Returns the options with the tolerance of quadrature rules for the kernel.
quadrature::Options for_kernel(quadrature::Options options, LayerKernel kernel) {
  options.tolerance *= properties(kernel).tolerance_factor;
  return options;
}

}  // namespace

LayerSources::LayerSources(LayerKernel kernel, const spline::Space& space, const Sites& sites, const quadrature::Options& options,
                           std::vector<double> factor)
    : surface(space, sites, for_kernel(options, kernel), properties(kernel).is_steep),
      kernel_(kernel),
      factor_(std::move(factor)) {}

void LayerSources::set_reference(const Net& unstressed, std::vector<bool> per_current_area) {
  surface.panels.bezier(unstressed, reference_.bezier);
  node_weights(surface.panels, reference_.bezier, reference_.weight);
  reference_.per_current_area = std::move(per_current_area);
  surface.self_field.forget_weights();
  renew_shape();
}

bool LayerSources::set_shape(const Net& x, Measure measure) {
  assert((measure == Measure::current || !reference_.weight.empty()) && "set_reference() comes first");
  if (!surface.set_shape(x) && measure == measure_) return false;
  measure_ = measure;
  const bool weighted = properties(kernel_).uses_weights;
  if (!weighted || desingularised()) node_normals(surface.panels, surface.bezier, normal);
  if (weighted) set_weights();
  multiply_by_factors(weighted ? std::span(&weight, 1) : std::span(normal));
  return true;
}

/// Sets `weight` without the factors of the surfaces.
void LayerSources::set_weights() {
  weight = reference_.weight, weight.resize(static_cast<std::size_t>(n_nodes()));
  each_block(surface.panels.size(), panel_block, [&](int first, int last) {
    for (int e = first; e < last; ++e)
      if (!on_reference(e)) node_weights(surface.panels, e, surface.bezier, weight);
  });
}

/// Multiplies arrays of values at the far nodes by the factors of the surfaces.
void LayerSources::multiply_by_factors(std::span<std::vector<double>> values) const {
  for (std::vector<double>& component : values)
    for (int e = 0; !factor_.empty() && e < surface.panels.size(); ++e)
      for (int k = 0; k < surface.panels[e].table->n_nodes; ++k) component[surface.panels[e].first_node + k] *= factor_[e];
}

void LayerSources::values(const Net& field, NodeVectors& value) {
  surface.panels.bezier(field, bezier_field_);
  node_values(surface.panels, bezier_field_, value);
}

void LayerSources::set_density(const Net& f) {
  const auto clock = phases.time("setup");
  surface.panels.bezier(f, bezier_f);
  node_values(surface.panels, bezier_f, density);
  if (!properties(kernel_).uses_weights) return;
  for (auto& component : density)
    for (int k = 0; k < n_nodes(); ++k) component[k] *= weight[k];
}

Eigen::VectorXd LayerSources::moments(const std::vector<double>& g) const {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(surface.n_points);
  Eigen::VectorXd of_bezier;
  for (int e = 0; e < surface.panels.size(); ++e) {
    const Panel& panel = surface.panels[e];
    const NodeTable& t = *panel.table;
    of_bezier =
        Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(t.value.data(), t.n_bernstein, t.n_nodes) *
        Eigen::Map<const Eigen::VectorXd>(&g[panel.first_node], t.n_nodes);
    const double* extraction = surface.panels.extraction(e);
    for (int a = 0; a < panel.functions; ++a, extraction += t.n_bernstein)
      sums[surface.panels.points(e)[a]] += Eigen::Map<const Eigen::VectorXd>(extraction, t.n_bernstein).dot(of_bezier);
  }
  return sums;
}

Vec3 LayerSources::mean_density() const {
  Vec3 mean;
  for (int c = 0; c < 3; ++c)
    mean[c] = std::accumulate(density[c].begin(), density[c].end(), 0.) / n_nodes();  // independent of memory alignment
  return mean;
}

/// Computes the stresslet moments of a density f(node, component).
template <class Values>
const LayerSources::StressletMoments& LayerSources::set_moments(const Values& f) {
  for (int c = 0; c < 6; ++c) {
    const auto [i, j] = stresses[c];
    std::vector<double>& moment = moments_[static_cast<std::size_t>(c)];
    moment.resize(n_nodes());
    for (int k = 0; k < n_nodes(); ++k) moment[k] = (f(k, i) * normal[j][k] + f(k, j) * normal[i][k]) / 2;
  }
  return moments_;
}

const LayerSources::StressletMoments& LayerSources::stresslet_moments(const Vec3& mean) {
  return set_moments([&](int k, int i) { return density[i][k] - mean[i]; });
}

const LayerSources::StressletMoments& LayerSources::stresslet_moments_of_constant(int component) {
  return set_moments([&](int, int i) { return i == component ? 1. : 0.; });
}

Net LayerSources::direct_sum(const NodeVectors& x, std::span<const Vec3> at, std::span<const Vec3> f0) {
  Net sums(at.size(), 3);
  switch (kernel_) {
    case LayerKernel::single_layer: far_sums(charges(x, density), at, sums.data()); break;
    case LayerKernel::double_layer: far_sums(stresslets(x, density, normal), at, f0, sums.data()); break;
  }
  counts.mine().far += static_cast<long long>(at.size()) * n_nodes();
  return sums;
}

Vec3 LayerSources::direct_sum(int e, const Vec3& at, const Vec3& f0) const {
  const int first = surface.panels[e].first_node, n = surface.panels[e].table->n_nodes;
  Vec3 sum;
  switch (kernel_) {
    case LayerKernel::single_layer: node_sum(charges(surface.node, density).part(first, n), at.data(), sum.data()); break;
    case LayerKernel::double_layer: node_sum(stresslets(surface.node, density, normal).part(first, n), at.data(), f0.data(), sum.data()); break;
  }
  return sum;
}

Vec3 LayerSources::beyond_far_sum(int e, const PointTable& table, SelfPair* pair, const Vec3& at, const Vec3& f0, long long& count) {
  const Panel& panel = surface.panels[e];
  const double *x = &surface.bezier[panel.first_bezier], *f = &bezier_f[panel.first_bezier];
  Vec3 better;
  switch (kernel_) {
    case LayerKernel::single_layer: single_sum(table, x, f, area_weights_of(e, table, pair), at.data(), better.data()); break;
    case LayerKernel::double_layer: double_sum(table, x, f, at.data(), f0.data(), better.data()); break;
  }
  count += table.points + panel.table->n_nodes;
  return factor(e) * better - direct_sum(e, at, f0);
}

const Pack* LayerSources::area_weights_of(int e, const PointTable& table, SelfPair* pair) {
  const bool unstressed = on_reference(e), kept = pair && unstressed;
  std::vector<Pack>& weights = kept ? pair->weights : scratch_.mine().weights;
  if (kept && !weights.empty()) return weights.data();
  weights.resize(table.packs());
  area_weights(table, &(unstressed ? reference_.bezier : surface.bezier)[surface.panels[e].first_bezier], weights.data());
  return weights.data();
}

void LayerSources::panel_moments(int e, const PointTable& table, SelfPair* pair, const Vec3& at, double* moments) {
  const double* bezier = &surface.bezier[surface.panels[e].first_bezier];
  std::vector<Pack>& scratch = scratch_.mine().kernel;
  scratch.resize(static_cast<std::size_t>(kernel_entries) * table.packs());
  switch (kernel_) {
    case LayerKernel::single_layer: single_moments(table, bezier, area_weights_of(e, table, pair), at.data(), scratch.data(), moments); break;
    case LayerKernel::double_layer: double_moments(table, bezier, at.data(), scratch.data(), moments); break;
  }
  if (factor_.empty()) return;
  for (int k = 0; k < kernel_entries * surface.panels[e].table->n_bernstein; ++k) moments[k] *= factor_[e];
}

/// Returns the kernel of a far node at the vector r from the target, times the weight of the node.
Mat3 LayerSources::kernel_at(int node, const Vec3& r) const {
  switch (kernel_) {
    case LayerKernel::single_layer: return weight[node] * stokeslet(r);
    case LayerKernel::double_layer: return stresslet(r, Vec3(normal[0][node], normal[1][node], normal[2][node]));
  }
  throw std::logic_error("unknown LayerKernel");
}

void LayerSources::moments_beyond_far_sum(int e, const PointTable& table, SelfPair* pair, const Vec3& at, double* moments) {
  const Panel& panel = surface.panels[e];
  const NodeTable& t = *panel.table;
  panel_moments(e, table, pair, at, moments);
  for (int k = 0; k < t.n_nodes; ++k) {
    const int node = panel.first_node + k;
    const Vec3 r = Vec3(surface.node[0][node], surface.node[1][node], surface.node[2][node]) - at;
    if (r.squaredNorm() <= coincident(at[0], at[1], at[2])) continue;
    const Mat3 g = kernel_at(node, r);
    const double entries[kernel_entries] = {g(0, 0), g(0, 1), g(0, 2), g(1, 1), g(1, 2), g(2, 2)};
    for (int b = 0; b < t.n_bernstein; ++b)
      for (int c = 0; c < kernel_entries; ++c) moments[kernel_entries * b + c] -= entries[c] * t.value[static_cast<std::size_t>(t.n_nodes * b + k)];
  }
}

}  // namespace tanktread::stokes
