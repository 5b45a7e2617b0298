#pragma once
// The elements that one caller works on, packed, with the unstressed surface at their Gauss points.

#include <span>
#include <vector>

#include "membrane/material.hpp"
#include "membrane/packed.hpp"
#include "membrane/points_kernel.hpp"

namespace tanktread::membrane {

struct Part {
  std::vector<int> elements;
  std::vector<Group> groups;
  std::vector<std::vector<ReferencePoint>> reference;  ///< a group; point q of batch k at n_gauss k + q

  std::vector<std::vector<Pack>> relaxed_curvature;  ///< c0 of `Bending` at the same places, a group; empty for groups without bending

  Part(const spline::Space& space, const Net& unstressed, std::span<const int> list, int order, const Materials& materials);

  /// use(group, batch, reference points of the batch, place of the batch's first Gauss point among those of its group, group index)
  template <class Use>
  void each_batch(const Use& use) const {
    for (std::size_t g = 0; g < groups.size(); ++g)
      for (std::size_t k = 0; k < groups[g].batches.size(); ++k) {
        const std::size_t first = k * groups[g].n_gauss();
        use(groups[g], groups[g].batches[k], &reference[g][first], first, g);
      }
  }
};

}  // namespace tanktread::membrane
