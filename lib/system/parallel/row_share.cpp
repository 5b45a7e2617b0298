#include "system/parallel/row_share.hpp"

#include <algorithm>
#include <utility>

namespace tanktread::coupling {

RowShare::RowShare(const spline::Space& space, const surface::Symmetry& symmetry, Phases& phases)
    : symmetry_(symmetry),
      share_(surface::share(space, surface::partition_of_points(space, ranks_.size(), symmetry.fundamental()), ranks_.rank())) {
  const auto points = [&](int e) { return std::span<const int>(space.elements[static_cast<std::size_t>(e)].points); };
  surface::FundamentalElements found = surface::fundamental_elements(symmetry, static_cast<int>(space.elements.size()), points);
  const auto mine = [&](int a) { return std::ranges::binary_search(share_.points, symmetry.source()[a]); };
  std::erase_if(found.element, [&](int e) { return std::ranges::none_of(points(e), mine); });
  folded_ = found.whole();
  elements_ = folded_ ? std::move(found.element) : share_.elements;
  ranks_.measure(phases);
  ranks_.set_owned_rows(share_.points, symmetry);
}

void RowShare::replicate_sums(Net& net) const {
  if (folded_) surface::fold(symmetry_, net);
  replicate(net);
}

void RowShare::gather(bool shared, Net& net) const {
  if (!shared) return replicate(net);
  Net* const one[] = {&net};
  ranks_.add(one);
}

void RowShare::solve(const membrane::SymmetricSolver& a, std::span<Net* const> fields) const {
  const std::vector<int> components = a.components();
  int column = 0;
  for (Net* const field : fields) {
    std::vector<int> mine;
    for (const int c : components)
      if (ranks_.owner(column++, 3 * static_cast<int>(fields.size())) == ranks_.rank()) mine.push_back(c);
    *field = a.solve(*field, mine);
  }
  ranks_.add(fields);
}

Net RowShare::solved(const membrane::SymmetricSolver& a, Net field) const {
  Net* const one[] = {&field};
  solve(a, one);
  return field;
}

}  // namespace tanktread::coupling
