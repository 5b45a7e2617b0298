#include "system/solvers/corotation.hpp"

#include <utility>

#include <Eigen/SVD>

namespace tanktread::coupling {

namespace {

Net centred(const Net& x) { return x.rowwise() - x.colwise().mean(); }

/// Returns the rotation Q for which |to - from Q^T| is least; both are centred, a row per point.
Mat3 best_rotation(const Net& from, const Net& to) {
  const Eigen::JacobiSVD<Mat3> svd(Mat3(to.transpose() * from), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs = Vec3::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs[2] = -1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

Corotation::Corotation(std::span<const Particle> particles, const Net& from, const Net& to) {
  for (const Particle& particle : particles) {
    blocks_.push_back(particle.block);
    rotations_.push_back(best_rotation(centred(particle.block.rows(from)), centred(particle.block.rows(to))));
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
    const Net before = centred(particle.block.rows(from)), after = centred(particle.block.rows(to));
    particle.block.rows(difference) = after - before * best_rotation(before, after).transpose();
  }
  return difference;
}

}  // namespace tanktread::coupling
