#pragma once
// Layer potentials at the collocation sites of their space; the shape is given with each density.

#include <span>
#include <utility>
#include <vector>

#include "stokes/layer.hpp"

namespace tanktread::stokes {

struct SingleLayer : Layer {
  SingleLayer(const spline::Space& space, const quadrature::Options& options) : Layer(Kernel::single_layer, space, space.collocation, options) {}

  void apply(const Net& x, const Net& f, Measure measure, std::span<const int> sites, Net& u) {
    set_shape(x, measure);
    Layer::apply(f, sites, u);
  }
  void assemble(const Net& x, Measure measure, std::span<const int> sites, auto&&... of) {
    set_shape(x, measure);
    Layer::assemble(sites, of...);
  }
};

struct DoubleLayer : Layer {
  DoubleLayer(const spline::Space& space, const quadrature::Options& options, std::vector<double> factor = {})
      : Layer(Kernel::double_layer, space, space.collocation, options, std::move(factor)) {}

  void apply(const Net& x, const Net& v, std::span<const int> sites, Net& u) {
    set_shape(x);
    Layer::apply(v, sites, u);
  }
  void assemble(const Net& x, std::span<const int> sites, auto&& a) {
    set_shape(x);
    Layer::assemble(sites, a);
  }
};

/// Layer potential at targets off the surface.
struct CrossLayer : Layer {
  CrossLayer(const spline::Space& space, const quadrature::Options& options, Kernel kernel) : Layer(kernel, space, {}, options) {}
};

}  // namespace tanktread::stokes
