#include "stokes/kernels/point_table.hpp"

#include "spline/bernstein.hpp"

namespace tanktread::stokes {

void tabulate(const quadrature::Rule& rule, int degree, PointTable& table) {
  const int lanes = pack_lanes(), n = degree + 1, packs = (rule.size() + lanes - 1) / lanes;
  table.degree = degree;
  table.points = rule.size();
  table.bernstein.resize(static_cast<std::size_t>(4) * n * packs);
  table.weights.assign(packs, Pack{});
  double* const bernstein = numbers(table.bernstein.data());
  double value[4][spline::most_polynomial_degree + 1];
  for (int q = 0; q < packs * lanes; ++q) {
    const int from = q < rule.size() ? q : 0, k = q / lanes, l = q % lanes;
    spline::bernstein(degree, rule.s[from], value[0], value[2], nullptr);
    spline::bernstein(degree, rule.t[from], value[1], value[3], nullptr);
    for (int a = 0; a < 4; ++a)
      for (int i = 0; i < n; ++i) bernstein[lanes * (static_cast<std::size_t>(4 * k + a) * n + i) + l] = value[a][i];
    if (q < rule.size()) numbers(table.weights.data())[q] = rule.weights[q];
  }
}

}  // namespace tanktread::stokes
