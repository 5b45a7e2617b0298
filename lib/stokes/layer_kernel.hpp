#pragma once
// Kernels of layers, and properties that follow from the kernel. The compiler warns of each switch that omits a kernel.

#include <stdexcept>

namespace tanktread::stokes {

/// single_layer: Stokeslet G (2.1). double_layer: stresslet contracted with the normal, T_ijk n_k (2.2).
enum class LayerKernel { single_layer, double_layer };

/// Returns whether the density at the target is subtracted from the density, as in (2.2).
inline bool subtracts_density(LayerKernel kernel) {
  switch (kernel) {
    case LayerKernel::single_layer: return false;
    case LayerKernel::double_layer: return true;
  }
  throw std::logic_error("unknown LayerKernel");
}

/// Returns whether sums over the far nodes use LayerSources::weight. Otherwise they use LayerSources::normal, which contains these weights.
inline bool uses_weights(LayerKernel kernel) {
  switch (kernel) {
    case LayerKernel::single_layer: return true;
    case LayerKernel::double_layer: return false;
  }
  throw std::logic_error("unknown LayerKernel");
}

/// Returns whether the integrand grows like 1/r^2 with the distance r from targets on other surfaces. Otherwise it grows like 1/r.
inline bool is_steep(LayerKernel kernel) {
  switch (kernel) {
    case LayerKernel::single_layer: return false;
    case LayerKernel::double_layer: return true;
  }
  throw std::logic_error("unknown LayerKernel");
}

/// Returns whether identities of a closed surface (stokes/closed_surface_identities.hpp) subtract the singularity of the kernel if there are no
/// singular rules.
inline bool has_identities(LayerKernel kernel) {
  switch (kernel) {
    case LayerKernel::single_layer: return true;
    case LayerKernel::double_layer: return false;
  }
  throw std::logic_error("unknown LayerKernel");
}

/// Returns the tolerance of quadrature rules divided by the tolerance of the deck. Rules are chosen for the kernel of the single layer. The kernel of
/// the double layer is singular by one order more, so that its error with the same rule is up to five times as large (tests/verify/layers.cpp).
inline double tolerance_factor(LayerKernel kernel) {
  switch (kernel) {
    case LayerKernel::single_layer: return 1;
    case LayerKernel::double_layer: return 0.125;
  }
  throw std::logic_error("unknown LayerKernel");
}

/// Returns the tolerance of sums by clusters divided by the tolerance of quadrature rules. For the double layer, the tolerance of clusters is half of
/// the tolerance of the deck, with which the measured error is a quarter of the deck's tolerance.
inline double cluster_tolerance_factor(LayerKernel kernel) {
  switch (kernel) {
    case LayerKernel::single_layer: return 1;
    case LayerKernel::double_layer: return 4;
  }
  throw std::logic_error("unknown LayerKernel");
}

}  // namespace tanktread::stokes
