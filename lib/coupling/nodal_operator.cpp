#include "coupling/nodal_operator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tanktread::coupling {

namespace {

constexpr double factor = 1 / (8 * std::numbers::pi);
constexpr int upper[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};

Mat3 stokeslet(const Vec3& r) {
  const double square = r.squaredNorm(), inverse = square > 0 ? 1 / std::sqrt(square) : 0;
  return inverse * Mat3::Identity() + inverse * inverse * inverse * r * r.transpose();
}

using ByRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

ByRows rows_of(const ByRows& matrix, const std::vector<int>& wanted) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < wanted.size(); ++k)
    for (ByRows::InnerIterator entry(matrix, wanted[k]); entry; ++entry)
      entries.emplace_back(static_cast<int>(k), static_cast<int>(entry.col()), entry.value());
  ByRows rows(static_cast<Eigen::Index>(wanted.size()), matrix.cols());
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

}  // namespace

void NodalOperator::assemble(const std::vector<int>& targets, const Surface& surface, double reach, const Assemble& assemble) {
  constexpr std::size_t at_a_time = 64;
  targets_ = targets;
  const Eigen::Index n = surface.sites.rows(), padded = (n + nodal_tile - 1) / nodal_tile * nodal_tile;
  symmetry_ = surface.symmetry.fundamental().empty() ? surface::Symmetry(static_cast<int>(n)) : surface.symmetry;
  values_ = rows_of(surface.values, symmetry_.fundamental());
  row_.clear();
  const std::vector<int>& fundamental = symmetry_.fundamental();
  for (const int source : symmetry_.source())
    row_.push_back(static_cast<int>(std::ranges::lower_bound(fundamental, source) - fundamental.begin()));
  weights_ = factor * surface.weights;
  for (int c = 0; c < 3; ++c) {
    node_[c].assign(static_cast<std::size_t>(padded), 0);
    force_[c].assign(static_cast<std::size_t>(padded), 0);
    for (Eigen::Index b = 0; b < n; ++b) node_[c][static_cast<std::size_t>(b)] = surface.sites(b, c);
  }
  blocks_.clear();
  first_block_.assign(1, 0);
  stokes::Rows<double> rows;
  for (std::size_t first = 0; first < targets.size(); first += at_a_time) {
    const std::span<const int> some(targets.data() + first, std::min(at_a_time, targets.size() - first));
    assemble(some, rows);
    for (std::size_t k = 0; k < some.size(); ++k) correct(some[k], surface, reach, rows, 3 * static_cast<Eigen::Index>(k));
  }
}

/// K_iC of one target.
void NodalOperator::correct(int target, const Surface& surface, double reach, const stokes::Rows<double>& rows, Eigen::Index row) {
  const Vec3 x0 = surface.sites.row(target).transpose();
  for (int point = 0; point < surface.sites.rows(); ++point) {
    if ((surface.sites.row(point).transpose() - x0).squaredNorm() > reach * reach * surface.areas[point]) continue;
    Mat3 rule = Mat3::Zero();
    for (Eigen::SparseMatrix<double>::InnerIterator entry(surface.values, point); entry; ++entry)
      rule += weights_[entry.row()] * entry.value() * stokeslet(surface.sites.row(entry.row()).transpose() - x0);
    Block block{point, {}};
    for (int c = 0; c < 6; ++c)
      block.a[c] = rows(row + upper[c][0], 3 * point + upper[c][1]) - rule(upper[c][0], upper[c][1]);
    blocks_.push_back(block);
  }
  first_block_.push_back(blocks_.size());
}

/// w_B (R f)_B at all nodes.
void NodalOperator::spread(const Net& f) const {
  const Net values = values_ * f;
  for (std::size_t b = 0; b < row_.size(); ++b)
    for (int c = 0; c < 3; ++c) {
      const auto node = static_cast<Eigen::Index>(b);
      force_[c][b] = weights_[node] * symmetry_.signs()(node, c) * values(row_[b], c);
    }
}

void NodalOperator::apply(const Net& f, Net& u) const {
  spread(f);
  const double* const node[3] = {node_[0].data(), node_[1].data(), node_[2].data()};
  const double* const force[3] = {force_[0].data(), force_[1].data(), force_[2].data()};
  double x0[3 * nodal_block], sums[3 * nodal_block];
  for (std::size_t first = 0; first < targets_.size(); first += nodal_block) {
    const std::size_t used = std::min<std::size_t>(nodal_block, targets_.size() - first);
    for (std::size_t l = 0; l < nodal_block; ++l)  // idle lanes repeat the last target
      for (int c = 0; c < 3; ++c) x0[3 * l + c] = node_[c][static_cast<std::size_t>(targets_[first + std::min(l, used - 1)])];
    nodal_sum(static_cast<int>(node_[0].size()), node, force, x0, sums);
    for (std::size_t l = 0; l < used; ++l) {
      Vec3 sum(sums[3 * l], sums[3 * l + 1], sums[3 * l + 2]);
      for (std::size_t k = first_block_[first + l]; k < first_block_[first + l + 1]; ++k) {
        const Block& b = blocks_[k];
        const double f1 = f(b.point, 0), f2 = f(b.point, 1), f3 = f(b.point, 2);
        sum += Vec3(b.a[0] * f1 + b.a[1] * f2 + b.a[2] * f3, b.a[1] * f1 + b.a[3] * f2 + b.a[4] * f3, b.a[2] * f1 + b.a[4] * f2 + b.a[5] * f3);
      }
      u.row(targets_[first + l]) = sum.transpose();
    }
  }
}

}  // namespace tanktread::coupling
