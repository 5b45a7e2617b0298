#include "system/targets/particle_layers.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

#include "base/indices.hpp"
#include "system/parallel/stop_together.hpp"

namespace tanktread::coupling {

ParticleLayers::ParticleLayers(const spline::Space& space, const Net& unstressed, const CapsuleParameters& parameters, const RowShare& layout,
                               const Targets& targets, Phases& phases)
    : parameters_(parameters), layout_(layout), targets_(targets), phases_(phases),
      pair_(space, targets.sites(), unstressed, parameters.particles, parameters.quadrature, parameters.viscosity,
            parameters.medium.get()) {
  pair_.single_layer.set_symmetry(parameters.symmetry);
  const std::vector<int> everybody = targets.projection() ? indices(targets.sites().size()) : parameters.symmetry.fundamental();
  for (stokes::Layer* const layer : {&pair_.single_layer, double_layer()})
    if (layer) layer->share(layout.ranks().rank(), layout.ranks().size(), everybody);
}

void ParticleLayers::repeat(const stokes::PeriodicCell& cell) {
  repeats_ = true;
  pair_.repeat(cell);
}

Net ParticleLayers::apply_single(const Net& x, const Net& f) {
  Net u = targets_.zero();
  if (f.isZero(0)) return u;
  {
    const auto clock = phases_.time("single layer");
    pair_.single_layer.set_shape(x, pair_.measure);
    pair_.single_layer.apply(f, targets_.own(), u);
  }
  targets_.gather(pair_.single_layer.shared(), u);
  return u;
}

Net ParticleLayers::apply_double(const Net& x, const Net& v) {
  Net u = targets_.zero();
  pair_.double_layer->set_shape(x);
  pair_.double_layer->apply(v, targets_.own(), u);
  targets_.gather(pair_.double_layer->shared(), u);
  return u;
}

void ParticleLayers::assemble(const Net& x, bool single, bool few) {
  const auto n = static_cast<double>(x.rows());
  constexpr double most_bytes = 1e9;
  const auto assemble_or_clear = [&](stokes::Layer& layer, bool cheap_products, stokes::Rows<double>& rows) {
    if (!repeats_ && parameters_.solvers.assembled(cheap_products || few))
      stop_together([&] { layer.assemble(targets_.own(), rows); });
    else
      rows.resize(0, 0);
  };
  // With rigid bodies, the solver may take many iterations, because films between them are thin. Assembling the matrix (72 n^2 bytes) is then faster.
  const bool many_iterations = parameters_.any_rigid() && 72 * n * n < most_bytes;
  if (auto& layer = pair_.double_layer) layer->set_shape(x), assemble_or_clear(*layer, layer->by_clusters() && !many_iterations, double_rows_);
  if (single) pair_.single_layer.set_shape(x, pair_.measure), assemble_or_clear(pair_.single_layer, pair_.single_layer.by_clusters(), single_rows_);
}

/// Returns the product of the assembled rows of all ranks with a field.
Net ParticleLayers::product(const stokes::Rows<double>& rows, const Net& field) const {
  Net at_targets = targets_.zero();
  const Eigen::VectorXd own = rows * flat(field);
  for (Eigen::Index k = 0; const int i : targets_.own()) at_targets.row(i) = own.segment<3>(3 * k++).transpose();
  targets_.gather(false, at_targets);
  return at_targets;
}

Net ParticleLayers::apply(const Net& x, const Net& v, const Net& f) {
  Net u = !pair_.double_layer || v.size() == 0 ? targets_.zero() : double_rows_.cols() > 0 ? product(double_rows_, v) : apply_double(x, v);
  if (f.size() > 0) u -= (single_rows_.cols() > 0 ? product(single_rows_, f) : apply_single(x, f)) / parameters_.viscosity;
  return u;
}

stokes::Rows<double> ParticleLayers::double_rows(std::span<const int> sites) {
  const std::vector<int>& points = layout_.points();
  const bool assembled = double_rows_.cols() > 0;
  std::vector<int> own;
  std::ranges::copy_if(sites, std::back_inserter(own), [&](int i) { return std::ranges::binary_search(points, i); });
  stokes::Rows<double> made;
  if (!assembled) pair_.double_layer->assemble(own, made);
  stokes::Rows<double> rows = stokes::Rows<double>::Zero(3 * static_cast<Eigen::Index>(sites.size()), 3 * targets_.values().cols());
  Eigen::Index next = 0;
  for (std::size_t k = 0; k < sites.size(); ++k) {
    const auto point = std::ranges::lower_bound(points, sites[k]);
    if (point == points.end() || *point != sites[k]) continue;
    rows.middleRows<3>(3 * static_cast<Eigen::Index>(k)) =
        assembled ? double_rows_.middleRows<3>(3 * (point - points.begin())) : made.middleRows<3>(3 * next++);
  }
  layout_.add({rows.data(), static_cast<std::size_t>(rows.size())});
  return rows;
}

}  // namespace tanktread::coupling
