#include "system/frozen/frozen_layers.hpp"

#include <algorithm>
#include <cmath>

#include "base/small_matrices.hpp"

namespace tanktread::coupling {

Corotation::Corotation(std::span<const Particle> particles, const Net& from, const Net& to) {
  for (const Particle& particle : particles) {
    blocks_.push_back(particle.block);
    rotations_.push_back(rotation_between(particle.block.rows(from), particle.block.rows(to)));
  }
}

Net Corotation::back(const Net& f) const { return rotated(f, true); }
Net Corotation::forth(const Net& f) const { return rotated(f, false); }

Net Corotation::rotated(Net f, bool back) const {
  for (std::size_t p = 0; p < blocks_.size(); ++p) {
    auto rows = blocks_[p].rows(f);
    rows = (rows * (back ? rotations_[p] : Mat3(rotations_[p].transpose()))).eval();
  }
  return f;
}

Net Corotation::deformation(std::span<const Particle> particles, const Net& from, const Net& to) {
  Net difference(to.rows(), 3);
  for (const Particle& particle : particles) {
    const auto before = particle.block.rows(from), after = particle.block.rows(to);
    const Net start = before.rowwise() - before.colwise().mean();
    particle.block.rows(difference) = (after.rowwise() - after.colwise().mean()) - start * rotation_between(before, after).transpose();
  }
  return difference;
}

FrozenLayers::FrozenLayers(const spline::Space& space, const Net& unstressed, const CapsuleParameters& parameters, const RowShare& layout,
                           const Targets& targets, const membrane::MassMatrix& mass, ParticleLayers& layers)
    : unstressed_(unstressed), parameters_(parameters), layout_(layout), targets_(targets), mass_(mass), layers_(layers) {
  nodal_.share(layout.ranks().rank(), layout.ranks().size(), parameters.symmetry.fundamental());
  if (targets.projection())
    at_sites_.emplace(space, space.collocation, unstressed, parameters.particles, parameters.quadrature, parameters.viscosity,
                      parameters.medium.get());
}

bool FrozenLayers::nodal() const {
  const bool contrast = std::ranges::any_of(parameters_.particles, [](const Particle& one) { return !one.rigid && one.viscosity_ratio != 1; });
  return !parameters_.solvers.assembles_frozen(contrast, static_cast<double>(unstressed_.rows()));
}

void FrozenLayers::assemble(const Net& at, const Net& x) {
  at_ = at;
  corotation_ = {};
  const std::vector<int>& own = layout_.points();
  const int n = static_cast<int>(x.rows());
  stokes::Layer& single = at_sites_ ? at_sites_->single_layer : layers_.single_layer();
  const auto assemble = [&](std::span<const int> targets, auto&&... of) { single.assemble(targets, of...); };
  single.set_shape(x, stokes::Measure::reference);
  if (nodal()) {
    const Eigen::SparseMatrix<double>& sites = targets_.at_sites();
    const NodalOperator::Surface surface{sites * x, sites, mass_.row_sums(unstressed_), mass_.row_sums(x), parameters_.symmetry};
    nodal_.assemble(own, surface, 3, parameters_.quadrature.far_sum, assemble);
  } else {
    single_.assemble(own, n, assemble, std::ranges::max_element(parameters_.particles, {}, &Particle::radius)->radius);
  }
  if (!has_double()) return;
  stokes::Layer& layer = at_sites_ ? *at_sites_->double_layer : *layers_.double_layer();
  layer.set_shape(x);
  double_.assemble(own, n, [&](std::span<const int> targets, stokes::Rows<float>& rows) { layer.assemble(targets, rows); });
}

void FrozenLayers::turn_to(const Net& x) {
  if (at_.rows() == x.rows()) corotation_ = Corotation(parameters_.particles, at_, x);
}

Net FrozenLayers::single_layer(const Net& f) {
  Net u = Net::Zero(f.rows(), 3);
  if (nodal()) {
    nodal_.apply(corotation_.back(f), u);
    layout_.gather(nodal_.shared(), u);
  } else {
    single_.apply(corotation_.back(f), u);
    layout_.replicate(u);
  }
  return corotation_.forth(u);
}

Net FrozenLayers::double_layer(const Net& v) const {
  Net u = Net::Zero(v.rows(), 3);
  double_.apply(corotation_.back(v), u);
  layout_.replicate(u);
  return corotation_.forth(u);
}

double FrozenLayers::bytes() const {
  const double pairs = std::pow(static_cast<double>(unstressed_.rows()), 2);
  return FrozenOperator::bytes_a_pair * ((nodal() ? 0 : 1) + has_double()) * pairs;
}

stokes::Evaluations FrozenLayers::evaluations() const { return at_sites_ ? at_sites_->evaluations() : stokes::Evaluations(); }

}  // namespace tanktread::coupling
