#pragma once
// Storage that keeps equal tables of numbers only once. Elements of equal particles and of uniform meshes have many equal tables.

#include <cstddef>
#include <cstring>
#include <functional>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace tanktread {

/// Start indices of tables of numbers that are stored one after the other in one array. The key is a hash of the content of the table.
using Tables = std::unordered_multimap<std::size_t, std::size_t>;

/// Registers the table that was appended to the array `all`, from index `first` to the end, and returns its start index. If an earlier table is
/// bitwise equal, removes the appended table and returns the start index of the earlier table.
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
