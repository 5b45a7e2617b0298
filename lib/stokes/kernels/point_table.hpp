#pragma once
// Bernstein polynomials at the points of a panel-specific quadrature rule, stored in packs of as many points as fit into a register.

#include <vector>

#include "quadrature/gauss.hpp"
#include "base/pack.hpp"

namespace tanktread::stokes {

/// Bernstein polynomials and their derivatives at the points of a rule. Pack k of points has B_i(s), B_j(t), B_i'(s), B_j'(t), degree + 1 packs each.
/// The last pack is padded with points of weight 0.
struct PointTable {
  int degree = 3, points = 0;
  std::vector<Pack> bernstein, weights;

  int packs() const { return static_cast<int>(weights.size()); }
};

void tabulate(const quadrature::Rule& rule, int degree, PointTable& table);

}  // namespace tanktread::stokes
