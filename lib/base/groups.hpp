#pragma once
// Disjoint groups of integers that are joined step by step.

#include <vector>

#include "base/indices.hpp"

namespace tanktread {

/// Disjoint groups of the integers 0 .. n - 1 (union-find). At first, each integer is a group of its own.
class Groups {
 public:
  explicit Groups(std::size_t n) : towards_(indices(n)) {}

  /// Joins the groups of a and b.
  void join(int a, int b) { towards_[of(a)] = of(b); }

  /// Returns the representative of the group of k. Two integers are in the same group if they have the same representative.
  int of(int k) {
    while (towards_[k] != k) k = towards_[k] = towards_[towards_[k]];
    return k;
  }

 private:
  std::vector<int> towards_;  // next integer on the way to the representative
};

}  // namespace tanktread
