#pragma once
// A register's worth of numbers that are worked on together. Operators +, -, *, / act lane by lane, so what a lane holds never depends on its
// neighbours: results do not depend on how targets or elements are split over ranks. For kernels only: as wide as the registers of the set of
// instructions that a file is compiled for, and in a namespace of its own for each set.

#include <cmath>
#include <cstring>

#include "base/pack.hpp"

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

#ifndef INSTRUCTIONS
#define INSTRUCTIONS baseline  // what the whole program is compiled for
#endif

namespace tanktread {
inline namespace INSTRUCTIONS {

#if defined(__AVX512F__)
constexpr int register_bytes = 64;
#elif defined(__AVX__)
constexpr int register_bytes = 32;
#else
constexpr int register_bytes = 16;
#endif

template <class Real>
struct RegisterOf {
  static constexpr int lanes = register_bytes / sizeof(Real);
  using Type __attribute__((vector_size(register_bytes))) = Real;
};
using Register = RegisterOf<double>::Type;
using FloatRegister = RegisterOf<float>::Type;
constexpr int lanes = RegisterOf<double>::lanes;

/// The registers in an array of packs, or in structs of packs.
inline Register* registers(Pack* packs) { return reinterpret_cast<Register*>(packs); }
inline const Register* registers(const Pack* packs) { return reinterpret_cast<const Register*>(packs); }

/// A register from, and to, any place in memory.
template <class Real>
typename RegisterOf<Real>::Type load(const Real* a) {
  typename RegisterOf<Real>::Type p;
  std::memcpy(&p, a, sizeof p);
  return p;
}
template <class R, class Real>
void store(const R& p, Real* a) {
  static_assert(sizeof(R) == register_bytes);
  std::memcpy(a, &p, sizeof p);
}

using std::sqrt;
inline Register sqrt(const Register& a) {
  Register root;
  for (int l = 0; l < lanes; ++l) root[l] = std::sqrt(a[l]);
  return root;
}

/// 1 / sqrt(a) to rounding, and 0 where a <= least, at least 0: a target that coincides with a node takes nothing from it. With AVX-512 from the
/// instruction's estimate y, good to 2^-14, by the series of (1 - e)^(-1/2), e = 1 - a y^2, up to e^3 (to 6e-17), in single precision by Newton's
/// step. Elsewhere root and division are as fast.
inline Register inverse_root(const Register& a, const Register& least = Register{}) {
#if defined(__AVX512F__)
  const Register y = _mm512_maskz_rsqrt14_pd(_mm512_cmp_pd_mask(a, least, _CMP_GT_OQ), a);
  const Register e = 1 - (a * y) * y;
  return y + (y * e) * (0.5 + e * (0.375 + 0.3125 * e));
#else
  return a > least ? 1 / sqrt(a) : Register{};
#endif
}
inline FloatRegister inverse_root(const FloatRegister& a, const FloatRegister& least = FloatRegister{}) {
#if defined(__AVX512F__)
  const FloatRegister y = _mm512_maskz_rsqrt14_ps(_mm512_cmp_ps_mask(a, least, _CMP_GT_OQ), a);
  return y * (1.5f - 0.5f * a * y * y);
#else
  FloatRegister root;
  for (int l = 0; l < RegisterOf<float>::lanes; ++l) root[l] = std::sqrt(a[l]);
  return a > least ? 1 / root : FloatRegister{};
#endif
}

/// A difference that is not merged with other sums, though a kernel's sums may be reordered.
inline FloatRegister as_it_stands(FloatRegister difference) {
#if defined(__x86_64__)
  asm("" : "+v"(difference));
#elif defined(__aarch64__)
  asm("" : "+w"(difference));
#endif
  return difference;
}

/// Sum of the lanes, neighbours first.
inline double sum(const Register& a) {
  Register part = a;
  for (int n = lanes / 2; n > 0; n /= 2)
    for (int l = 0; l < n; ++l) part[l] = part[2 * l] + part[2 * l + 1];
  return part[0];
}

}  // namespace INSTRUCTIONS
}  // namespace tanktread
