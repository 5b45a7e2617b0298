#include "stokes/kernels/assembly_kernel.hpp"

#include "base/kernel.hpp"
#include "stokes/kernels/far_kernel.hpp"

namespace tanktread::stokes {
namespace INSTRUCTIONS {
namespace {

// Computes the kernel g[n (6 k + c) + l] for each node k and target l, with n = assembly_block. c = 0 .. 5 numbers the entries 11, 12, 13, 22, 23, 33
// of G times the weight of the node, or if Double, of T_ijm n_m with the weighted normal n of the node.
template <class Real, bool Double>
void kernel_values(const PanelNodes<Real>& panel, const double* target, std::uint32_t skip, Real* __restrict g) {
  constexpr int n = assembly_block;
  alignas(register_bytes) Real inverses[n], least[n];
  Real use[n];
  for (int l = 0; l < n; ++l) {
    use[l] = skip >> l & 1 ? 0 : 1;
    least[l] = static_cast<Real>(coincident(target[l], target[n + l], target[2 * n + l]));
  }
  for (int k = 0; k < panel.n_nodes; ++k, g += 6 * n) {
    const double x = panel.x[k], y = panel.y[k], z = panel.z[k];
    const Real weight = Double ? 0 : static_cast<Real>(panel.weight[k]);
    Real normal[3] = {};
    if (Double)
      for (int c = 0; c < 3; ++c) normal[c] = static_cast<Real>(panel.normal[c][k]);
    for (int l = 0; l < n; ++l) {
      const Real rx = static_cast<Real>(x - target[l]), ry = static_cast<Real>(y - target[n + l]),
                 rz = static_cast<Real>(z - target[2 * n + l]);
      inverses[l] = rx * rx + ry * ry + rz * rz;
    }
    for (int l = 0; l < n; l += RegisterOf<Real>::lanes) store(inverse_root(load(inverses + l), load(least + l)), inverses + l);
    for (int l = 0; l < n; ++l) {
      const Real rx = static_cast<Real>(x - target[l]), ry = static_cast<Real>(y - target[n + l]),
                 rz = static_cast<Real>(z - target[2 * n + l]);
      const Real inverse = use[l] * inverses[l], second = inverse * inverse;
      const Real height = rx * normal[0] + ry * normal[1] + rz * normal[2];
      const Real isotropic = Double ? 0 : weight * inverse;
      const Real dyadic = Double ? -6 * height * (second * second * inverse) : isotropic * second;
      g[l] = isotropic + dyadic * rx * rx;
      g[n + l] = dyadic * rx * ry;
      g[2 * n + l] = dyadic * rx * rz;
      g[3 * n + l] = isotropic + dyadic * ry * ry;
      g[4 * n + l] = dyadic * ry * rz;
      g[5 * n + l] = isotropic + dyadic * rz * rz;
    }
  }
}

// Adds the sums of g times basis function over the nodes to `sums`, for assembly_tile = 4 basis functions and 6 kernel entries at a time. These 24
// packs of sums stay in registers if the processor has enough of them.
template <class Real>
void add_products(const PanelNodes<Real>& panel, const Real* g, int first, Real* sums) {
  using Several = typename RegisterOf<Real>::Type;
  for (int a = 0; a < panel.functions; a += assembly_tile) {
    const Real* basis = panel.basis + static_cast<std::ptrdiff_t>(panel.n_nodes) * a;
    Several total[assembly_tile][6] = {};
    for (int k = 0; k < panel.n_nodes; ++k) {
      Several row[6];
#pragma GCC unroll 6
      for (int c = 0; c < 6; ++c) row[c] = load(g + assembly_block * (6 * k + c) + first);
#pragma GCC unroll 4
      for (int t = 0; t < assembly_tile; ++t) {
        const Real value = basis[panel.n_nodes * t + k];
#pragma GCC unroll 6
        for (int c = 0; c < 6; ++c) total[t][c] += value * row[c];
      }
    }
#pragma GCC unroll 4
    for (int t = 0; t < assembly_tile; ++t) {
      Real* to = sums + static_cast<std::ptrdiff_t>(6 * assembly_block) * panel.rows[a + t] + first;
#pragma GCC unroll 6
      for (int c = 0; c < 6; ++c) store(load(to + assembly_block * c) + total[t][c], to + assembly_block * c);
    }
  }
}

template <class Real>
void moments_and_products(const PanelNodes<Real>& panel, const double* target, std::uint32_t skip, Real* scratch, Real* sums) {
  if (panel.weight)
    kernel_values<Real, false>(panel, target, skip, scratch);
  else
    kernel_values<Real, true>(panel, target, skip, scratch);
  for (int first = 0; first < assembly_block; first += RegisterOf<Real>::lanes) add_products(panel, scratch, first, sums);
}

}  // namespace

void far_moments(const PanelNodes<float>& panel, const double* target, std::uint32_t skip, float* scratch, float* sums) {
  moments_and_products(panel, target, skip, scratch, sums);
}

void far_moments(const PanelNodes<double>& panel, const double* target, std::uint32_t skip, double* scratch, double* sums) {
  moments_and_products(panel, target, skip, scratch, sums);
}

}  // namespace INSTRUCTIONS

KERNEL(void, far_moments, (const PanelNodes<float>& panel, const double* target, std::uint32_t skip, float* scratch, float* sums),
       (panel, target, skip, scratch, sums))
KERNEL(void, far_moments, (const PanelNodes<double>& panel, const double* target, std::uint32_t skip, double* scratch, double* sums),
       (panel, target, skip, scratch, sums))

}  // namespace tanktread::stokes
