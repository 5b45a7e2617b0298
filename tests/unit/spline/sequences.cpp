#include "tests/unit/spline/sequences.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseLU>
#include <gtest/gtest.h>

#include "spline/extended_mesh.hpp"
#include "spline/transfer.hpp"
#include "tests/unit/spline/samples.hpp"
#include "tests/unit/spline/suitability.hpp"

namespace tanktread::spline {

TMesh merged_wherever_allowed(TMesh mesh, const TMesh& base) {
  for (int round = 0; round < 8 && mesh.edges != base.edges; ++round) {
    std::vector<Merge> all;
    for (int i = 0; i < int(elements(mesh).tiles.size()); ++i) all.push_back({i, 3, 3});
    mesh = coarsen(mesh, all);
    EXPECT_EQ(suitability(mesh).crossings, 0);
  }
  return mesh;
}

void expect_nested(const Findings& found) {
  EXPECT_EQ(found.crossings, 0);
  EXPECT_EQ(found.overlaps, 0);
  EXPECT_EQ(found.broken_zones, 0);
  EXPECT_EQ(found.wrong_counts, 0);
  EXPECT_LT(found.unity, 1e-13);
  EXPECT_LT(found.residual, 1e-12);  // for fields of order 1; measured: 1e-14, and 1e-3 to 1 if a rule is violated
}

double condition_number(const Eigen::SparseMatrix<double>& C) {
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(C);
  if (lu.info() != Eigen::Success) return HUGE_VAL;
  Eigen::VectorXd x = random_net(int(C.cols()), 1).col(0), y = x;
  double largest = 0, smallest = 0;
  for (int i = 0; i < 40; ++i) {
    x = C.transpose() * (C * x.normalized());
    y = lu.solve(lu.transpose().solve(y.normalized()).eval());
    largest = x.norm();
    smallest = 1 / y.norm();
  }
  return std::sqrt(largest / smallest);
}

double condition_number(const Eigen::MatrixXd& C) {
  const Eigen::VectorXd squares = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(C.transpose() * C, Eigen::EigenvaluesOnly).eigenvalues();
  return std::sqrt(squares[squares.size() - 1] / squares[0]);
}

double collocation_condition(const Space& s, double* least_diagonal, double* scaled) {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> diagonal(s.n_points, 0);
  for (int i = 0; i < s.n_points; ++i) {
    const Site& site = s.collocation[i][0];
    const Element& e = s.elements[site.element];
    const Basis b = basis(e, site.s, site.t, 0);
    for (std::size_t k = 0; k < e.points.size(); ++k) {
      entries.emplace_back(i, e.points[k], b.value[Eigen::Index(k)]);
      if (e.points[k] == i) diagonal[i] += b.value[Eigen::Index(k)];
    }
  }
  Eigen::SparseMatrix<double> C(s.n_points, s.n_points);
  C.setFromTriplets(entries.begin(), entries.end());
  if (least_diagonal) *least_diagonal = *std::min_element(diagonal.begin(), diagonal.end());
  const double condition = condition_number(C);
  if (scaled) {
    for (int j = 0; j < s.n_points; ++j) C.col(j) /= C.col(j).norm();
    *scaled = condition_number(C);
  }
  return condition;
}

std::vector<Mark> random_marks(const TMesh& mesh, int scattered, int deep, std::mt19937& generator) {
  const Tiling tiling = elements(mesh);
  std::vector<int> by_size(tiling.tiles.size());
  for (std::size_t i = 0; i < by_size.size(); ++i) by_size[i] = int(i);
  std::stable_sort(by_size.begin(), by_size.end(), [&](int a, int b) {
    return tiling.tiles[a].width * tiling.tiles[a].height < tiling.tiles[b].width * tiling.tiles[b].height;
  });
  std::vector<Mark> marks;
  auto add = [&](int element) {
    const unsigned way = generator() % 4;
    marks.push_back({element, way != 3, way != 2});
  };
  for (int i = 0; i < scattered; ++i) add(int(generator() % by_size.size()));
  for (int i = 0; i < deep; ++i) add(by_size[generator() % std::min<std::size_t>(4, by_size.size())]);
  return marks;
}

int wrong_counts(const TMesh& mesh, const Space& s, int per_pole) {
  const Lattice& l = *mesh.lattice;
  const Tiling tiling = bezier_mesh(mesh);
  std::vector<bool> irregular(tiling.tiles.size(), false);
  for (int v : l.extraordinary)
    for (int k = 0; k < 3; ++k) irregular[tiling.tile_of_cell[l.cell[v][k]]] = true;
  int wrong = 0;
  for (const Element& e : s.elements) {
    const int x = int((e.origin[0] + e.size[0] / 2) * l.units), y = l.pad + int((e.origin[1] + e.size[1] / 2) * l.height(l.rows));
    const bool at_pole = std::any_of(e.points.begin(), e.points.end(), [&](int p) { return p < per_pole || p >= s.n_points - per_pole; });
    if (!at_pole && !irregular[tiling.tile_of_cell[l.cell_at(e.face, x, y)]] && e.points.size() != 16) ++wrong;
  }
  return wrong;
}

void run_sequence(TMesh mesh, unsigned seed, const SequenceOptions& options, Findings& found) {
  std::mt19937 generator(seed);
  auto now = std::make_unique<Space>(options.space(mesh));
  for (int step = 0; step < options.steps; ++step) {
    const int scattered = std::max(1, int(options.fraction * double(elements(mesh).tiles.size())));
    mesh = refine(mesh, random_marks(mesh, scattered, options.deep, generator), options.rules).mesh;
    auto next = std::make_unique<Space>(options.space(mesh));
    const auto transfer = spline::transfer(*now, *next);
    found.residual = std::max(found.residual, transfer(random_net(now->n_points, unsigned(generator()))).residual);
    found.wrong_counts += wrong_counts(mesh, *next, options.per_pole);
    for (const Element& e : next->elements)
      found.unity = std::max(found.unity, (e.extraction->colwise().sum().array() - 1).abs().maxCoeff());
    ++found.steps;
    now = std::move(next);
  }
  const Suitability s = suitability(mesh);
  found.crossings += s.crossings;
  found.overlaps += s.overlaps;
  found.broken_zones += s.broken_zones;
  for (const Rectangle& r : elements(mesh).tiles) found.finest = std::min({found.finest, r.width, r.height});
  found.control_points = std::max(found.control_points, now->n_points);
  if (options.condition) {
    double diagonal, scaled;
    found.condition = std::max(found.condition, collocation_condition(*now, &diagonal, &scaled));
    found.scaled = std::max(found.scaled, scaled);
    found.least_diagonal = std::min(found.least_diagonal, diagonal);
  }
}

}  // namespace tanktread::spline
