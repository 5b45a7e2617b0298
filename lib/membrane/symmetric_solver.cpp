#include "membrane/symmetric_solver.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tanktread::membrane {

SymmetricSolver::SymmetricSolver(const DirectSolverOptions& options, surface::Symmetry symmetry)
    : symmetry_(std::move(symmetry)), whole_(options) {
  if (symmetry_.order() == 1) return;
  const Net& signs = symmetry_.signs();
  for (int c = 0; c < 3; ++c) {
    const auto same = std::ranges::find_if(parts_, [&](const Part& p) { return signs.col(p.components.front()) == signs.col(c); });
    if (same == parts_.end())
      parts_.push_back(part(options, c));
    else
      same->components.push_back(c);
  }
}

SymmetricSolver::Part SymmetricSolver::part(const DirectSolverOptions& options, int component) const {
  Part part{{component}, {}, {}, {}, DirectSolver(options)};
  std::vector<int> number(symmetry_.source().size(), -1);
  for (const int a : symmetry_.fundamental())
    if (symmetry_.signs()(a, component) != 0) {
      number[static_cast<std::size_t>(a)] = static_cast<int>(part.points.size());
      part.points.push_back(a);
    }
  part.images.setZero(static_cast<Eigen::Index>(part.points.size()));
  for (const int a : symmetry_.source()) {
    part.unknown.push_back(number[static_cast<std::size_t>(a)]);
    if (part.unknown.back() >= 0) ++part.images[part.unknown.back()];
  }
  return part;
}

void SymmetricSolver::factor(const Eigen::SparseMatrix<double>& a) {
  if (parts_.empty()) return whole_.factor(a);
  for (Part& part : parts_) {
    const int c = part.components.front(), n = static_cast<int>(part.points.size());
    std::vector<int> row(part.unknown.size(), -1);
    for (int i = 0; i < n; ++i) row[static_cast<std::size_t>(part.points[static_cast<std::size_t>(i)])] = i;
    std::vector<Eigen::Triplet<double>> entries;
    for (int b = 0; b < a.outerSize(); ++b) {
      const int column = part.unknown[static_cast<std::size_t>(b)];
      if (column < 0) continue;
      for (Eigen::SparseMatrix<double>::InnerIterator entry(a, b); entry; ++entry)
        if (const int i = row[static_cast<std::size_t>(entry.row())]; i >= 0)
          entries.emplace_back(i, column, part.images[i] * symmetry_.signs()(b, c) * entry.value());
    }
    Eigen::SparseMatrix<double> reduced(n, n);
    reduced.setFromTriplets(entries.begin(), entries.end());
    part.solver.factor(reduced);
  }
}

std::vector<int> SymmetricSolver::components() const {
  if (parts_.empty()) return {0, 1, 2};
  std::vector<int> all;
  for (const Part& part : parts_) all.insert(all.end(), part.components.begin(), part.components.end());
  return all;
}

Net SymmetricSolver::solve(const Net& b) const {
  constexpr int all[] = {0, 1, 2};
  return solve(b, all);
}

Net SymmetricSolver::solve(const Net& b, std::span<const int> components) const {
  const auto asked = [&](int c) { return std::ranges::find(components, c) != components.end(); };
  Net x = Net::Zero(b.rows(), 3);
  if (parts_.empty() && !components.empty()) {
    RightHandSides some = b(Eigen::all, components);
    whole_.solve(some, some);
    x(Eigen::all, components) = some;
  }
  for (const Part& part : parts_) {
    std::vector<int> mine;
    std::ranges::copy_if(part.components, std::back_inserter(mine), asked);
    if (mine.empty()) continue;
    RightHandSides some = part.images.asDiagonal() * b(part.points, mine);
    part.solver.solve(some, some);
    for (std::size_t k = 0; k < mine.size(); ++k)
      for (Eigen::Index a = 0; a < x.rows(); ++a)
        if (const int i = part.unknown[static_cast<std::size_t>(a)]; i >= 0)
          x(a, mine[k]) = symmetry_.signs()(a, mine[k]) * some(i, static_cast<Eigen::Index>(k));
  }
  return x;
}

}  // namespace tanktread::membrane
