#include "membrane/part.hpp"

namespace tanktread::membrane {

Part::Part(const spline::Space& space, const Net& unstressed, std::span<const int> list, int order)
    : elements(list.begin(), list.end()), groups(pack(space, list, order)) {
  Pack a[6 * max_order * max_order];
  for (const Group& group : groups) {
    std::vector<ReferencePoint>& points = reference.emplace_back(group.n_gauss() * group.batches.size());
    for (std::size_t k = 0; k < group.batches.size(); ++k) {
      const Batch& batch = group.batches[k];
      ReferencePoint* first = &points[k * group.n_gauss()];
      tangents(group, batch, unstressed, a);
      reference_points(group.n_gauss(), a, group.weight.data(), first);
      for (int q = 0; q < group.n_gauss(); ++q)
        for (int l = batch.used; l < lanes; ++l) first[q].area[l] = 0;
    }
  }
}

}  // namespace tanktread::membrane
