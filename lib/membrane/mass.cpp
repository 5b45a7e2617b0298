#include "membrane/mass.hpp"

#include <algorithm>
#include <numeric>

namespace tanktread::membrane {
namespace {

std::vector<int> everything(const spline::Space& space) {
  std::vector<int> all(space.elements.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

int pairs(const Batch& batch) { return batch.functions * (batch.functions + 1) / 2; }

Eigen::SparseMatrix<double> pattern(const spline::Space& space) {
  std::size_t n = 0;
  for (const spline::Element& e : space.elements) n += e.points.size() * e.points.size();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(n);
  for (const spline::Element& e : space.elements)
    for (int a : e.points)
      for (int b : e.points) entries.emplace_back(a, b, 0.);
  Eigen::SparseMatrix<double> matrix(space.n_points, space.n_points);
  matrix.setFromTriplets(entries.begin(), entries.end());
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
  std::vector<Pack> values;
  values.reserve(n);
  const int p = g.degree + 1;
  for (const Batch& batch : g.batches)
    for (int a = 0; a < batch.functions; ++a)
      for (int q = 0; q < g.n_gauss(); ++q) {
        const double *bs = &g.value[q % g.order * p], *bt = &g.value[q / g.order * p];
        Pack sum{};
        for (int b = 0; b < g.n_bernstein(); ++b) sum += g.extraction[batch.extraction + a * g.n_bernstein() + b] * (bs[b % p] * bt[b / p]);
        values.push_back(sum);
      }
  return values;
}

// Functions that an element lacks share slot 0 and add zero to it.
std::vector<int> slots_of(const Group& g, const Eigen::SparseMatrix<double>& matrix, const spline::Space& space) {
  std::vector<int> slots, row(static_cast<std::size_t>(matrix.rows()));
  for (const Batch& batch : g.batches) {
    std::vector<std::vector<int>> of_lane;
    for (const int element : batch.elements) of_lane.push_back(slots_of(space.elements[element].points, matrix, row));
    for (int a = 0; a < batch.functions; ++a)
      for (int b = 0; b <= a; ++b)
        for (bool transposed : {false, true})
          for (std::size_t l = 0; l < of_lane.size(); ++l) {
            const int n = static_cast<int>(space.elements[batch.elements[l]].points.size());
            slots.push_back(a >= n ? 0 : of_lane[l][transposed ? n * b + a : n * a + b]);
          }
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
            out[slots[2 * pair * lanes + l]] += entries[pair][l];
            if (i != j) out[slots[(2 * pair + 1) * lanes + l]] += entries[pair][l];
          }
      values += batch.functions * g.n_gauss();
      slots += 2 * pairs(batch) * lanes;
    }
  }
  return matrix_;
}

}  // namespace tanktread::membrane
