#pragma once
// Eight doubles that are worked on together, one for each of eight elements. Operators +, -, *, / act lane by lane, so what a lane
// holds never depends on its neighbours: results do not depend on how elements are split over ranks.

#include <cmath>

namespace tanktread::membrane {

constexpr int lanes = 8;
using Pack = double __attribute__((vector_size(lanes * sizeof(double))));

inline Pack splat(double value) { return Pack{} + value; }

using std::sqrt;

inline Pack sqrt(const Pack& a) {
  Pack root;
  for (int l = 0; l < lanes; ++l) root[l] = std::sqrt(a[l]);
  return root;
}

}  // namespace tanktread::membrane
