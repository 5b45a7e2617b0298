#include "system/frozen/nodal_operator.hpp"

#include <algorithm>

#include "base/indices.hpp"
#include "base/threads.hpp"
#include "stokes/kernels/far_kernel.hpp"
#include "stokes/kernels/kernels.hpp"
#include "stokes/sums/far_sums.hpp"
#include "stokes/sums/vicinity.hpp"
#include "system/parallel/stop_together.hpp"
#include "system/solvers/options.hpp"

namespace tanktread::coupling {

namespace {

/// Tolerance of the treecode: a tenth of the error of the trapezoidal rule. Chosen from measurements on capsules in shear flow.
constexpr double cluster_tolerance = 1e-3;

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

void NodalOperator::assemble(const std::vector<int>& targets, const Surface& surface, double reach, const std::string& far_sum,
                             const Assemble& assemble) {
  targets_ = targets;
  at_.clear();
  for (const int i : targets) at_.emplace_back(surface.sites.row(i).transpose());
  const Eigen::Index n = surface.sites.rows();
  symmetry_ = surface.symmetry.fundamental().empty() ? surface::Symmetry(static_cast<int>(n)) : surface.symmetry;
  const std::vector<int>& fundamental = symmetry_.fundamental();
  values_ = rows_of(surface.values, fundamental);
  row_.clear();
  for (const int source : symmetry_.source())
    row_.push_back(static_cast<int>(std::ranges::lower_bound(fundamental, source) - fundamental.begin()));
  weights_ = stokes::over_8_pi * surface.weights;
  for (int c = 0; c < 3; ++c) {
    node_[c].assign(surface.sites.col(c).begin(), surface.sites.col(c).end());
    force_[c].resize(static_cast<std::size_t>(n));
  }
  find_near(surface, reach);
  stop_together([&] { assemble(targets_, near_, entries_); });
  subtract_rule(surface);
  tree_.reset();
  if (far_sum == "dense" || (far_sum == "auto" && n < SolverOptions::nodes_worth_a_tree)) return;
  tree_.emplace(cluster_tolerance);
  std::vector<Vec3> at;
  for (const auto site : surface.sites.rowwise()) at.emplace_back(site.transpose());
  tree_->set_sources(node_, indices(n + 1), at);
  tree_->share(part_, parts_);
  tree_->want(parts_ > 1 ? everybody_ : targets_);
}

void NodalOperator::share(int part, int parts, std::vector<int> everybody) {
  part_ = part, parts_ = parts;
  everybody_ = std::move(everybody);
}

void NodalOperator::find_near(const Surface& surface, double reach) {
  const Eigen::VectorXd square = reach * reach * surface.areas;
  stokes::Vicinity vicinity;
  vicinity.set_points(static_cast<int>(square.size()), node_[0].data(), node_[1].data(), node_[2].data(), square.data());
  near_ = {};
  for (const Vec3& x0 : at_) {
    vicinity.list(x0.data(), near_.point);
    std::sort(near_.point.begin() + static_cast<std::ptrdiff_t>(near_.first.back()), near_.point.end());
    near_.first.push_back(near_.point.size());
  }
}

/// Computes the blocks K_iC of (4.11) for near control points: subtracts the terms of the trapezoidal rule from the assembled blocks of the single
/// layer A.
void NodalOperator::subtract_rule(const Surface& surface) {
  each_item(targets_.size(), [&](std::size_t k) {
    for (std::size_t j = near_.first[k]; j < near_.first[k + 1]; ++j) {
      Mat3 rule = Mat3::Zero();
      for (Eigen::SparseMatrix<double>::InnerIterator entry(surface.values, near_.point[j]); entry; ++entry)
        rule += weights_[entry.row()] * entry.value() * stokes::stokeslet(surface.sites.row(entry.row()).transpose() - at_[k]);
      for (std::size_t c = 0; c < 6; ++c) entries_[6 * j + c] -= rule(stokes::upper[c][0], stokes::upper[c][1]);
    }
  });
}

/// Computes the point forces w_B (R f)_B of the trapezoidal rule (4.11), weight times density f, at all nodes.
void NodalOperator::spread(const Net& f) {
  constexpr Eigen::Index rows_at_a_time = 128;
  Net values(values_.rows(), 3);
  each_block(values_.rows(), rows_at_a_time, [&](Eigen::Index first, Eigen::Index last) {
    for (Eigen::Index k = first; k < last; ++k) {
      Vec3 sum = Vec3::Zero();
      for (ByRows::InnerIterator entry(values_, k); entry; ++entry) sum += entry.value() * f.row(entry.col()).transpose();
      values.row(k) = sum.transpose();
    }
  });
  for (std::size_t b = 0; b < row_.size(); ++b)
    for (int c = 0; c < 3; ++c) {
      const auto node = static_cast<Eigen::Index>(b);
      force_[c][b] = weights_[node] * symmetry_.signs()(node, c) * values(row_[b], c);
    }
}

/// Computes the sum of the trapezoidal rule in (4.11) at the rank-owned targets. If ranks share the sums, computes this rank's part of the sums at
/// all points.
void NodalOperator::sum(Net& u) {
  if (tree_) {
    std::vector<double> rows(3 * node_[0].size());
    tree_->sum<stokes::StokesletKernel>({force_[0].data(), force_[1].data(), force_[2].data()}, rows.data());
    for (const int i : shared() ? everybody_ : targets_) u.row(i) = Vec3(&rows[3 * static_cast<std::size_t>(i)]).transpose();
    return;
  }
  std::vector<double> sums(3 * targets_.size());
  stokes::far_sums(stokes::charges(node_, force_), at_, sums.data());
  for (std::size_t k = 0; k < targets_.size(); ++k) u.row(targets_[k]) = Vec3(&sums[3 * k]).transpose();
}

void NodalOperator::apply(const Net& f, Net& u) {
  spread(f);
  sum(u);
  constexpr std::size_t targets_at_a_time = 128;
  each_block(targets_.size(), targets_at_a_time, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      Vec3 row = Vec3::Zero();
      for (std::size_t j = near_.first[k]; j < near_.first[k + 1]; ++j) {
        const double* a = &entries_[6 * j];
        const double f1 = f(near_.point[j], 0), f2 = f(near_.point[j], 1), f3 = f(near_.point[j], 2);
        row += Vec3(a[0] * f1 + a[1] * f2 + a[2] * f3, a[1] * f1 + a[3] * f2 + a[4] * f3, a[2] * f1 + a[4] * f2 + a[5] * f3);
      }
      u.row(targets_[k]) += row.transpose();
    }
  });
}

}  // namespace tanktread::coupling
