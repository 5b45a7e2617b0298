#pragma once
// A few doubles that are worked on together, one for each of as many elements. Operators +, -, *, / act lane by lane, so what a lane
// holds never depends on its neighbours: results do not depend on how elements are split over ranks.

#include <cmath>

namespace tanktread::membrane {

/// One register's worth.
#if defined(__AVX512F__)
constexpr int lanes = 8;
#elif defined(__AVX__)
constexpr int lanes = 4;
#else
constexpr int lanes = 2;
#endif
using Pack = double __attribute__((vector_size(lanes * sizeof(double))));

using std::sqrt;

inline Pack sqrt(const Pack& a) {
  Pack root;
  for (int l = 0; l < lanes; ++l) root[l] = std::sqrt(a[l]);
  return root;
}

}  // namespace tanktread::membrane
