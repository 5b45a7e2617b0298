#include "system/frozen/corotation.hpp"

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

}  // namespace tanktread::coupling
