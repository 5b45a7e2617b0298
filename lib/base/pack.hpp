#pragma once
// A register's worth of numbers that are worked on together. Operators +, -, *, / act lane by lane, so what a lane holds never depends on its
// neighbours: results do not depend on how targets or elements are split over ranks.

#include <cmath>
#include <cstring>

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace tanktread {

#if defined(__AVX512F__)
constexpr int register_bytes = 64;
#elif defined(__AVX__)
constexpr int register_bytes = 32;
#else
constexpr int register_bytes = 16;
#endif

template <class Real>
struct Register {
  static constexpr int lanes = register_bytes / sizeof(Real);
  using Pack __attribute__((vector_size(register_bytes))) = Real;
};
using Pack = Register<double>::Pack;
constexpr int lanes = Register<double>::lanes;

/// A register from, and to, any place in memory.
template <class Real>
typename Register<Real>::Pack load(const Real* a) {
  typename Register<Real>::Pack p;
  std::memcpy(&p, a, sizeof p);
  return p;
}
template <class P, class Real>
void store(const P& p, Real* a) {
  static_assert(sizeof(P) == register_bytes);
  std::memcpy(a, &p, sizeof p);
}

using std::sqrt;
inline Pack sqrt(const Pack& a) {
  Pack root;
  for (int l = 0; l < lanes; ++l) root[l] = std::sqrt(a[l]);
  return root;
}

/// 1 / sqrt(a), and 0 where a = 0: a target that coincides with a node takes nothing from it. With AVX-512 from the instruction's y = 2^-14 by one
/// step of third order, y + y e (1/2 + 3/8 e) with e = 1 - a y^2, which errs by 5/16 e^3 < 6e-13; in single precision by Newton's, which errs by
/// rounding. Elsewhere by root and division, which are as fast.
inline Pack inverse_root(const Pack& a) {
#if defined(__AVX512F__)
  const Pack y = _mm512_maskz_rsqrt14_pd(_mm512_cmp_pd_mask(a, _mm512_setzero_pd(), _CMP_GT_OQ), a), e = 1 - a * y * y;
  return y + y * e * (0.5 + 0.375 * e);
#else
  return a > 0 ? 1 / sqrt(a) : Pack{};
#endif
}
inline Register<float>::Pack inverse_root(const Register<float>::Pack& a) {
#if defined(__AVX512F__)
  const Register<float>::Pack y = _mm512_maskz_rsqrt14_ps(_mm512_cmp_ps_mask(a, _mm512_setzero_ps(), _CMP_GT_OQ), a);
  return y * (1.5f - 0.5f * a * y * y);
#else
  Register<float>::Pack root;
  for (int l = 0; l < Register<float>::lanes; ++l) root[l] = std::sqrt(a[l]);
  return a > 0 ? 1 / root : Register<float>::Pack{};
#endif
}

/// Sum of the lanes, neighbours first.
inline double sum(const Pack& a) {
  Pack part = a;
  for (int n = lanes / 2; n > 0; n /= 2)
    for (int l = 0; l < n; ++l) part[l] = part[2 * l] + part[2 * l + 1];
  return part[0];
}

}  // namespace tanktread
