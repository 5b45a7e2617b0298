#include "system/frozen/frozen_pair.hpp"

#include "system/targets/layer_pair.hpp"

namespace tanktread::coupling {

void FrozenPair::assemble(const std::vector<int>& targets, int n, LayerPair& layers, double length, const Assemble& assemble) {
  using Targets = std::span<const int>;
  has_double_ = layers.double_layer.has_value();
  single_.assemble(targets, n, [&](Targets some, stokes::Rows<float>& rows) { assemble(layers.single_layer, some, rows); }, length);
  if (has_double_) double_.assemble(targets, n, [&](Targets some, stokes::Rows<float>& rows) { assemble(*layers.double_layer, some, rows); });
}

void FrozenPair::add(const Net& f, const Net& v, double viscosity, Net& u) const {
  Net part = Net::Zero(u.rows(), 3);
  if (f.size() > 0) single_.apply(f, part), u -= part / viscosity;
  if (v.size() == 0 || !has_double_) return;
  part.setZero();
  double_.apply(v, part);
  u += part;
}

}  // namespace tanktread::coupling
