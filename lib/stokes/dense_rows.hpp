#pragma once
// The skeleton of an assembled layer operator: far moments sixteen targets at a time, own rules target by target.

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "stokes/assembly_kernel.hpp"
#include "stokes/kernels.hpp"
#include "stokes/layer_surface.hpp"

namespace tanktread::stokes {

/// Rows of a dense operator, as the Jacobian keeps them (float) or as a test needs them (double).
template <class Real>
using Rows = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using DenseRows = Rows<float>;

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

  /// What a panel's far nodes need but for weights or normals.
  PanelNodes<Real> nodes(const LayerSurface& surface, int e) const {
    const Panel& p = surface.panels[e];
    const int padded = (p.functions + assembly_tile - 1) / assembly_tile * assembly_tile;
    PanelNodes<Real> nodes;
    nodes.n_nodes = p.table->n_nodes, nodes.functions = padded;
    nodes.x = &surface.node[0][p.first_node], nodes.y = &surface.node[1][p.first_node], nodes.z = &surface.node[2][p.first_node];
    nodes.basis = &values[first_value[e]], nodes.rows = &rows[first_row[e]];
    return nodes;
  }
};

/// Adds Bernstein moments of a panel, moment[6 b + c], to the sums of one target: sums[6 block A + block c].
template <class Real>
void add_moments(const Panels& panels, int e, const double* moments, Real* sums) {
  const int n_b = panels[e].table->n_bernstein;
  const Eigen::Map<const Rows<double>> extraction(panels.extraction(e), panels[e].functions, n_b);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> moment(moments, n_b, 6);
  for (int a = 0; a < panels[e].functions; ++a) {
    const Eigen::Matrix<double, 1, 6> row = extraction.row(a).lazyProduct(moment);
    Real* to = sums + static_cast<std::ptrdiff_t>(6 * assembly_block) * panels.points(e)[a];
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

/// Assembles rows of a layer that knows
///   near(i, x0), own(i)                                panels that need a near rule for target i at x0, and those that it lies on
///   own_moments(target, x0, e, table, pair, moments)   one panel under its own rule; `pair` for a panel that the target lies on
///   far_nodes(nodes, e)                                puts weights or normals into a panel's far nodes
///   finish(target, x0, sums)                           what is left to do with the sums of a target
/// `x0`: the targets. Counts kernel evaluations.
template <class Real, class Layer>
void dense_rows(LayerSurface& surface, std::span<const int> targets, const std::vector<Vec3>& x0, Layer& layer, Evaluations& count,
                Rows<Real>& a) {
  constexpr int block = assembly_block;
  const int n = static_cast<int>(targets.size());
  Panels& panels = surface.panels;
  a.resize(3 * n, 3 * surface.n_points);
  const FarBasis<Real> basis(panels, surface.n_points);
  std::vector<Real> sums(static_cast<std::size_t>(6) * block * (surface.n_points + 1)), kernel;
  std::vector<double> moments;
  std::vector<std::uint32_t> skip(panels.size());
  double target[3 * block];
  for (int first = 0; first < n; first += block) {
    const int used = std::min(block, n - first);
    std::fill(sums.begin(), sums.end(), Real(0));
    std::fill(skip.begin(), skip.end(), 0u);
    for (int l = 0; l < block; ++l)
      for (int c = 0; c < 3; ++c) target[block * c + l] = x0[std::min(first + l, n - 1)][c];
    for (int l = 0; l < used; ++l) {
      const int i = targets[first + l];
      const Vec3& at = x0[first + l];
      const auto add = [&](int e, const PointTable& table, SelfPair* pair) {
        skip[e] |= 1u << l;
        moments.resize(static_cast<std::size_t>(6) * panels[e].table->n_bernstein);
        layer.own_moments(at, e, table, pair, moments.data());
        add_moments(panels, e, moments.data(), &sums[l]);
        (pair ? count.self : count.near) += table.points;
      };
      for (const int e : layer.near(i, at)) add(e, surface.near_field.rule(e, at), nullptr);
      for (SelfPair& pair : layer.own(i)) add(pair.panel, surface.self_field.rule(pair, panels, surface.bezier), &pair);
    }
    for (int e = 0; e < panels.size(); ++e) {
      PanelNodes<Real> nodes = basis.nodes(surface, e);
      layer.far_nodes(nodes, panels[e].first_node);
      kernel.resize(static_cast<std::size_t>(6) * block * nodes.n_nodes);
      add_far_moments<Real>(nodes, target, skip[e], kernel.data(), sums.data());
    }
    count.far += static_cast<long long>(used) * panels.n_nodes();
    for (int l = 0; l < used; ++l) {
      layer.finish(targets[first + l], x0[first + l], &sums[l]);
      write_rows(3 * (first + l), surface.n_points, &sums[l], a);
    }
  }
}

}  // namespace tanktread::stokes
