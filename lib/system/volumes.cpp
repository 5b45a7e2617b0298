#include "system/volumes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace tanktread::coupling {

Eigen::VectorXd VolumeProjection::multipliers(const Net& v) const {
  Eigen::VectorXd all(std::ssize(blocks));
  for (Eigen::Index k = 0; const spline::Block& block : blocks) {
    const auto product = [&](const Net& net) { return (block.rows(gradient).array() * block.rows(net).array()).sum(); };
    all[k++] = product(v) / product(direction);
  }
  return all;
}

void VolumeProjection::subtract(const Eigen::VectorXd& multipliers, Net& v) const {
  for (Eigen::Index k = 0; const spline::Block& block : blocks) block.rows(v) -= multipliers[k++] * block.rows(direction);
}

Volumes::Volumes(const spline::Space& space, const Net& initial, const std::vector<Particle>& particles, const RowShare& layout, Phases& phases)
    : particles_(particles), layout_(layout), phases_(phases), geometry_(space) {
  for (const Particle& one : particles)
    kept_.push_back(one.kept_volume ? *one.kept_volume : surface::volume(*one.space, one.block.rows(initial)));
}

Net Volumes::gradient(const Net& x) const {
  const auto clock = phases_.time("volume");
  Net b(x.rows(), 3);
  geometry_.volume_gradient(x, layout_.elements(), b);
  layout_.replicate_sums(b);
  return b;
}

VolumeProjection Volumes::projection(Net gradient, Net direction) const {
  VolumeProjection found{std::move(gradient), std::move(direction), {}};
  for (const Particle& one : particles_)
    if (!one.rigid) found.blocks.push_back(one.block);
  return found;
}

void Volumes::restore(Net& x, const std::function<Net(const Net& b)>& along) const {
  std::vector<double> missing(particles_.size());  // volume to be added to each particle, divided by its prescribed volume V0
  Net c;
  const auto larger_than = [&](double bound) { return std::ranges::any_of(missing, [&](double m) { return !(std::abs(m) <= bound); }); };
  for (int k = 0; k < 6; ++k) {  // more than two corrections are needed only after a very long step
    const Net b = gradient(x);
    for (std::size_t p = 0; p < missing.size(); ++p) {
      const auto rows = particles_[p].block.rows(x);
      const double volume = (rows.rowwise() - rows.colwise().mean()).cwiseProduct(particles_[p].block.rows(b)).sum() / 3;
      missing[p] = particles_[p].rigid ? 0 : 1 - volume / kept_[p];
    }
    if (k > 1 && !larger_than(2e-15)) return;
    if (k == 5) break;
    if (k == 0) c = along(b);
    for (std::size_t p = 0; p < missing.size(); ++p) {
      const spline::Block& block = particles_[p].block;
      block.rows(x) += missing[p] * kept_[p] / block.rows(b).cwiseProduct(block.rows(c)).sum() * block.rows(c);
    }
  }
  if (larger_than(1e-12)) x.setConstant(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace tanktread::coupling
