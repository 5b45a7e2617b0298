#pragma once
// Tables of numbers of which many are equal, as those of the elements of equal particles and of uniform meshes.

#include <cstddef>
#include <cstring>
#include <functional>
#include <string_view>
#include <vector>

namespace tanktread {

/// Where the tables in an array start, by what is in them.
using Tables = std::unordered_multimap<std::size_t, std::size_t>;

/// Where the table starts that lies from `first` to the end of `all`; if it is there already, to the last bit, the one at the end is taken away.
template <class Number>
std::size_t kept_once(std::vector<Number>& all, std::size_t first, Tables& tables) {
  const std::size_t size = all.size() - first;
  const std::string_view bytes(reinterpret_cast<const char*>(all.data() + first), size * sizeof(Number));
  const std::size_t hash = std::hash<std::string_view>()(bytes);
  const auto [from, to] = tables.equal_range(hash);
  for (auto known = from; known != to; ++known)
    if (known->second + size <= first && std::memcmp(all.data() + known->second, bytes.data(), bytes.size()) == 0) {
      all.resize(first);
      return known->second;
    }
  tables.emplace(hash, first);
  return first;
}

}  // namespace tanktread
