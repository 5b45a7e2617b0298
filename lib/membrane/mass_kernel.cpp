#include "membrane/mass.hpp"

namespace tanktread::membrane {

void area_weights(int n, const Pack* a, const double* weight, Pack* area) {
  for (int q = 0; q < n; ++q, a += 6) {
    const Pack n1 = a[1] * a[5] - a[2] * a[4], n2 = a[2] * a[3] - a[0] * a[5], n3 = a[0] * a[4] - a[1] * a[3];
    area[q] = weight[q] * sqrt(n1 * n1 + n2 * n2 + n3 * n3);
  }
}

void mass_entries(int functions, int n, const Pack* values, const Pack* weight, Pack* entries) {
  Pack row[max_order * max_order];
  for (int a = 0; a < functions; ++a) {
    for (int q = 0; q < n; ++q) row[q] = weight[q] * values[a * n + q];
    for (int b = 0; b <= a; ++b) {
      Pack even{}, odd{};
      for (int q = 0; q + 1 < n; q += 2) {
        even += row[q] * values[b * n + q];
        odd += row[q + 1] * values[b * n + q + 1];
      }
      if (n % 2) even += row[n - 1] * values[b * n + n - 1];
      *entries++ = even + odd;
    }
  }
}

}  // namespace tanktread::membrane
