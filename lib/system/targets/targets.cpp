#include "system/targets/targets.hpp"

#include "system/targets/collocation.hpp"

namespace tanktread::coupling {

Targets::Targets(const spline::Space& space, const Net& unstressed, const CapsuleParameters& parameters, const RowShare& layout)
    : space_(space), layout_(layout), at_sites_(collocation_matrix(space)), collocation_(parameters.solvers.direct, parameters.symmetry) {
  collocation_.factor(at_sites_);
  if (parameters.solvers.projection != "collocation")
    projection_.emplace(space, unstressed, parameters.symmetry, parameters.solvers.direct, layout.ranks());
}

void Targets::gather(bool shared, Net& at_targets) const {
  if (!projection_) return layout_.gather(shared, at_targets);
  layout_.add({at_targets.data(), static_cast<std::size_t>(at_targets.size())});
}

Net Targets::control_values(Net at_targets) const {
  return projection_ ? projection_->control_values(at_targets) : collocated(std::move(at_targets));
}

}  // namespace tanktread::coupling
