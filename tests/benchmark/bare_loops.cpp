// Interactions per second of minimal far-sum loops that compute 1/sqrt in all ways which this processor supports, in double and in single precision,
// and of the program's far sums. The rate of the program's far sum in double precision is divided by the rate of the fastest loop that is exact to
// rounding. Its rate in single precision is divided by the rate of the loop in single precision, whose positions are rounded to single precision.

#define INSTRUCTIONS of_this_machine  // this file is compiled for the instruction set of this processor

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "base/instruction_set.hpp"
#include "base/register.hpp"
#include "stokes/kernels/far_kernel.hpp"

namespace {

using namespace tanktread;

struct RootAndDivision {
  static Register inverse(const Register& a) { return a > 0 ? 1 / sqrt(a) : Register{}; }
};

#if defined(__AVX512F__)
Register estimate(const Register& a) { return _mm512_maskz_rsqrt14_pd(_mm512_cmp_pd_mask(a, Register{}, _CMP_GT_OQ), a); }
FloatRegister estimate(const FloatRegister& a) { return _mm512_maskz_rsqrt14_ps(_mm512_cmp_ps_mask(a, FloatRegister{}, _CMP_GT_OQ), a); }
#define HAS_ESTIMATE
#elif defined(__AVX2__)
#include <immintrin.h>
Register estimate(const Register& a) { return a > 0 ? Register(_mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(a)))) : Register{}; }
FloatRegister estimate(const FloatRegister& a) { return a > 0 ? FloatRegister(_mm256_rsqrt_ps(a)) : FloatRegister{}; }
#define HAS_ESTIMATE
#endif

#if defined(HAS_ESTIMATE)
struct TwoNewtonSteps {
  static Register inverse(const Register& a) {
    Register y = estimate(a);
    y *= 1.5 - 0.5 * a * y * y;
    return y * (1.5 - 0.5 * a * y * y);
  }
};
struct ThirdOrder {
  static Register inverse(const Register& a) {
    const Register y = estimate(a), e = 1 - a * y * y;
    return y + y * e * (0.5 + 0.375 * e);
  }
};
struct FourthOrder {
  static Register inverse(const Register& a) {
    const Register y = estimate(a), e = 1 - (a * y) * y;
    return y + (y * e) * (0.5 + e * (0.375 + 0.3125 * e));
  }
};
struct Single {
  static FloatRegister inverse(const FloatRegister& a) {
    const FloatRegister y = estimate(a);
    return y * (1.5f - 0.5f * a * y * y);
  }
};
#endif

/// 8,192 nodes, and 2,048 targets in blocks of the size that the program's far sum uses.
template <class Real>
struct Places {
  static constexpr int n = 8192, blocks = 128;
  std::vector<Real> forces = std::vector<Real>(6 * n), targets = std::vector<Real>(3 * stokes::far_block * blocks);
  Places() {
    for (std::size_t k = 0; k < forces.size(); ++k) forces[k] = static_cast<Real>(std::sin(1. + static_cast<double>(k)));
    for (std::size_t k = 0; k < targets.size(); ++k) targets[k] = static_cast<Real>(std::cos(1. + static_cast<double>(k)));
  }
};

template <class Root, class Real>
void block_sum(int n, const Real* f, const Real* target, Real* u) {
  using Several = typename RegisterOf<Real>::Type;
  constexpr int width = RegisterOf<Real>::lanes, tile = std::min(stokes::far_block / width, 4);
  for (int first = 0; first < stokes::far_block; first += tile * width) {
    Several x0[tile][3], sum[tile][3] = {};
    for (int p = 0; p < tile; ++p)
      for (int c = 0; c < 3; ++c) x0[p][c] = load(target + stokes::far_block * c + first + width * p);
    for (int k = 0; k < n; ++k)
#pragma GCC unroll 4
      for (int p = 0; p < tile; ++p) {
        const Several x = f[k] - x0[p][0], y = f[n + k] - x0[p][1], z = f[2 * n + k] - x0[p][2];
        const Several inverse = Root::inverse(x * x + y * y + z * z);
        const Several along = (x * f[3 * n + k] + y * f[4 * n + k] + z * f[5 * n + k]) * (inverse * inverse);
        sum[p][0] += inverse * (f[3 * n + k] + x * along);
        sum[p][1] += inverse * (f[4 * n + k] + y * along);
        sum[p][2] += inverse * (f[5 * n + k] + z * along);
      }
    for (int p = 0; p < tile; ++p)
      for (int c = 0; c < 3; ++c) store(sum[p][c], u + stokes::far_block * c + first + width * p);
  }
}

double fastest = 0, fastest_single = 0;  // largest rate of the loops that are exact to rounding, and of the loops in single precision

/// Returns the interactions per second of processor time of sum(forces, targets of a block, values), the largest of all repetitions.
template <class Real, class Sum>
double rate(benchmark::State& state, const Sum& sum) {
  const Places<Real> places;
  Real u[3 * stokes::far_block];
  double best = 0;
  for (auto _ : state) {
    const std::clock_t start = std::clock();
    for (int b = 0; b < places.blocks; ++b) {
      sum(places.forces.data(), &places.targets[3 * stokes::far_block * b], u);
      benchmark::DoNotOptimize(u);
    }
    best = std::max(best, double(places.n) * stokes::far_block * places.blocks * CLOCKS_PER_SEC / double(std::clock() - start));
  }
  state.counters["interactions/s"] = best;
  return best;
}

template <class Root, class Real, bool exact>
void bare_loop(benchmark::State& state) {
  const double found = rate<Real>(state, [](const Real* f, const Real* target, Real* u) { block_sum<Root>(Places<Real>::n, f, target, u); });
  double& most = exact ? fastest : fastest_single;
  if (exact || sizeof(Real) < sizeof(double)) most = std::max(most, found);
}
BENCHMARK(bare_loop<RootAndDivision, double, true>)->Unit(benchmark::kMillisecond)->Iterations(20);
#if defined(HAS_ESTIMATE)
BENCHMARK(bare_loop<TwoNewtonSteps, double, true>)->Unit(benchmark::kMillisecond)->Iterations(20);
BENCHMARK(bare_loop<ThirdOrder, double, false>)->Unit(benchmark::kMillisecond)->Iterations(20);
BENCHMARK(bare_loop<FourthOrder, double, true>)->Unit(benchmark::kMillisecond)->Iterations(20);
BENCHMARK(bare_loop<Single, float, false>)->Unit(benchmark::kMillisecond)->Iterations(20);
#endif

template <stokes::Precision precision>
void program_far_sum(benchmark::State& state) {
  constexpr int n = Places<double>::n;
  constexpr bool single = precision == stokes::Precision::single;
  state.SetLabel(instructions());
  const double found = rate<double>(state, [](const double* f, const double* target, double* u) {
    const stokes::Charges forces{n, f, f + n, f + 2 * n, {f + 3 * n, f + 4 * n, f + 5 * n}};
    single ? stokes::stokeslet_sum_in_single(forces, target, u) : stokes::stokeslet_sum(forces, target, u);
  });
  state.counters["over the fastest"] = found / (single ? fastest_single : fastest);
}
BENCHMARK(program_far_sum<stokes::Precision::full>)->Unit(benchmark::kMillisecond)->Iterations(20);
BENCHMARK(program_far_sum<stokes::Precision::single>)->Unit(benchmark::kMillisecond)->Iterations(20);

}  // namespace
