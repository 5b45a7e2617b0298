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

/// 1 / sqrt(a) to rounding, and 0 where a = 0: a target that coincides with a node takes nothing from it. With AVX-512 from the instruction's
/// estimate, good to 2^-14, by two of Newton's steps, y (3/2 - a y^2/2), or by one in single precision: more than twice as fast as by root and
/// division, which elsewhere are as fast. A step of third order would save a twentieth of a far sum and err by 6e-13, which a near target's double
/// layer, full of cancellation, makes 1e-7 of.
inline Pack inverse_root(const Pack& a) {
#if defined(__AVX512F__)
  const Pack half = 0.5 * a;
  Pack y = _mm512_maskz_rsqrt14_pd(_mm512_cmp_pd_mask(a, _mm512_setzero_pd(), _CMP_GT_OQ), a);
  y *= 1.5 - half * y * y;
  return y * (1.5 - half * y * y);
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
