#include "spline/t_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "spline/bernstein.hpp"
#include "spline/tile_functions.hpp"

namespace tanktread::spline {
namespace {

TEST(Lattice, EveryLinkHasAnInverse) {
  const Lattice l = cube_lattice(3, 1);
  EXPECT_EQ(l.vertices(), 6 * 6 * 6 + 2);
  EXPECT_EQ(l.extraordinary.size(), 8u);
  for (int v = 0; v < l.vertices(); ++v)
    for (int k = 0; k < l.valence(v); ++k) {
      const int w = l.neighbour[v][k], b = l.back[v][k];
      EXPECT_EQ(l.neighbour[w][b], v);
      EXPECT_EQ(l.back[w][b], k);
      EXPECT_EQ(l.corners[l.cell[v][k]][l.corner[v][k]], v);
      EXPECT_EQ(l.slot[l.cell[v][k]][l.corner[v][k]], k);
    }
}

TEST(Lattice, EveryStraightLineClosesOrEndsAtAnExtraordinaryPoint) {
  const Lattice l = cube_lattice(4, 0);
  int closed = 0, ended = 0;
  for (int v = 0; v < l.vertices(); ++v)
    for (int k = 0; k < l.valence(v) && l.valence(v) == 4; ++k) {
      Ray r{v, k};
      int steps = 0;
      do {
        r = step(l, r);
        ++steps;
      } while (r.vertex != v && l.valence(r.vertex) == 4 && steps < 100);
      if (r.vertex == v) {
        EXPECT_EQ(steps, 4 * l.units);
        EXPECT_EQ(r.slot, k);
        ++closed;
      } else {
        EXPECT_EQ(l.valence(r.vertex), 3);
        ++ended;
      }
    }
  EXPECT_EQ(ended, 12 * 3 * 2);  // inner vertices of the edges of the cube, in both directions
  EXPECT_EQ(closed, (l.vertices() - 8) * 4 - ended);
}

TEST(Lattice, CellsHaveOutwardOrientation) {
  const Lattice l = cube_lattice(3, 0);
  for (const auto& c : l.corners) {
    const Vec3 a = l.position[c[0]], normal = (l.position[c[1]] - a).cross(l.position[c[3]] - a);
    EXPECT_GT(normal.dot(a + l.position[c[2]]), 0);
  }
}

TEST(Lattice, FourLeftTurnsAroundACellReturnToTheStart) {
  const Lattice l = cube_lattice(5, 0);
  for (int c = 0; c < l.cells(); ++c)
    for (int turn = 0; turn < 4; ++turn) {
      Walker w{c, turn};
      w = forward(l, forward(l, w, 3), 4);
      w.turn = (w.turn + 2) & 3;
      w = forward(l, w, 7);
      EXPECT_EQ(w.cell, c);
      EXPECT_EQ((w.turn + 2) & 3, turn);
      const Walker a = left(l, {c, turn}, 4), b = forward(l, {c, (turn + 1) & 3}, 4);
      EXPECT_EQ(a.cell, b.cell);
      EXPECT_EQ((a.turn + 1) & 3, b.turn);
    }
}

TEST(TMesh, TheUniformCubeHasOneAnchorPerVertex) {
  for (int n : {3, 6})
    for (int levels : {0, 2}) {
      const TMesh mesh = cube(n, levels);
      EXPECT_EQ(anchors(mesh).size(), std::size_t(6 * n * n + 2));
      EXPECT_EQ(elements(mesh).tiles.size(), std::size_t(6 * n * n));
      EXPECT_TRUE(t_junctions(mesh).empty());
      for (int v : anchors(mesh)) EXPECT_EQ(control_points(mesh)[v] >= 0, true);
    }
}

TEST(TMesh, TooCoarseOrTooFineMeshesAreRejected) {
  EXPECT_THROW(cube(2), UserError);
  EXPECT_THROW(cube(0), UserError);
  EXPECT_THROW(cube(-3), UserError);
  EXPECT_THROW(cube(100, 9), UserError);
  EXPECT_THROW(cube(2000000), UserError);
}

TEST(Knots, MirrorAtAnExtraordinaryPoint) {
  const TMesh mesh = cube(4, 1);
  const Lattice& l = *mesh.lattice;
  for (int P : l.extraordinary)
    for (int s = 0; s < 3; ++s) {
      const Ray spoke = step(l, step(l, {P, s}));
      const Knots k = knots(mesh, spoke.vertex);
      for (int slot = 0; slot < 4; ++slot) {
        EXPECT_EQ(k.reach[slot][0], 2);
        EXPECT_EQ(k.reach[slot][1], 4);
      }
    }
}

TEST(Knots, UniformSplineOnOneSpan) {
  // The Bernstein coefficients of the four uniform cubic B-splines that are not zero on a span are known: 0, 1/6, 1/3 and 2/3.
  const std::array<double, 5> k{-2, -1, 0, 1, 2};
  const double expected[4][4] = {{0, 0, 0, 1. / 6}, {1. / 6, 1. / 3, 2. / 3, 2. / 3}, {2. / 3, 2. / 3, 1. / 3, 1. / 6}, {1. / 6, 0, 0, 0}};
  for (int span = 0; span < 4; ++span) {
    const auto c = b_spline_on(k, span - 2, span - 1);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(c[i], expected[span][i], 1e-15);
  }
}

TEST(Knots, ASplineIsTwiceContinuouslyDifferentiableOverUnequalKnots) {
  const std::array<double, 5> k{-3, -1, 0, 0.5, 4};
  for (int i = 1; i < 4; ++i) {
    const double hl = k[i] - k[i - 1], hr = k[i + 1] - k[i];
    const auto l = b_spline_on(k, k[i - 1], k[i]), r = b_spline_on(k, k[i], k[i + 1]);
    EXPECT_NEAR(l[3], r[0], 1e-14);
    EXPECT_NEAR((l[3] - l[2]) / hl, (r[1] - r[0]) / hr, 1e-14);
    EXPECT_NEAR((l[3] - 2 * l[2] + l[1]) / (hl * hl), (r[2] - 2 * r[1] + r[0]) / (hr * hr), 1e-14);
  }
}

}  // namespace
}  // namespace tanktread::spline
