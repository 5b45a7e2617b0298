#pragma once
// The skeleton of assembled rows of a layer operator: far moments sixteen targets at a time, own rules target by target. Whole rows, or what
// near control points add to them.

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "stokes/assembly_kernel.hpp"
#include "stokes/kernels.hpp"
#include "stokes/layer_surface.hpp"

namespace tanktread::stokes {

/// Rows of a dense operator: of doubles where systems are solved with them, of floats where the Jacobian keeps them in fewer bits still.
template <class Real>
using Rows = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Control points, some a target: point[first[k]] .. point[first[k + 1] - 1] are those of target k.
struct NearPoints {
  std::vector<std::size_t> first{0};
  std::vector<int> point;
};

/// Basis functions of some panels at their far nodes, and the row of the sums that each adds to. Padded to whole tiles; padded functions and those
/// of other control points add to a spare row.
template <class Real>
struct FarBasis {
  std::vector<int> panels, index;  ///< the panels; of each panel of the surface its number among them, -1: it is not there
  std::vector<Real> values;
  std::vector<int> rows;
  std::vector<std::size_t> first_value, first_row;

  void clear(const Panels& all) {
    panels.clear(), values.clear(), rows.clear(), first_value.clear(), first_row.clear();
    index.assign(static_cast<std::size_t>(all.size()), -1);
  }

  void add(const Panels& all, int e, const std::vector<int>& row_of_point, int spare_row) {
    const NodeTable& t = *all[e].table;
    const int m = all[e].functions, padded = (m + assembly_tile - 1) / assembly_tile * assembly_tile;
    index[e] = static_cast<int>(panels.size());
    panels.push_back(e);
    first_value.push_back(values.size());
    first_row.push_back(rows.size());
    values.resize(values.size() + static_cast<std::size_t>(padded) * t.n_nodes, Real(0));
    for (int a = 0; a < m; ++a)  // a sum per entry in one order, wherever the arrays lie
      for (int b = 0; b < t.n_bernstein; ++b) {
        const Real share = static_cast<Real>(all.extraction(e)[t.n_bernstein * a + b]);
        const double* from = &t.value[static_cast<std::size_t>(t.n_nodes) * b];
        Real* to = &values[first_value.back() + static_cast<std::size_t>(t.n_nodes) * a];
        for (int k = 0; k < t.n_nodes; ++k) to[k] += share * static_cast<Real>(from[k]);
      }
    for (int a = 0; a < padded; ++a) rows.push_back(a < m ? row_of_point[all.points(e)[a]] : spare_row);
  }

  /// What the far nodes of the k-th panel need but for weights or normals.
  PanelNodes<Real> nodes(const LayerSurface& surface, std::size_t k) const {
    const Panel& p = surface.panels[panels[k]];
    PanelNodes<Real> nodes;
    nodes.n_nodes = p.table->n_nodes, nodes.functions = (p.functions + assembly_tile - 1) / assembly_tile * assembly_tile;
    nodes.x = &surface.node[0][p.first_node], nodes.y = &surface.node[1][p.first_node], nodes.z = &surface.node[2][p.first_node];
    nodes.basis = &values[first_value[k]], nodes.rows = &rows[first_row[k]];
    return nodes;
  }
};

/// Adds Bernstein moments of panel e, moment[6 b + c], to the sums of one target: sums[6 block rows[A] + block c].
template <class Real>
void add_moments(const Panels& panels, int e, const int* rows, const double* moments, Real* sums) {
  const int n_b = panels[e].table->n_bernstein;
  const Eigen::Map<const Rows<double>> extraction(panels.extraction(e), panels[e].functions, n_b);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> moment(moments, n_b, 6);
  for (int a = 0; a < panels[e].functions; ++a) {
    const Eigen::Matrix<double, 1, 6> row = extraction.row(a).lazyProduct(moment);
    Real* to = sums + static_cast<std::ptrdiff_t>(6 * assembly_block) * rows[a];
    for (int c = 0; c < 6; ++c) to[assembly_block * c] += static_cast<Real>(row[c]);
  }
}

/// Three rows of the operator from the sums 11, 12, 13, 22, 23, 33 of one target with every control point, over 8 pi.
template <class Real>
void write_rows(int row, int n_points, const Real* sums, Rows<Real>& a) {
  constexpr int entry[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  const Real scale = static_cast<Real>(1 / (8 * std::numbers::pi));
  for (int i = 0; i < 3; ++i) {
    Real* to = &a(row + i, 0);
    const Real* from = sums;
    for (int p = 0; p < n_points; ++p, from += 6 * assembly_block, to += 3)
      for (int j = 0; j < 3; ++j) to[j] = scale * from[assembly_block * entry[3 * i + j]];
  }
}

/// Sums over the panels of a basis, for up to sixteen targets and a layer that knows
///   near(i, x0), own(i)                                panels that need a near rule for target i at x0, and those that it lies on
///   own_moments(target, x0, e, table, pair, moments)   one panel under its own rule; `pair` for a panel that the target lies on
///   far_nodes(nodes, e)                                puts weights or normals into a panel's far nodes
///   finish(target, x0, sums)                           what is left to do with the sums of a target with all control points
/// `x0`: the targets. Counts kernel evaluations.
template <class Real, class Layer>
class RowSums {
 public:
  RowSums(LayerSurface& surface, Layer& layer, Evaluations& count) : surface_(surface), layer_(layer), count_(count) {}

  FarBasis<Real> basis;
  std::vector<Real> sums;  ///< [6 block row + block c + l]

  void add(std::span<const int> targets, const Vec3* x0, int rows) {
    constexpr int block = assembly_block;
    Panels& panels = surface_.panels;
    const int used = static_cast<int>(targets.size());
    sums.assign(static_cast<std::size_t>(6) * block * (rows + 1), Real(0));
    skip_.assign(basis.panels.size(), 0u);
    double place[3 * block];
    for (int l = 0; l < block; ++l)
      for (int c = 0; c < 3; ++c) place[block * c + l] = x0[std::min(l, used - 1)][c];
    for (int l = 0; l < used; ++l) {
      const auto add = [&](int e, const PointTable& table, SelfPair* pair) {
        const auto k = static_cast<std::size_t>(basis.index[e]);
        skip_[k] |= 1u << l;
        moments_.resize(static_cast<std::size_t>(6) * panels[e].table->n_bernstein);
        layer_.own_moments(x0[l], e, table, pair, moments_.data());
        add_moments(panels, e, &basis.rows[basis.first_row[k]], moments_.data(), &sums[l]);
        (pair ? count_.self : count_.near) += table.points;
      };
      for (const int e : layer_.near(targets[l], x0[l]))
        if (basis.index[e] >= 0) add(e, surface_.near_field.rule(e, x0[l], layer_.own(targets[l])), nullptr);
      for (SelfPair& pair : layer_.own(targets[l]))
        if (basis.index[pair.panel] >= 0) add(pair.panel, surface_.self_field.rule(pair, panels, surface_.bezier), &pair);
    }
    for (std::size_t k = 0; k < basis.panels.size(); ++k) {
      PanelNodes<Real> nodes = basis.nodes(surface_, k);
      layer_.far_nodes(nodes, panels[basis.panels[k]].first_node);
      kernel_.resize(static_cast<std::size_t>(6) * block * nodes.n_nodes);
      add_far_moments<Real>(nodes, place, skip_[k], kernel_.data(), sums.data());
      count_.far += static_cast<long long>(used) * nodes.n_nodes;
    }
  }

 private:
  LayerSurface& surface_;
  Layer& layer_;
  Evaluations& count_;
  std::vector<Real> kernel_;
  std::vector<double> moments_;
  std::vector<std::uint32_t> skip_;
};

/// Assembles rows of a layer.
template <class Real, class Layer>
void dense_rows(LayerSurface& surface, std::span<const int> targets, const std::vector<Vec3>& x0, Layer& layer, Evaluations& count,
                Rows<Real>& a) {
  constexpr std::size_t block = assembly_block;
  RowSums<Real, Layer> rows(surface, layer, count);
  std::vector<int> row_of_point(static_cast<std::size_t>(surface.n_points));
  std::iota(row_of_point.begin(), row_of_point.end(), 0);
  rows.basis.clear(surface.panels);
  for (int e = 0; e < surface.panels.size(); ++e) rows.basis.add(surface.panels, e, row_of_point, surface.n_points);
  a.resize(3 * static_cast<Eigen::Index>(targets.size()), 3 * surface.n_points);
  for (std::size_t first = 0; first < targets.size(); first += block) {
    const std::span<const int> some = targets.subspan(first, std::min(block, targets.size() - first));
    rows.add(some, &x0[first], surface.n_points);
    for (std::size_t l = 0; l < some.size(); ++l) {
      layer.finish(some[l], x0[first + l], &rows.sums[l]);
      write_rows(3 * static_cast<int>(first + l), surface.n_points, &rows.sums[l], a);
    }
  }
}

/// What near control points add to rows of a layer: entries 11, 12, 13, 22, 23, 33 of the symmetric blocks A_iB, entries[6 j + c] for near.point[j].
/// Targets side by side should be neighbours: sixteen of them share the panels that carry their near points.
template <class Layer>
void near_rows(LayerSurface& surface, std::span<const int> targets, const std::vector<Vec3>& x0, const NearPoints& near, Layer& layer,
               Evaluations& count, std::vector<double>& entries) {
  constexpr std::size_t block = assembly_block;
  constexpr double scale = 1 / (8 * std::numbers::pi);
  const auto sort_and_drop_repeated = [](std::vector<int>& numbers) {
    std::ranges::sort(numbers);
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  };
  const Panels& panels = surface.panels;
  std::vector<std::vector<int>> panels_of(static_cast<std::size_t>(surface.n_points));
  for (int e = 0; e < panels.size(); ++e)
    for (int a = 0; a < panels[e].functions; ++a) panels_of[panels.points(e)[a]].push_back(e);
  RowSums<double, Layer> rows(surface, layer, count);
  std::vector<int> row_of_point;
  entries.resize(6 * near.point.size());
  for (std::size_t first = 0; first < targets.size(); first += block) {
    const std::span<const int> some = targets.subspan(first, std::min(block, targets.size() - first));
    const std::span<const int> points(near.point.data() + near.first[first], near.first[first + some.size()] - near.first[first]);
    std::vector<int> wanted(points.begin(), points.end());
    sort_and_drop_repeated(wanted);
    const int spare = static_cast<int>(wanted.size());
    row_of_point.assign(static_cast<std::size_t>(surface.n_points), spare);
    for (int k = 0; k < spare; ++k) row_of_point[wanted[k]] = k;
    std::vector<int> carriers;
    for (const int point : wanted) carriers.insert(carriers.end(), panels_of[point].begin(), panels_of[point].end());
    sort_and_drop_repeated(carriers);
    rows.basis.clear(panels);
    for (const int e : carriers) rows.basis.add(panels, e, row_of_point, spare);
    rows.add(some, &x0[first], spare);
    for (std::size_t l = 0; l < some.size(); ++l)
      for (std::size_t j = near.first[first + l]; j < near.first[first + l + 1]; ++j)
        for (std::size_t c = 0; c < 6; ++c)
          entries[6 * j + c] = scale * rows.sums[block * (6 * static_cast<std::size_t>(row_of_point[near.point[j]]) + c) + l];
  }
}

}  // namespace tanktread::stokes
