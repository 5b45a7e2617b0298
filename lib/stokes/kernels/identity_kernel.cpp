#include "stokes/kernels/identity_kernel.hpp"

#include <cmath>

#include "base/kernel.hpp"

namespace tanktread::stokes {
namespace INSTRUCTIONS {

IdentitySums identity_sums(int n, const double* x, const double* y, const double* z, const double* nx, const double* ny, const double* nz,
                           const double* x0, const double* n0) {
  double p[3] = {}, isotropic = 0, dyadic[6] = {}, mixed[9] = {};  // sums over the nodes. p: IdentitySums::pressure. The other three add up to
                                                                   // IdentitySums::shear. `isotropic`: factor of the identity I. `dyadic`: terms with
                                                                   // r r. `mixed`: terms (G n0) N
  for (int k = 0; k < n; ++k) {
    const double r[3] = {x[k] - x0[0], y[k] - x0[1], z[k] - x0[2]}, normal[3] = {nx[k], ny[k], nz[k]};
    const double square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2], inverse = square > 0 ? 1 / std::sqrt(square) : 0;
    const double cube = inverse * inverse * inverse;
    const double height = r[0] * normal[0] + r[1] * normal[1] + r[2] * normal[2], height0 = r[0] * n0[0] + r[1] * n0[1] + r[2] * n0[2];
    const double aligned = n0[0] * normal[0] + n0[1] * normal[1] + n0[2] * normal[2];
    const double rr = aligned * cube + 6 * height0 * height * cube * inverse * inverse;
    isotropic += aligned * inverse;
    for (int i = 0; i < 3; ++i) p[i] += inverse * normal[i] + cube * height * r[i];
    dyadic[0] += rr * r[0] * r[0], dyadic[1] += rr * r[0] * r[1], dyadic[2] += rr * r[0] * r[2];
    dyadic[3] += rr * r[1] * r[1], dyadic[4] += rr * r[1] * r[2], dyadic[5] += rr * r[2] * r[2];
    for (int i = 0; i < 3; ++i) {
      const double g = inverse * n0[i] + cube * height0 * r[i];
      for (int j = 0; j < 3; ++j) mixed[3 * i + j] += g * normal[j];
    }
  }
  constexpr int entry[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  IdentitySums sums;
  for (int i = 0; i < 3; ++i) sums.pressure[i] = p[i];
  for (int k = 0; k < 9; ++k) sums.shear[k] = (k % 4 ? 0 : isotropic) + dyadic[entry[k]] + mixed[k];
  return sums;
}

}  // namespace INSTRUCTIONS

KERNEL(IdentitySums, identity_sums,
       (int n, const double* x, const double* y, const double* z, const double* nx, const double* ny, const double* nz, const double* x0,
        const double* n0),
       (n, x, y, z, nx, ny, nz, x0, n0))

}  // namespace tanktread::stokes
