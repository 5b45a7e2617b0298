#include "stokes/medium/image_sum.hpp"

#include <numeric>
#include <utility>

#include "stokes/kernels/image_kernel.hpp"

namespace tanktread::stokes {

namespace {

Charges charges_of(int n, const std::vector<double>* node, const std::vector<double>* carried) {
  Charges charges{n, node[0].data(), node[1].data(), node[2].data(), {}};
  for (int c = 0; c < 6; ++c) charges.q[static_cast<std::size_t>(c)] = carried[c].data();
  return charges;
}

}  // namespace

ImageSum::ImageSum(Kind kind, const PlaneWall& wall, std::optional<double> tolerance) : kind_(kind), wall_(wall) {
  if (tolerance) tree_.emplace(*tolerance);
}

void ImageSum::share(int part, int parts) {
  if (tree_) tree_->share(part, parts);
  placed_ = false;
}

void ImageSum::place(const std::vector<double> (&node)[3]) {
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
  std::vector<int> singles(node_[0].size() + 1);
  std::iota(singles.begin(), singles.end(), 0);
  tree_->place(node_[0].data(), node_[1].data(), node_[2].data(), singles, at);
  tree_->want(wanted_);
  return true;
}

/// Rotates the source strengths into the wall's axes.
void ImageSum::turn(const Charges& carried, std::vector<double> (&own)[6]) const {
  const Mat3& axes = wall_.axes();
  const int in = kind_ == Kind::forces ? 3 : 6;
  const auto& q = carried.q;
  for (int c = 0; c < in; ++c) own[c].resize(static_cast<std::size_t>(carried.n));
  for (int k = 0; k < carried.n; ++k) {
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

Net ImageSum::sum(std::span<const std::vector<double>> carried) {
  const int n = static_cast<int>(node_[0].size());
  std::vector<double> own[6];
  Charges in_space{n, nullptr, nullptr, nullptr, {}};
  for (std::size_t c = 0; c < carried.size(); ++c) in_space.q[c] = carried[c].data();
  turn(in_space, own);
  Net sums(wanted_.size(), 3);
  if (tree_)
    sum_by_clusters(charges_of(n, node_, own), sums);
  else
    sum_all(charges_of(n, node_, own), sums);
  interactions_ = tree_ ? tree_->interactions() : static_cast<long long>(n) * sums.rows();
  return sums * wall_.axes();
}

void ImageSum::sum_by_clusters(const Charges& charges, Net& sums) {
  Net all = Net::Zero(static_cast<Eigen::Index>(targets_.size()), 3);
  if (kind_ == Kind::forces)
    tree_->sum<ImageStokesletKernel>(charges.q, all.data());
  else
    tree_->sum<ImageStressletKernel>(charges.q, all.data());
  for (std::size_t k = 0; k < wanted_.size(); ++k) sums.row(static_cast<Eigen::Index>(k)) = all.row(wanted_[k]);
}

KernelSum ImageSum::kernel() const { return kind_ == Kind::forces ? image_stokeslet_sum : image_stresslet_sum; }

void ImageSum::sum_all(const Charges& charges, Net& sums) const {
  std::vector<Vec3> at;
  for (const int i : wanted_) at.push_back(below(targets_[static_cast<std::size_t>(i)]));
  kernel_sums(kernel(), charges, at, sums.data());
}

Vec3 ImageSum::sum(const Charges& carried, int first, const Vec3& target) const {
  std::vector<double> own[6];
  turn(carried, own);
  Charges charges = charges_of(carried.n, node_, own);
  charges.x += first, charges.y += first, charges.z += first;
  const Vec3 at = below(target);
  Vec3 value;
  kernel_sums(kernel(), charges, {&at, 1}, value.data());
  return wall_.axes().transpose() * value;
}

}  // namespace tanktread::stokes
