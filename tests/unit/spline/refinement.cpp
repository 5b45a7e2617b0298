#include "spline/refinement.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "samples.hpp"
#include "sequences.hpp"
#include "spline/extended_mesh.hpp"
#include "spline/transfer.hpp"
#include "spline/tile_functions.hpp"
#include "spline/locate.hpp"

namespace tanktread::spline {
namespace refinement_test {

constexpr auto rule = ExtraordinaryRule::catmull_clark;

TEST(Refinement, RandomSequencesStayNestedAndIndependent) {
  Findings found;
  SequenceOptions options;
  options.condition = true;
  for (unsigned seed = 0; seed < 6; ++seed) {
    for (int n : {3, 4, 6}) run_sequence(cube(n, 4), seed, options, found);
  }
  options.fraction = 0.15;
  options.steps = 2;
  run_sequence(cube(8, 3), 1, options, found);
  expect_nested(found);
  EXPECT_LT(found.condition, 15);
  EXPECT_GT(found.least_diagonal, 0.25);
}

/// Returns the largest residual over a few sequences, or infinity if the rings are not uniform at some step.
double residual_without(const RepairRules& rules) {
  Findings found;
  SequenceOptions options;
  options.fraction = 0.05;
  options.deep = 0;
  options.steps = 3;
  options.rules = rules;
  try {
    for (unsigned seed = 0; seed < 3; ++seed) run_sequence(cube(8, 4), seed, options, found);
  } catch (const std::logic_error&) {
    return HUGE_VAL;
  }
  return found.residual;
}

TEST(Refinement, EachRuleIsNeeded) {
  EXPECT_LT(residual_without({}), 1e-12);
  EXPECT_GT(residual_without({.no_overlaps = false}), 1e-4);
  EXPECT_GT(residual_without({.nested_extensions = false}), 1e-4);
  EXPECT_GT(residual_without({.rings = 2}), 1e-4);
}

TEST(Refinement, RepeatedRefinementAtAnExtraordinaryPointAdds45PointsPerLevel) {
  TMesh mesh = cube(8, 6);
  const Lattice& l = *mesh.lattice;
  const int P = l.extraordinary[0];
  auto now = std::make_unique<Space>(space(mesh, rule));
  for (int level = 0; level < 6; ++level) {
    const int element = elements(mesh).tile_of_cell[l.cell[P][0]];
    const Refinement r = refine(mesh, {{element}});
    EXPECT_EQ(r.halvings, 1);
    auto next = std::make_unique<Space>(space(r.mesh, rule));
    EXPECT_EQ(next->n_points - now->n_points, 45);
    const auto transfer = spline::transfer(*now, *next);
    EXPECT_LT(transfer(random_net(now->n_points, unsigned(level))).residual, 1e-12);
    mesh = r.mesh;
    now = std::move(next);
  }
  EXPECT_EQ(mesh.spacing[0], 1);
  EXPECT_EQ(refine(mesh, {{elements(mesh).tile_of_cell[l.cell[P][0]]}}).refused, 2);
  EXPECT_LT(collocation_condition(*now), 10);
}

TEST(Refinement, DependsOnTheSetOfMarksOnly) {
  std::mt19937 generator(5);
  TMesh mesh = cube(5, 3);
  for (int step = 0; step < 3; ++step) {
    auto marks = random_marks(mesh, 8, 2, generator);
    const TMesh once = refine(mesh, marks).mesh, twice = refine(mesh, marks).mesh;
    std::shuffle(marks.begin(), marks.end(), generator);
    const TMesh shuffled = refine(mesh, marks).mesh;
    EXPECT_EQ(once.edges, twice.edges);
    EXPECT_EQ(once.edges, shuffled.edges);
    EXPECT_EQ(once.spacing, shuffled.spacing);
    mesh = once;
  }
}

TEST(Refinement, WithoutMarksTheMeshIsUnchanged) {
  const TMesh mesh = cube(4, 2);
  EXPECT_EQ(refine(mesh, {}).mesh.edges, mesh.edges);
}

TEST(Refinement, ElementsCannotBeDividedBelowTheLattice) {
  const TMesh mesh = cube(4, 0);
  const Refinement r = refine(mesh, {{0, true, false}, {7, true, true}});
  EXPECT_EQ(r.refused, 3);
  EXPECT_EQ(r.mesh.edges, mesh.edges);
}

TEST(Refinement, OneCutAcrossSDividesTheElementOnlyAcrossS) {
  const TMesh mesh = cube(12, 1);
  const Tiling before = elements(mesh);
  const int element = before.tile_of_cell[mesh.lattice->cell_at(0, 12, 12)];
  const TMesh cut = refine(mesh, {{element, true, false}}).mesh;
  const Tiling after = elements(cut);
  const Rectangle r = after.tiles[after.tile_of_cell[mesh.lattice->cell_at(0, 12, 12)]];
  EXPECT_EQ(r.width, 1);
  EXPECT_EQ(r.height, 2);
  EXPECT_EQ(after.tiles.size(), before.tiles.size() + 1);
  EXPECT_EQ(anchors(cut).size(), anchors(mesh).size() + 2);
  EXPECT_EQ(t_junctions(cut).size(), 2u);
}

TEST(Refinement, EveryBezierElementHasTheIndexOfItsMeshElement) {
  std::mt19937 generator(4);
  const TMesh mesh = refine(cube(4, 2), random_marks(cube(4, 2), 6, 0, generator)).mesh;
  const Space s = space(mesh, rule);
  const Tiling tiling = elements(mesh);
  const double unit = 1.0 / mesh.lattice->units;
  const auto holder = mesh_elements(mesh, s);
  std::vector<double> covered(tiling.tiles.size(), 0);
  for (std::size_t k = 0; k < s.elements.size(); ++k) covered[holder[k]] += s.elements[k].size[0] * s.elements[k].size[1];
  for (std::size_t i = 0; i < covered.size(); ++i)
    EXPECT_NEAR(covered[i], tiling.tiles[i].width * tiling.tiles[i].height * unit * unit, 1e-15);
}

TEST(Refinement, GrevilleSitesLeaveTheVerticesAndAllTheirElementsAgree) {
  std::mt19937 generator(9);
  TMesh mesh = cube(4, 3);
  for (int step = 0; step < 3; ++step) mesh = refine(mesh, random_marks(mesh, 6, 1, generator)).mesh;
  const Space s = space(mesh, rule);
  const Net net = random_net(s.n_points, 6);
  int inside = 0, on_sides = 0;
  for (const auto& sites : s.collocation) {
    inside += sites.size() == 1;
    on_sides += sites.size() == 2;
    for (const Site& site : sites) EXPECT_LT((value_at(s, net, site) - value_at(s, net, sites[0])).norm(), 1e-13);
  }
  EXPECT_GT(inside, s.n_points / 20);
  EXPECT_GT(on_sides, s.n_points / 10);
}

TEST(Refinement, IncrementalTablesAgreeWithFreshOnesAfterUndo) {
  TMesh mesh = cube(6, 3);
  std::mt19937 generator(2);
  mesh = refine(mesh, random_marks(mesh, 10, 0, generator)).mesh;
  ExtendedMesh extended(mesh);
  extended.keep_extensions();
  std::vector<std::vector<Ray>> paths;
  for (const TJunction& t : t_junctions(mesh)) {
    if (paths.size() == 10) break;
    auto path = face_extension(extended.mesh(), t);
    if (missing_slot(extended.mesh(), t.vertex) < 0) continue;
    extended.insert(path);
    paths.push_back(path);
  }
  const ExtendedMesh fresh(extended.mesh());
  EXPECT_EQ(extended.crossings(), fresh.crossings());
  EXPECT_EQ(extended.overlaps(), fresh.overlaps());
  for (auto p = paths.rbegin(); p != paths.rend(); ++p) {
    std::vector<Ray> added;
    for (Ray e : *p)
      if (!mesh.edge(e.vertex, e.slot)) added.push_back(e);
    extended.remove(added);
  }
  EXPECT_EQ(extended.mesh().edges, mesh.edges);
  EXPECT_EQ(extended.crossings(), 0);
  EXPECT_EQ(extended.missing(), 0);
}

/// Tests that the spaces of the paper's rule are not nested: the surface changes if the rings at an extraordinary point are cut.
TEST(Refinement, G1SpacesAreNotNestedAtAnExtraordinaryPointButAwayFromIt) {
  const TMesh mesh = cube(8, 2);
  const Lattice& l = *mesh.lattice;
  const Space before = space(mesh, ExtraordinaryRule::g1);
  const Net net = random_net(before.n_points, 3);
  const Tiling tiling = elements(mesh);
  const Space at = space(refine(mesh, {{tiling.tile_of_cell[l.cell[l.extraordinary[0]][0]]}}).mesh, ExtraordinaryRule::g1);
  const Space away = space(refine(mesh, {{tiling.tile_of_cell[l.cell_at(0, 17, 17)]}}).mesh, ExtraordinaryRule::g1);
  EXPECT_GT(transfer(before, at)(net).residual, 1e-3);
  EXPECT_LT(transfer(before, away)(net).residual, 1e-12);
}

}  // namespace refinement_test
}  // namespace tanktread::spline
