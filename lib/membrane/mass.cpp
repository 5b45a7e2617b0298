#include "membrane/mass.hpp"

#include <algorithm>

#include "base/indices.hpp"
#include "membrane/points_kernel.hpp"
#include "spline/sparse_systems.hpp"

namespace tanktread::membrane {
namespace {

int pairs(const Batch& batch) { return batch.functions * (batch.functions + 1) / 2; }

/// Returns a sparse matrix that stores an explicit zero for every pair of functions that share an element: the sparsity pattern of the mass matrix.
Eigen::SparseMatrix<double> pattern(const spline::Space& space) {
  const Eigen::MatrixXd zeros = Eigen::MatrixXd::Zero(spline::most_functions, spline::most_functions);
  std::vector<spline::LocalMatrix> local;
  for (const spline::Element& element : space.elements) local.push_back({element.points, &zeros});
  return spline::assemble(space.n_points, local);
}

/// Returns the index at which the basis-function values of a batch begin in the array values_[k] of its group k.
std::size_t values_of(const Group& g, const Batch& batch) {
  return batch.extraction / static_cast<std::size_t>(g.n_bernstein()) * static_cast<std::size_t>(g.n_gauss());
}

std::vector<Pack> values_at_gauss_points(const Group& g) {
  const int p = g.degree + 1, n_b = g.n_bernstein(), lanes = pack_lanes();
  std::vector<Pack> values(g.extraction.size() / static_cast<std::size_t>(n_b) * static_cast<std::size_t>(g.n_gauss()));
  for (const Batch& batch : g.batches) {
    const double* const extraction = numbers(&g.extraction[batch.extraction]);
    Pack* const first = &values[values_of(g, batch)];
    std::fill_n(first, batch.functions * g.n_gauss(), Pack{});
    for (int a = 0; a < batch.functions; ++a)
      for (int q = 0; q < g.n_gauss(); ++q) {
        const double *bs = &g.value[q % g.order * p], *bt = &g.value[q / g.order * p];
        double* const sum = numbers(first) + lanes * (a * g.n_gauss() + q);
        for (int b = 0; b < n_b; ++b)
          for (int l = 0; l < lanes; ++l) sum[l] += extraction[lanes * (a * n_b + b) + l] * (bs[b % p] * bt[b / p]);
      }
  }
  return values;
}

/// Returns the positions of the entries (a, b) and (b, a) in the value array of the sparse matrix, for each pair a, b of basis functions of the
/// element in each SIMD lane. If an element has fewer functions than its batch, the missing pairs get position 0; their values are zero.
std::vector<int> slots_of(const Group& g, const Eigen::SparseMatrix<double>& matrix, const spline::Space& space) {
  const int *start = matrix.outerIndexPtr(), *row = matrix.innerIndexPtr();
  const auto slot = [&](int a, int b) { return static_cast<int>(std::lower_bound(row + start[b], row + start[b + 1], a) - row); };
  const int lanes = pack_lanes();
  std::vector<int> slots;
  for (const Batch& batch : g.batches) {
    const std::size_t first = slots.size();
    slots.resize(first + 2 * pairs(batch) * lanes, 0);
    for (int l = 0; l < lanes; ++l) {
      const std::vector<int>& points = space.elements[batch.elements[l]].points;
      int* out = &slots[first + l];
      for (std::size_t a = 0; a < points.size(); ++a)
        for (std::size_t b = 0; b <= a; ++b, out += 2 * lanes) {
          out[0] = slot(points[a], points[b]);
          out[lanes] = slot(points[b], points[a]);
        }
    }
  }
  return slots;
}

}  // namespace

MassMatrix::MassMatrix(const spline::Space& space, int order) : space_(&space), groups_(pack(space, indices(space.elements.size()), order)) {
  for (const Group& g : groups_) values_.push_back(values_at_gauss_points(g));
}

Eigen::VectorXd MassMatrix::row_sums(const Net& x) const {
  Pack a[6 * max_gauss], area[max_gauss];
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(x.rows());
  const int lanes = pack_lanes();
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const Group& g = groups_[k];
    for (const Batch& batch : g.batches) {
      tangents(g, batch, x, a);
      area_weights(g.n_gauss(), a, g.weight.data(), area);
      const double *weight = numbers(area), *value = numbers(&values_[k][values_of(g, batch)]);
      for (int l = 0; l < batch.used; ++l)
        for (int i = 0; i < batch.functions; ++i) {
          double sum = 0;
          for (int q = 0; q < g.n_gauss(); ++q) sum += value[lanes * (i * g.n_gauss() + q) + l] * weight[lanes * q + l];
          sums[g.points[batch.points + static_cast<std::size_t>(lanes * i + l)]] += sum;
        }
    }
  }
  return sums;
}

void MassMatrix::release() {
  slots_.clear();
  updated_.resize(0, 3);
  Eigen::SparseMatrix<double>().swap(matrix_);
}

const Eigen::SparseMatrix<double>& MassMatrix::update(const Net& x) {
  if (same(updated_, x)) return matrix_;
  updated_ = x;
  if (slots_.empty()) {
    matrix_ = pattern(*space_);
    for (const Group& g : groups_) slots_.push_back(slots_of(g, matrix_, *space_));
  }
  Pack a[6 * max_gauss], area[max_gauss], entries[spline::most_functions * (spline::most_functions + 1) / 2];
  double* const out = matrix_.valuePtr();
  const int lanes = pack_lanes();
  std::fill_n(out, matrix_.nonZeros(), 0.);
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const Group& g = groups_[k];
    const int* slots = slots_[k].data();
    for (const Batch& batch : g.batches) {
      tangents(g, batch, x, a);
      area_weights(g.n_gauss(), a, g.weight.data(), area);
      mass_entries(batch.functions, g.n_gauss(), &values_[k][values_of(g, batch)], area, entries);
      int pair = 0;
      for (int i = 0; i < batch.functions; ++i)
        for (int j = 0; j <= i; ++j, ++pair)
          for (int l = 0; l < batch.used; ++l) {
            out[slots[2 * pair * lanes + l]] += numbers(entries)[lanes * pair + l];
            if (i != j) out[slots[(2 * pair + 1) * lanes + l]] += numbers(entries)[lanes * pair + l];
          }
      slots += 2 * pairs(batch) * lanes;
    }
  }
  return matrix_;
}

}  // namespace tanktread::membrane
