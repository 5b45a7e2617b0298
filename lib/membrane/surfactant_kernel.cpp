#include "membrane/surfactant_kernel.hpp"

#include <cmath>
#include <cstring>

#include "base/kernel.hpp"

namespace tanktread::membrane {
namespace INSTRUCTIONS {
namespace {

/// Evaluates k fields at Gauss point q (Lanes = double), or at the Gauss points q, q + 1, ... that fill one register (Lanes = Register).
template <int k, class Lanes>
void sampled(int q, int n, int functions, const double* table, const double* control_values, double* fields) {
  Lanes sums[k] = {};
  for (int a = 0; a < functions; ++a) {
    Lanes value;
    std::memcpy(&value, table + a * n + q, sizeof value);
    for (int f = 0; f < k; ++f) sums[f] += control_values[a * k + f] * value;
  }
  for (int f = 0; f < k; ++f) std::memcpy(fields + f * n + q, &sums[f], sizeof sums[f]);
}

template <int k>
void sampled(int n, int functions, const double* table, const double* control_values, double* fields) {
  int q = 0;
  for (; q + lanes <= n; q += lanes) sampled<k, Register>(q, n, functions, table, control_values, fields);
  for (; q < n; ++q) sampled<k, double>(q, n, functions, table, control_values, fields);
}

}  // namespace

void sample(int k, int n, int functions, const double* table, const double* control_values, double* fields) {
  if (k == 1) sampled<1>(n, functions, table, control_values, fields);
  if (k == 3) sampled<3>(n, functions, table, control_values, fields);
  if (k == 4) sampled<4>(n, functions, table, control_values, fields);
}

void test(int k, int n, int functions, const double* by_s, const double* by_t, const double* along_s, const double* along_t, double* rows) {
  for (int a = 0; a < functions; ++a)
    for (int f = 0; f < k; ++f) {
      double sum = 0;
      for (int q = 0; q < n; ++q) sum += by_s[a * n + q] * along_s[f * n + q] + by_t[a * n + q] * along_t[f * n + q];
      rows[a * k + f] = sum;
    }
}

void metric(int n, const double* s, const double* t, const double* weight, double* result) {
  for (int q = 0; q < n; ++q) {
    const double ss = s[q] * s[q] + s[n + q] * s[n + q] + s[2 * n + q] * s[2 * n + q];
    const double st = s[q] * t[q] + s[n + q] * t[n + q] + s[2 * n + q] * t[2 * n + q];
    const double tt = t[q] * t[q] + t[n + q] * t[n + q] + t[2 * n + q] * t[2 * n + q];
    const double det = ss * tt - st * st, inverse = 1 / det;
    result[q] = tt * inverse, result[n + q] = -st * inverse, result[2 * n + q] = ss * inverse;
    result[3 * n + q] = weight[q] * std::sqrt(det);
  }
}

}  // namespace INSTRUCTIONS

KERNEL(void, sample, (int k, int n, int functions, const double* table, const double* control_values, double* fields),
       (k, n, functions, table, control_values, fields))
KERNEL(void, test, (int k, int n, int functions, const double* by_s, const double* by_t, const double* along_s, const double* along_t, double* rows),
       (k, n, functions, by_s, by_t, along_s, along_t, rows))
KERNEL(void, metric, (int n, const double* tangents_s, const double* tangents_t, const double* weight, double* metric_and_area),
       (n, tangents_s, tangents_t, weight, metric_and_area))

}  // namespace tanktread::membrane
