#pragma once
// Kernels of layers, and properties that follow from the kernel.

#include <stdexcept>

namespace tanktread::stokes {

/// single_layer: Stokeslet G (2.1). double_layer: stresslet contracted with the normal, T_ijk n_k (2.2).
enum class LayerKernel { single_layer, double_layer };

struct KernelProperties {
  bool subtracts_density;  ///< the density at the target is subtracted from the density, as in (2.2)
  bool uses_weights;       ///< sums over far nodes use LayerSources::weight; otherwise LayerSources::normal, which contains these weights
  bool is_steep;           ///< the integrand grows like 1/r^2 with the distance r from targets on other surfaces, otherwise like 1/r
  /// Identities of a closed surface (stokes/closed_surface_identities.hpp) subtract the singularity of the kernel if there are no singular rules.
  bool has_identities;
  /// Tolerance of quadrature rules divided by the tolerance of the deck. Rules are chosen for the kernel of the single layer. The kernel of the
  /// double layer is singular by one order more, so that its error with the same rule is up to five times as large (tests/verify/layers.cpp).
  double tolerance_factor;
  /// Tolerance of sums by clusters divided by the tolerance of quadrature rules. For the double layer, the tolerance of clusters is half of the
  /// tolerance of the deck, with which the measured error is a quarter of the deck's tolerance.
  double cluster_tolerance_factor;
};

/// Returns the properties of a kernel. The compiler warns if the switch omits a kernel.
inline KernelProperties properties(LayerKernel kernel) {
  switch (kernel) {
    case LayerKernel::single_layer:
      return {.subtracts_density = false, .uses_weights = true, .is_steep = false, .has_identities = true, .tolerance_factor = 1,
              .cluster_tolerance_factor = 1};
    case LayerKernel::double_layer:
      return {.subtracts_density = true, .uses_weights = false, .is_steep = true, .has_identities = false, .tolerance_factor = 0.125,
              .cluster_tolerance_factor = 4};
  }
  throw std::logic_error("unknown LayerKernel");
}

}  // namespace tanktread::stokes
