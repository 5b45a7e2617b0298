#include "membrane/part.hpp"

#include "membrane/bending_kernel.hpp"

namespace tanktread::membrane {
namespace {

std::vector<Pack> curvature_of(const Group& group, const Net& net) {
  std::vector<Pack> curvature(group.n_gauss() * group.batches.size());
  for (std::size_t k = 0; k < group.batches.size(); ++k) {
    Pack j[15 * max_order * max_order];
    jets(group, group.batches[k], net, j);
    curvatures(group.n_gauss(), j, &curvature[k * group.n_gauss()]);
  }
  return curvature;
}

}  // namespace

Part::Part(const spline::Space& space, const Net& unstressed, std::span<const int> list, int order, const Materials& materials)
    : elements(list.begin(), list.end()), groups(pack(space, list, order, materials.of_element)) {
  Pack a[6 * max_order * max_order];
  for (const Group& group : groups) {
    const Bending& bending = materials.all[group.material].bending;
    std::vector<Pack>& curvature = relaxed_curvature.emplace_back();
    if (bending.modulus > 0) {
      const std::size_t n = group.n_gauss() * group.batches.size();
      curvature = bending.curved_when_relaxed ? curvature_of(group, unstressed) : std::vector<Pack>(n, Pack{});
    }
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
