#pragma once
// Lists of consecutive integers.

#include <concepts>
#include <numeric>
#include <vector>

namespace tanktread {

/// Returns n consecutive integers, of which the smallest is `first`.
std::vector<int> indices(std::integral auto n, int first = 0) {
  std::vector<int> all(static_cast<std::size_t>(n));
  std::iota(all.begin(), all.end(), first);
  return all;
}

}  // namespace tanktread
