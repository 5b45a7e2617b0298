// Interactions per second of minimal far-sum loops that compute 1/sqrt in all ways which this processor supports, and of the program's far sum. The
// rate of the program's far sum is divided by the rate of the fastest loop that is exact to rounding.

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
#define HAS_ESTIMATE
#elif defined(__AVX2__)
#include <immintrin.h>
Register estimate(const Register& a) { return a > 0 ? Register(_mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(a)))) : Register{}; }
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
#endif

/// 8,192 nodes, and 2,048 targets in blocks of the size that the program's far sum uses.
struct Places {
  static constexpr int n = 8192, blocks = 128;
  std::vector<double> forces = std::vector<double>(6 * n), targets = std::vector<double>(3 * stokes::far_block * blocks);
  Places() {
    for (std::size_t k = 0; k < forces.size(); ++k) forces[k] = std::sin(1. + static_cast<double>(k));
    for (std::size_t k = 0; k < targets.size(); ++k) targets[k] = std::cos(1. + static_cast<double>(k));
  }
};

template <class Root>
void block_sum(int n, const double* f, const double* target, double* u) {
  constexpr int width = RegisterOf<double>::lanes, tile = std::min(stokes::far_block / width, 4);
  for (int first = 0; first < stokes::far_block; first += tile * width) {
    Register x0[tile][3], sum[tile][3] = {};
    for (int p = 0; p < tile; ++p)
      for (int c = 0; c < 3; ++c) x0[p][c] = load(target + stokes::far_block * c + first + width * p);
    for (int k = 0; k < n; ++k)
#pragma GCC unroll 4
      for (int p = 0; p < tile; ++p) {
        const Register x = f[k] - x0[p][0], y = f[n + k] - x0[p][1], z = f[2 * n + k] - x0[p][2];
        const Register inverse = Root::inverse(x * x + y * y + z * z);
        const Register along = (x * f[3 * n + k] + y * f[4 * n + k] + z * f[5 * n + k]) * (inverse * inverse);
        sum[p][0] += inverse * (f[3 * n + k] + x * along);
        sum[p][1] += inverse * (f[4 * n + k] + y * along);
        sum[p][2] += inverse * (f[5 * n + k] + z * along);
      }
    for (int p = 0; p < tile; ++p)
      for (int c = 0; c < 3; ++c) store(sum[p][c], u + stokes::far_block * c + first + width * p);
  }
}

double fastest = 0;  // largest rate of the loops that are exact to rounding

/// Returns the interactions per second of processor time of sum(forces, targets of a block, values), the largest of all repetitions.
template <class Sum>
double rate(benchmark::State& state, const Sum& sum) {
  const Places places;
  double u[3 * stokes::far_block];
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

template <class Root, bool exact>
void bare_loop(benchmark::State& state) {
  const double found = rate(state, [](const double* f, const double* target, double* u) { block_sum<Root>(Places::n, f, target, u); });
  if (exact) fastest = std::max(fastest, found);
}
BENCHMARK(bare_loop<RootAndDivision, true>)->Unit(benchmark::kMillisecond)->Iterations(20);
#if defined(HAS_ESTIMATE)
BENCHMARK(bare_loop<TwoNewtonSteps, true>)->Unit(benchmark::kMillisecond)->Iterations(20);
BENCHMARK(bare_loop<ThirdOrder, false>)->Unit(benchmark::kMillisecond)->Iterations(20);
BENCHMARK(bare_loop<FourthOrder, true>)->Unit(benchmark::kMillisecond)->Iterations(20);
#endif

void program_far_sum(benchmark::State& state) {
  constexpr int n = Places::n;
  state.SetLabel(instructions());
  const double found = rate(state, [](const double* f, const double* target, double* u) {
    const stokes::Charges forces{n, f, f + n, f + 2 * n, {f + 3 * n, f + 4 * n, f + 5 * n}};
    stokes::stokeslet_sum(forces, target, u);
  });
  state.counters["over the fastest"] = found / fastest;
}
BENCHMARK(program_far_sum)->Unit(benchmark::kMillisecond)->Iterations(20);

}  // namespace
