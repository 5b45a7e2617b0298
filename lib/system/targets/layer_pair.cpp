#include "system/targets/layer_pair.hpp"

#include <vector>

namespace tanktread::coupling {

LayerPair::LayerPair(const spline::Space& space, const stokes::Sites& points, const Net& unstressed, std::span<const Particle> particles,
                     const quadrature::Options& quadrature, const stokes::Medium* medium)
    : single_layer(stokes::Layer::Kernel::single_layer, space, points, quadrature), measure(coupling::measure(particles)) {
  single_layer.set_reference(unstressed, loads_per_current_area(particles));
  if (std::vector<double> contrasts = viscosity_contrasts(particles); !contrasts.empty())
    double_layer.emplace(stokes::Layer::Kernel::double_layer, space, points, quadrature, std::move(contrasts));
  if (!medium) return;
  single_layer.set_medium(*medium);
  if (double_layer) double_layer->set_medium(*medium);
}

void LayerPair::repeat(const stokes::PeriodicCell& cell) {
  single_layer.repeat(cell);
  if (double_layer) double_layer->repeat(cell);
}

void LayerPair::set_shape(const Net& x) {
  single_layer.set_shape(x, measure);
  if (double_layer) double_layer->set_shape(x);
}

void LayerPair::apply(const Net& f, const Net& v, double viscosity, std::span<const int> own, Net& u) {
  single_layer.apply(f, own, u);
  for (const int i : own) u.row(i) /= -viscosity;
  if (!double_layer) return;
  Net part(u.rows(), 3);
  double_layer->apply(v, own, part);
  for (const int i : own) u.row(i) += part.row(i);
}

stokes::Evaluations LayerPair::evaluations() const {
  stokes::Evaluations sum = single_layer.evaluations();
  if (double_layer) sum += double_layer->evaluations();
  return sum;
}

}  // namespace tanktread::coupling
