#pragma once
// Eight doubles that are worked on together. Operators +, -, *, / act lane by lane, so what a lane holds never depends on its neighbours.

#include <cmath>

namespace tanktread::stokes {

constexpr int lanes = 8;
using Pack = double __attribute__((vector_size(lanes * sizeof(double))));

/// 1 / sqrt(a), and 0 where a = 0: a target that coincides with a node takes nothing from it.
inline Pack inverse_root(const Pack& a) {
  Pack root;
  for (int l = 0; l < lanes; ++l) root[l] = std::sqrt(a[l]);
  return a > 0 ? 1 / root : Pack{};
}

/// Sum of the lanes, always in the same order.
inline double sum(const Pack& a) { return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7])); }

}  // namespace tanktread::stokes
