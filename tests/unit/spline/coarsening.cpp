#include "spline/refinement.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "samples.hpp"
#include "sequences.hpp"
#include "spline/locate.hpp"
#include "spline/transfer.hpp"
#include "suitability.hpp"

namespace tanktread::spline {
namespace coarsening_test {

constexpr auto rule = ExtraordinaryRule::catmull_clark;

double largest(const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); }

TEST(Coarsening, UndoingTheLastRefinementRestoresTheMeshAndTheControlPoints) {
  for (int n : {3, 4, 6})
    for (unsigned seed = 0; seed < 4; ++seed) {
      std::mt19937 generator(seed);
      TMesh before = cube(n, 3);
      before = refine(before, random_marks(before, 5, 1, generator)).mesh;
      const TMesh after = refine(before, random_marks(before, 10, 1, generator)).mesh;
      std::vector<std::uint8_t> added(after.edges.size());
      for (std::size_t v = 0; v < added.size(); ++v) added[v] = std::uint8_t(after.edges[v] & ~before.edges[v]);
      const TMesh back = take_out(after, added);
      ASSERT_EQ(back.edges, before.edges);
      EXPECT_EQ(back.spacing, before.spacing);

      const Space a = space(before, rule), b = space(after, rule);
      const Net net = random_net(a.n_points, seed);
      const auto returned = projection(b, a)(transfer(a, b)(net).net);
      EXPECT_LT((returned.net - net).cwiseAbs().maxCoeff(), 1e-12);  // condition of the normal matrix (300) times rounding
      EXPECT_LT(largest(returned.defect), 1e-12);
    }
}

TEST(Coarsening, CoarseningReturnsToTheBaseMesh) {
  for (int n : {3, 4, 6})
    for (unsigned seed = 0; seed < 4; ++seed) {
      std::mt19937 generator(seed);
      const TMesh base = cube(n, 3);
      TMesh mesh = base;
      for (int step = 0; step < 3; ++step) mesh = refine(mesh, random_marks(mesh, 6, 1, generator)).mesh;
      mesh = merged_wherever_allowed(mesh, base);
      EXPECT_EQ(mesh.edges, base.edges);
      EXPECT_EQ(mesh.spacing, base.spacing);
    }
}

TEST(Coarsening, HalfTheSurfaceLeavesAValidMesh) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    std::mt19937 generator(seed);
    TMesh mesh = cube(5, 3);
    for (int step = 0; step < 3; ++step) mesh = refine(mesh, random_marks(mesh, 12, 1, generator)).mesh;
    const std::size_t points = anchors(mesh).size();
    for (int round = 0; round < 3; ++round) {
      std::vector<Merge> half;
      const Tiling tiling = elements(mesh);
      for (int i = 0; i < int(tiling.tiles.size()); ++i)
        if (tiling.tiles[i].face < 4) half.push_back({i});
      mesh = coarsen(mesh, half);
      const Suitability s = suitability(mesh);
      EXPECT_EQ(s.crossings + s.overlaps + s.broken_zones, 0);
      const Space sp = space(mesh, rule);
      EXPECT_EQ(wrong_counts(mesh, sp), 0);
      for (const Element& e : sp.elements) EXPECT_LT((e.extraction->colwise().sum().array() - 1).abs().maxCoeff(), 1e-13);
    }
    EXPECT_LT(anchors(mesh).size(), points);
  }
}

/// Moves a feature around the cube twice, and refines the mesh at the feature and coarsens it elsewhere. The number of control points must not grow
/// in the second revolution.
TEST(Coarsening, AMovingFeatureKeepsTheNumberOfControlPointsBounded) {
  TMesh mesh = cube(4, 3);
  int most[2] = {0, 0};  // largest number of control points in the first and the second revolution
  auto near = [&](const Lattice& l, const Rectangle& r, double angle, double radius) {
    const Vec3 middle = (l.position[corners(l, r)[0]] + l.position[corners(l, r)[2]]) / 2;
    const Vec3 bump(std::cos(angle), std::sin(angle), 0.3 * std::sin(2 * angle));
    return (middle.normalized() - bump.normalized()).norm() < radius;
  };
  for (int cycle = 0; cycle < 64; ++cycle) {
    const double angle = 2 * M_PI * cycle / 32;
    for (int pass = 0; pass < 2; ++pass) {
      const Tiling tiling = elements(mesh);
      std::vector<Mark> marks;
      for (int i = 0; i < int(tiling.tiles.size()); ++i) {
        const Rectangle& r = tiling.tiles[i];
        if (near(*mesh.lattice, r, angle, 0.3)) marks.push_back({i, r.width > 2, r.height > 2});
      }
      mesh = refine(mesh, marks).mesh;
    }
    const Tiling tiling = elements(mesh);
    std::vector<Merge> merges;
    for (int i = 0; i < int(tiling.tiles.size()); ++i)
      if (!near(*mesh.lattice, tiling.tiles[i], angle, 0.5)) merges.push_back({i, 3, 3});
    mesh = coarsen(mesh, merges);
    const Suitability s = suitability(mesh);
    ASSERT_EQ(s.crossings + s.overlaps + s.broken_zones, 0);
    const int points = int(anchors(mesh).size());
    int& here = most[cycle / 32];
    here = std::max(here, points);
  }
  EXPECT_GT(most[0], 200);   // the base mesh has 98 control points
  EXPECT_LT(most[0], 1000);  // the uniform mesh with the resolution at the feature has 1538
  EXPECT_LT(most[1], 1.1 * most[0]);
}

}  // namespace coarsening_test
}  // namespace tanktread::spline
