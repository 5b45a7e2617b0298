#pragma once
// Sums over elements that do not depend, to the last bit, on who adds up which of them.

#include <algorithm>
#include <span>
#include <vector>

namespace tanktread::surface {

/// Elements are summed in blocks of this many in a row, then the blocks in their order. Ranks share whole blocks.
constexpr int block_size = 64;

inline int n_blocks(int n_elements) { return (n_elements + block_size - 1) / block_size; }

/// The elements of some blocks, in their order.
inline std::vector<int> elements_of(std::span<const int> blocks, int n_elements) {
  std::vector<int> elements;
  for (const int b : blocks)
    for (int e = block_size * b; e < std::min(block_size * (b + 1), n_elements); ++e) elements.push_back(e);
  return elements;
}

/// The sum of each block, of one number an element.
inline std::vector<double> block_sums(std::span<const double> of_elements) {
  std::vector<double> sums(n_blocks(static_cast<int>(of_elements.size())), 0.);
  for (std::size_t e = 0; e < of_elements.size(); ++e) sums[e / block_size] += of_elements[e];
  return sums;
}

}  // namespace tanktread::surface
