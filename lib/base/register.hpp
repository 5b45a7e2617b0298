#pragma once
// SIMD registers. Operators +, -, *, / act on each lane. A lane does not depend on its neighbours, so results do not depend on how targets or
// elements are split over ranks. This file is only for kernels: the width of a register depends on the instruction set for which a file is
// compiled, and each instruction set has its own namespace.

#include <cmath>
#include <cstring>

#include "base/pack.hpp"

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

#ifndef INSTRUCTIONS
#define INSTRUCTIONS baseline  // instruction set for which the whole program is compiled
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

/// Returns the registers in an array of packs or of structs of packs.
inline Register* registers(Pack* packs) { return reinterpret_cast<Register*>(packs); }
inline const Register* registers(const Pack* packs) { return reinterpret_cast<const Register*>(packs); }

/// Returns a register loaded from memory of any alignment.
template <class Real>
typename RegisterOf<Real>::Type load(const Real* a) {
  typename RegisterOf<Real>::Type p;
  std::memcpy(&p, a, sizeof p);
  return p;
}
/// Stores a register to memory of any alignment.
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

/// Returns 1 / sqrt(a) to round-off; 0 if a <= least, so that a node that coincides with the target contributes nothing. least >= 0. With AVX-512,
/// corrects the hardware estimate y, which is accurate to 2^-14: in double precision by the series of (1 - e)^(-1/2) with e = 1 - a y^2, up to e^3
/// (error 6e-17), in single precision by one Newton step. With other instruction sets, square root and division are as fast.
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

/// Returns the sum of all lanes of a register, adding neighbouring lanes first.
inline double sum(const Register& a) {
  Register part = a;
  for (int n = lanes / 2; n > 0; n /= 2)
    for (int l = 0; l < n; ++l) part[l] = part[2 * l] + part[2 * l + 1];
  return part[0];
}

}  // namespace INSTRUCTIONS
}  // namespace tanktread
