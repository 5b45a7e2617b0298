#include "membrane/mass.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "membrane/points_kernel.hpp"

namespace tanktread::membrane {
namespace {

std::vector<int> everything(const spline::Space& space) {
  std::vector<int> all(space.elements.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

int pairs(const Batch& batch) { return batch.functions * (batch.functions + 1) / 2; }

/// Zeros where two functions meet on an element.
Eigen::SparseMatrix<double> pattern(const spline::Space& space) {
  const int n = space.n_points;
  std::vector<std::vector<int>> around(static_cast<std::size_t>(n));
  for (std::size_t e = 0; e < space.elements.size(); ++e)
    for (const int a : space.elements[e].points) around[a].push_back(static_cast<int>(e));
  std::vector<int> met(static_cast<std::size_t>(n), -1);
  const auto each_neighbour = [&](int a, int mark, const auto& act) {
    for (const int e : around[a])
      for (const int b : space.elements[e].points)
        if (std::exchange(met[b], mark) != mark) act(b);
  };
  Eigen::SparseMatrix<double> matrix(n, n);
  int* const start = matrix.outerIndexPtr();
  for (int a = 0; a < n; ++a) {
    start[a + 1] = start[a];
    each_neighbour(a, a, [&](int) { ++start[a + 1]; });
  }
  matrix.resizeNonZeros(start[n]);
  std::fill_n(matrix.valuePtr(), start[n], 0.);
  std::vector<int> next(start, start + n);
  for (int a = 0; a < n; ++a) each_neighbour(a, n + a, [&](int b) { matrix.innerIndexPtr()[next[b]++] = a; });  // column b: row by row, ascending
  return matrix;
}

/// Where the matrix keeps the entries of an element's functions a, b: [functions a + b]. `row`: as many integers as the matrix has rows.
std::vector<int> slots_of(const std::vector<int>& points, const Eigen::SparseMatrix<double>& matrix, std::vector<int>& row) {
  const std::size_t n = points.size();
  std::vector<int> slots(n * n);
  for (std::size_t b = 0; b < n; ++b) {
    for (int k = matrix.outerIndexPtr()[points[b]]; k < matrix.outerIndexPtr()[points[b] + 1]; ++k) row[matrix.innerIndexPtr()[k]] = k;
    for (std::size_t a = 0; a < n; ++a) slots[n * a + b] = row[points[a]];
  }
  return slots;
}

std::vector<Pack> values_at_gauss_points(const Group& g) {
  std::size_t n = 0;
  for (const Batch& batch : g.batches) n += static_cast<std::size_t>(batch.functions * g.n_gauss());
  std::vector<Pack> values(n);
  const int p = g.degree + 1, n_b = g.n_bernstein();
  const int lanes = pack_lanes();
  std::size_t first = 0;
  for (const Batch& batch : g.batches) {
    const double* const extraction = numbers(&g.extraction[batch.extraction]);
    for (int a = 0; a < batch.functions; ++a)
      for (int q = 0; q < g.n_gauss(); ++q) {
        const double *bs = &g.value[q % g.order * p], *bt = &g.value[q / g.order * p];
        double* const sum = numbers(&values[first]) + lanes * (a * g.n_gauss() + q);
        for (int b = 0; b < n_b; ++b)
          for (int l = 0; l < lanes; ++l) sum[l] += extraction[lanes * (a * n_b + b) + l] * (bs[b % p] * bt[b / p]);
      }
    first += static_cast<std::size_t>(batch.functions * g.n_gauss());
  }
  return values;
}

// Functions that an element lacks share slot 0 and add zero to it.
std::vector<int> slots_of(const Group& g, const Eigen::SparseMatrix<double>& matrix, const spline::Space& space) {
  const int lanes = pack_lanes();
  std::size_t size = 0;
  for (const Batch& batch : g.batches) size += static_cast<std::size_t>(2 * pairs(batch) * lanes);
  std::vector<int> slots(size), row(static_cast<std::size_t>(matrix.rows()));
  int* out = slots.data();
  for (const Batch& batch : g.batches) {
    for (int l = 0; l < lanes; ++l) {
      const std::vector<int>& points = space.elements[batch.elements[l]].points;
      const std::vector<int> mine = slots_of(points, matrix, row);
      const int n = static_cast<int>(points.size());
      for (int a = 0, pair = 0; a < n; ++a)
        for (int b = 0; b <= a; ++b, ++pair) {
          out[2 * pair * lanes + l] = mine[n * a + b];
          out[(2 * pair + 1) * lanes + l] = mine[n * b + a];
        }
    }
    out += 2 * pairs(batch) * lanes;
  }
  return slots;
}

}  // namespace

MassMatrix::MassMatrix(const spline::Space& space, int order) : groups_(pack(space, everything(space), order)), matrix_(pattern(space)) {
  for (const Group& g : groups_) {
    values_.push_back(values_at_gauss_points(g));
    slots_.push_back(slots_of(g, matrix_, space));
  }
}

const Eigen::SparseMatrix<double>& MassMatrix::update(const Net& x) {
  Pack a[6 * max_order * max_order], area[max_order * max_order], entries[max_functions * (max_functions + 1) / 2];
  double* const out = matrix_.valuePtr();
  const int lanes = pack_lanes();
  std::fill_n(out, matrix_.nonZeros(), 0.);
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const Group& g = groups_[k];
    const Pack* values = values_[k].data();
    const int* slots = slots_[k].data();
    for (const Batch& batch : g.batches) {
      tangents(g, batch, x, a);
      area_weights(g.n_gauss(), a, g.weight.data(), area);
      mass_entries(batch.functions, g.n_gauss(), values, area, entries);
      int pair = 0;
      for (int i = 0; i < batch.functions; ++i)
        for (int j = 0; j <= i; ++j, ++pair)
          for (int l = 0; l < batch.used; ++l) {
            out[slots[2 * pair * lanes + l]] += numbers(entries)[lanes * pair + l];
            if (i != j) out[slots[(2 * pair + 1) * lanes + l]] += numbers(entries)[lanes * pair + l];
          }
      values += batch.functions * g.n_gauss();
      slots += 2 * pairs(batch) * lanes;
    }
  }
  return matrix_;
}

}  // namespace tanktread::membrane
