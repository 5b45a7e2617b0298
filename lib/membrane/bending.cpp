#include "membrane/bending.hpp"

#include "membrane/bending_kernel.hpp"
#include "membrane/part.hpp"

namespace tanktread::membrane {
namespace {

constexpr int max_values = 15 * max_order * max_order;

}  // namespace

void add_bending_energies(const Materials& materials, const Part& part, const Net& x, std::vector<double>& energy) {
  part.each_batch([&](const Group& group, const Batch& batch, const ReferencePoint*, std::size_t first, std::size_t g) {
    const double modulus = materials.all[group.material].bending.modulus;
    if (modulus == 0) return;
    Pack j[max_values];
    jets(group, batch, x, j);
    const Pack energies = bending_energy(modulus, group.n_gauss(), group.weight.data(), &part.relaxed_curvature[g][first], j);
    for (int l = 0; l < batch.used; ++l) energy[batch.elements[l]] += energies[l];
  });
}

void add_bending_load(const Materials& materials, const Part& part, const Net& x, Net& d) {
  part.each_batch([&](const Group& group, const Batch& batch, const ReferencePoint*, std::size_t first, std::size_t g) {
    const double modulus = materials.all[group.material].bending.modulus;
    if (modulus == 0) return;
    Pack j[max_values], p[max_values];
    jets(group, batch, x, j);
    bending_stresses(modulus, group.n_gauss(), group.weight.data(), &part.relaxed_curvature[g][first], j, p);
    add_jet_transpose(group, batch, p, d);
  });
}

}  // namespace tanktread::membrane
