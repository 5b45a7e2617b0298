#include "membrane/membrane.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "membrane/part.hpp"

namespace tanktread::membrane {
namespace {

constexpr std::size_t parts_kept = 3;  // all elements, a rank's own, and one more
constexpr int max_values = 6 * max_order * max_order;

}  // namespace

Membrane::Membrane(const spline::Space& space, const Net& unstressed, const Materials& materials, int order)
    : space_(&space), unstressed_(unstressed), materials_(materials), order_(order), all_(space.elements.size()) {
  assert(unstressed.rows() == space.n_points && order >= 2 && order <= 10);
  std::iota(all_.begin(), all_.end(), 0);
}

std::shared_ptr<const Part> Membrane::part(std::span<const int> elements) const {
  const auto found = std::find_if(parts_.begin(), parts_.end(), [&](const auto& p) { return std::ranges::equal(p->elements, elements); });
  if (found != parts_.end()) {
    std::rotate(parts_.begin(), found, found + 1);
  } else {
    if (parts_.size() == parts_kept) parts_.pop_back();
    parts_.insert(parts_.begin(), std::make_shared<const Part>(*space_, unstressed_, elements, order_, materials_));
  }
  return parts_.front();
}

double Membrane::energy(const Net& x) const { return energy(x, all_); }

double Membrane::energy(const Net& x, std::span<const int> elements) const {
  const std::vector<double> energies = element_energies(x, elements);
  return std::accumulate(energies.begin(), energies.end(), 0.);
}

std::vector<double> Membrane::element_energies(const Net& x, std::span<const int> elements) const {
  const auto mine = part(elements);
  std::vector<double> sum(space_->elements.size(), 0.);
  if (materials_.bend()) add_bending_energies(materials_, *mine, x, sum);
  mine->each_batch([&](const Group& group, const Batch& batch, const ReferencePoint* reference, auto...) {
    Pack a[max_values];
    tangents(group, batch, x, a);
    const Pack energies = membrane::energy(materials_.all[group.material].law, group.n_gauss(), reference, a);
    for (int l = 0; l < batch.used; ++l) sum[batch.elements[l]] += energies[l];
  });
  return sum;
}

void Membrane::load(const Net& x, std::span<const int> elements, Net& d) const {
  d.setZero(space_->n_points, 3);
  const auto mine = part(elements);
  mine->each_batch([&](const Group& group, const Batch& batch, const ReferencePoint* reference, auto...) {
    Pack a[max_values], p[max_values];
    tangents(group, batch, x, a);
    stresses(materials_.all[group.material].law, group.n_gauss(), reference, a, p);
    add_transpose(group, batch, p, d);
  });
  if (materials_.bend()) add_bending_load(materials_, *mine, x, d);
}

Net Membrane::load(const Net& x) const {
  Net d;
  load(x, all_, d);
  return d;
}

Net unstressed(const Net& rest, const Vec3& centre, double alpha) {
  return ((rest.rowwise() - centre.transpose()) / (1 + alpha)).rowwise() + centre.transpose();
}

}  // namespace tanktread::membrane
