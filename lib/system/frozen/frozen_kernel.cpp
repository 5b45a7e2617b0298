#include <bit>

#include "base/kernel.hpp"
#include "system/frozen/frozen_operator.hpp"

namespace tanktread::coupling {
namespace INSTRUCTIONS {
namespace {

double widened(std::uint16_t half) { return std::bit_cast<float>(static_cast<std::uint32_t>(half) << 16); }

}  // namespace

void symmetric_block_row(int n, const std::uint16_t* entries, const double* f1, const double* f2, const double* f3, double* u) {
  const std::uint16_t *e11 = entries, *e12 = e11 + n, *e13 = e12 + n, *e22 = e13 + n, *e23 = e22 + n, *e33 = e23 + n;
  double u1 = 0, u2 = 0, u3 = 0;
  for (int b = 0; b < n; ++b) {
    const double a12 = widened(e12[b]), a13 = widened(e13[b]), a23 = widened(e23[b]);
    u1 += widened(e11[b]) * f1[b] + a12 * f2[b] + a13 * f3[b];
    u2 += a12 * f1[b] + widened(e22[b]) * f2[b] + a23 * f3[b];
    u3 += a13 * f1[b] + a23 * f2[b] + widened(e33[b]) * f3[b];
  }
  u[0] += u1, u[1] += u2, u[2] += u3;
}

}  // namespace INSTRUCTIONS

KERNEL(void, symmetric_block_row, (int n, const std::uint16_t* entries, const double* f1, const double* f2, const double* f3, double* u),
       (n, entries, f1, f2, f3, u))

}  // namespace tanktread::coupling
