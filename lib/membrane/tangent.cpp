#include "membrane/bending_kernel.hpp"
#include "membrane/membrane.hpp"
#include "membrane/part.hpp"

namespace tanktread::membrane {

struct Tangent::Points {
  std::shared_ptr<const Part> part;
  std::vector<std::vector<TangentPoint>> of_group;
  std::vector<std::vector<Pack>> jets;  // of x; empty without bending
};

Tangent::Tangent(const Membrane& membrane) : membrane_(&membrane), points_(std::make_unique<Points>()) {}
Tangent::~Tangent() = default;
Tangent::Tangent(Tangent&&) noexcept = default;

void Tangent::update(const Net& x, std::span<const int> elements) {
  points_->part = membrane_->part(elements);
  const Part& part = *points_->part;
  points_->of_group.resize(part.groups.size());
  for (std::size_t g = 0; g < part.groups.size(); ++g) points_->of_group[g].resize(part.reference[g].size());
  part.each_batch([&](const Group& group, const Batch& batch, const ReferencePoint* reference, std::size_t first, std::size_t g) {
    Pack a[6 * max_order * max_order];
    tangents(group, batch, x, a);
    tangent_points(membrane_->materials().all[group.material].law, group.n_gauss(), reference, a, &points_->of_group[g][first]);
  });
  if (!membrane_->materials().bend()) return;
  points_->jets.resize(part.groups.size());
  for (std::size_t g = 0; g < part.groups.size(); ++g) points_->jets[g].resize(15 * part.reference[g].size());
  part.each_batch([&](const Group& group, const Batch& batch, const ReferencePoint*, std::size_t first, std::size_t g) {
    jets(group, batch, x, &points_->jets[g][15 * first]);
  });
}

void Tangent::apply(const Net& u, Net& hu) const {
  hu.setZero(membrane_->space().n_points, 3);
  points_->part->each_batch([&](const Group& group, const Batch& batch, const ReferencePoint*, std::size_t first, std::size_t g) {
    Pack gradient[6 * max_order * max_order], p[6 * max_order * max_order];
    tangents(group, batch, u, gradient);
    membrane::apply(group.n_gauss(), &points_->of_group[g][first], gradient, p);
    add_transpose(group, batch, p, hu);
  });
  if (points_->jets.empty()) return;
  points_->part->each_batch([&](const Group& group, const Batch& batch, const ReferencePoint*, std::size_t first, std::size_t g) {
    Pack gradient[15 * max_order * max_order], p[15 * max_order * max_order];
    jets(group, batch, u, gradient);
    const double modulus = membrane_->materials().all[group.material].bending.modulus;
    if (modulus == 0) return;
    bending_apply(modulus, group.n_gauss(), group.weight.data(), &points_->part->relaxed_curvature[g][first],
                  &points_->jets[g][15 * first], gradient, p);
    add_jet_transpose(group, batch, p, hu);
  });
}

}  // namespace tanktread::membrane
