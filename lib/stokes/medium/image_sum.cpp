#include "stokes/medium/image_sum.hpp"

#include <utility>

#include "base/indices.hpp"
#include "stokes/kernels/image_kernel.hpp"
#include "stokes/sums/far_sums.hpp"

namespace tanktread::stokes {

ImageSum::ImageSum(Kind kind, const PlaneWall& wall, std::optional<double> tolerance) : kind_(kind), wall_(wall) {
  if (tolerance) tree_.emplace(*tolerance);
}

void ImageSum::share(int part, int parts) {
  if (tree_) tree_->share(part, parts);
  placed_ = false;
}

void ImageSum::set_sources(const std::vector<double> (&node)[3]) {
  for (auto& component : node_) component.resize(node[0].size());
  for (std::size_t k = 0; k < node[0].size(); ++k) {
    const Vec3 x = wall_.in_axes({node[0][k], node[1][k], node[2][k]});
    for (int c = 0; c < 3; ++c) node_[c][k] = x[c];
  }
  placed_ = false;
}

bool ImageSum::want(std::vector<Vec3> targets, std::vector<int> wanted) {
  if (placed_ && targets == targets_ && wanted == wanted_) return false;
  placed_ = true;
  targets_ = std::move(targets), wanted_ = std::move(wanted);
  if (!tree_) return true;
  std::vector<Vec3> at;
  for (const Vec3& x : targets_) at.push_back(below(x));
  tree_->set_sources(node_, indices(node_[0].size() + 1), at);
  tree_->want(wanted_);
  return true;
}

/// Rotates the source strengths into the wall's axes.
void ImageSum::turn(const Charges& strengths, std::vector<double> (&own)[6]) const {
  const Mat3& axes = wall_.axes();
  const int in = kind_ == Kind::forces ? 3 : 6;
  const auto& q = strengths.q;
  for (int c = 0; c < in; ++c) own[c].resize(static_cast<std::size_t>(strengths.n));
  for (int k = 0; k < strengths.n; ++k) {
    if (kind_ == Kind::forces) {
      const Vec3 f = axes * Vec3(q[0][k], q[1][k], q[2][k]);
      for (int c = 0; c < 3; ++c) own[c][k] = f[c];
    } else {
      Mat3 s;
      s << q[0][k], q[3][k], q[4][k], q[3][k], q[1][k], q[5][k], q[4][k], q[5][k], q[2][k];
      s = axes * s * axes.transpose();
      for (int c = 0; c < 6; ++c) own[c][k] = s(stresses[c][0], stresses[c][1]);
    }
  }
}

Net ImageSum::sum(std::span<const std::vector<double>> strengths) {
  std::vector<double> own[6];
  turn(charges(node_, strengths), own);
  const Charges sources = charges(node_, own);
  Net sums(wanted_.size(), 3);
  if (tree_) {
    Net all = Net::Zero(static_cast<Eigen::Index>(targets_.size()), 3);
    kind_ == Kind::forces ? tree_->sum<ImageStokesletKernel>(sources.q, all.data()) : tree_->sum<ImageStressletKernel>(sources.q, all.data());
    sums = all(wanted_, Eigen::all);
    interactions_ = tree_->interactions();
  } else {
    std::vector<Vec3> at;
    for (const int i : wanted_) at.push_back(below(targets_[static_cast<std::size_t>(i)]));
    kernel_sums(kernel(), sources, at, sums.data());
    interactions_ = static_cast<long long>(sources.n) * sums.rows();
  }
  return sums * wall_.axes();
}

KernelSum ImageSum::kernel() const { return kind_ == Kind::forces ? image_stokeslet_sum : image_stresslet_sum; }

Vec3 ImageSum::sum(const Charges& strengths, int first, const Vec3& target) const {
  std::vector<double> own[6];
  turn(strengths, own);
  Charges sources = charges(node_, own);
  sources.n = strengths.n, sources.x += first, sources.y += first, sources.z += first;
  const Vec3 at = below(target);
  Vec3 value;
  kernel_sums(kernel(), sources, {&at, 1}, value.data());
  return wall_.axes().transpose() * value;
}

}  // namespace tanktread::stokes
