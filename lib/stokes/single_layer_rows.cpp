// The assembled single layer: the same rules as apply(), with moments of the basis functions in the place of a density.

#include <algorithm>
#include <numbers>

#include "stokes/pair_kernel.hpp"
#include "stokes/single_layer.hpp"

namespace tanktread::stokes {
namespace {

constexpr int block = assembly_block;

/// Basis functions of every panel at its far nodes, padded to whole tiles; padded functions add to a row of their own.
template <class Real>
struct FarBasis {
  std::vector<Real> values;
  std::vector<int> rows;
  std::vector<std::size_t> first_value, first_row;

  FarBasis(const Panels& panels, int spare_row) {
    for (int e = 0; e < panels.size(); ++e) {
      const NodeTable& t = *panels[e].table;
      const int m = panels[e].functions, padded = (m + assembly_tile - 1) / assembly_tile * assembly_tile;
      first_value.push_back(values.size());
      first_row.push_back(rows.size());
      const Eigen::Map<const Rows<double>> extraction(panels.extraction(e), m, t.n_bernstein),
          table(t.value.data(), t.n_bernstein, t.n_nodes);
      const Rows<double> basis = extraction * table;
      for (int a = 0; a < padded; ++a) {
        rows.push_back(a < m ? panels.points(e)[a] : spare_row);
        for (int k = 0; k < t.n_nodes; ++k) values.push_back(a < m ? static_cast<Real>(basis(a, k)) : Real(0));
      }
    }
  }
};

/// Rows 3 (first + l) .. of the operator from the sums G_11, G_12, G_13, G_22, G_23, G_33 of target l with every control point.
template <class Real>
void write_rows(int first, int used, int n_points, const Real* sums, Rows<Real>& a) {
  constexpr int entry[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  const Real scale = static_cast<Real>(1 / (8 * std::numbers::pi));
  for (int l = 0; l < used; ++l)
    for (int i = 0; i < 3; ++i) {
      Real* row = &a(3 * (first + l) + i, 0);
      const Real* from = sums + l;
      for (int p = 0; p < n_points; ++p, from += 6 * block, row += 3)
        for (int j = 0; j < 3; ++j) row[j] = scale * from[block * entry[3 * i + j]];
    }
}

}  // namespace

template <class Real>
void SingleLayer::add_own_rules(int target, const Vec3& at, Measure measure, Real* sums) {
  const auto add = [&](int e, const PointTable& table, const Pack* weights) {
    const Panel& panel = panels_[e];
    const int n_b = panel.table->n_bernstein;
    scratch_.resize(static_cast<std::size_t>(6) * table.packs());
    moments_.resize(static_cast<std::size_t>(6) * n_b);
    single_moments(table, &bezier_[panel.first_bezier], weights, at.data(), scratch_.data(), moments_.data());
    const Eigen::Map<const Rows<double>> extraction(panels_.extraction(e), panel.functions, n_b);
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> moment(moments_.data(), n_b, 6);
    for (int a = 0; a < panel.functions; ++a) {
      const Eigen::Matrix<double, 1, 6> row = extraction.row(a).lazyProduct(moment);
      Real* to = sums + static_cast<std::ptrdiff_t>(6 * block) * panels_.points(e)[a];
      for (int c = 0; c < 6; ++c) to[block * c] += static_cast<Real>(row[c]);
    }
  };
  list_near(target, at);
  for (const int e : near_) {
    const PointTable& table = near_field_.rule(e, at);
    point_weights_.resize(table.packs());
    area_weights(table, &(*area_)[panels_[e].first_bezier], point_weights_.data());
    add(e, table, point_weights_.data());
    evaluations_.near += table.points;
  }
  for (SelfPair& pair : self_field_[target]) {
    const Pack* weights = self_weights(pair, measure);
    add(pair.panel, *pair.table, weights);
    evaluations_.self += pair.table->points;
  }
}

template <class Real>
void SingleLayer::assemble_rows(const Net& x, Measure measure, std::span<const int> targets, Rows<Real>& a) {
  const auto clock = phases_.time("assembly");
  place(x, measure, targets);
  const int n = static_cast<int>(targets.size());
  a.resize(3 * n, 3 * n_points_);
  const FarBasis<Real> basis(panels_, n_points_);
  std::vector<Real> sums(static_cast<std::size_t>(6) * block * (n_points_ + 1)), kernel;
  std::vector<std::uint32_t> skip(panels_.size());
  double target[3 * block];
  for (int first = 0; first < n; first += block) {
    const int used = std::min(block, n - first);
    std::fill(sums.begin(), sums.end(), Real(0));
    std::fill(skip.begin(), skip.end(), 0u);
    for (int l = 0; l < block; ++l)
      for (int c = 0; c < 3; ++c) target[block * c + l] = at_[std::min(first + l, n - 1)][c];
    for (int l = 0; l < used; ++l) {
      const int i = targets[first + l];
      add_own_rules(i, at_[first + l], measure, &sums[l]);
      for (const int e : near_) skip[e] |= 1u << l;
      for (const SelfPair& pair : self_field_[i]) skip[pair.panel] |= 1u << l;
    }
    for (int e = 0; e < panels_.size(); ++e) {
      const Panel& p = panels_[e];
      const int padded = (p.functions + assembly_tile - 1) / assembly_tile * assembly_tile;
      kernel.resize(static_cast<std::size_t>(6) * block * p.table->n_nodes);
      add_far_moments<Real>({p.table->n_nodes, padded, &node_[0][p.first_node], &node_[1][p.first_node], &node_[2][p.first_node],
                             &(*weight_)[p.first_node], &basis.values[basis.first_value[e]], &basis.rows[basis.first_row[e]]},
                            target, skip[e], kernel.data(), sums.data());
    }
    evaluations_.far += static_cast<long long>(used) * panels_.n_nodes();
    write_rows(first, used, n_points_, sums.data(), a);
  }
}

void SingleLayer::assemble(const Net& x, Measure measure, std::span<const int> targets, Rows<float>& a) {
  assemble_rows(x, measure, targets, a);
}

void SingleLayer::assemble(const Net& x, Measure measure, std::span<const int> targets, Rows<double>& a) {
  assemble_rows(x, measure, targets, a);
}

}  // namespace tanktread::stokes
