#pragma once
// Single and double layer of all particles at one set of targets, kept from an earlier shape for the Jacobian (frozen).

#include <functional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "stokes/layer.hpp"
#include "system/frozen/frozen_operator.hpp"

namespace tanktread::coupling {

class LayerPair;

/// Frozen copy of a LayerPair at points off the particles.
class FrozenPair {
 public:
  /// Computes the rows of a layer at these targets, see FrozenOperator::Assemble.
  using Assemble = std::function<void(stokes::Layer& layer, std::span<const int> targets, stokes::Rows<float>& rows)>;

  /// Stores the rows of both layers at the rank-owned `targets`. `n`: number of control points. `length`: length of the scene. Collective.
  void assemble(const std::vector<int>& targets, int n, LayerPair& layers, double length, const Assemble& assemble);

  /// Adds the velocity that f and v cause, as LayerPair::add does, to the rank-owned rows of u.
  void add(const Net& f, const Net& v, double viscosity, Net& u) const;

 private:
  FrozenOperator single_, double_;
  bool has_double_ = false;
};

}  // namespace tanktread::coupling
