#include <gtest/gtest.h>

#include "samples.hpp"
#include "sequences.hpp"
#include "spline/refinement.hpp"
#include "spline/polar.hpp"
#include "spline/transfer.hpp"

namespace tanktread::spline {
namespace {

SequenceOptions on_poles(PoleRule poles) {
  SequenceOptions options;
  options.space = [poles](const TMesh& mesh) { return space(mesh, poles); };
  options.per_pole = poles == PoleRule::c1 ? 3 : 1;
  options.condition = true;
  return options;
}

TEST(PolarRefinement, RandomSequencesStayNestedAndIndependent) {
  for (PoleRule poles : {PoleRule::plain, PoleRule::c1}) {
    Findings found;
    auto options = on_poles(poles);
    for (unsigned seed = 0; seed < 8; ++seed) run_sequence(seed % 2 ? polar(8, 4, 4) : polar(7, 6, 4), seed, options, found);
    expect_nested(found);
    // The single function of a plain pole has a long column, because it is not zero at many points around the pole. Without cuts, the condition
    // number is 13 for 8 elements in azimuth and 19 for 32.
    EXPECT_LT(found.condition, poles == PoleRule::c1 ? 15 : 25);
    EXPECT_LT(found.scaled, 15);
    EXPECT_EQ(found.finest, 1);
  }
}

TEST(PolarRefinement, CutsAtAPoleKeepTheField) {
  for (PoleRule poles : {PoleRule::plain, PoleRule::c1}) {
    TMesh mesh = polar(8, 4, 3);
    auto now = std::make_unique<Space>(space(mesh, poles));
    for (int level = 0; level < 3; ++level) {
      const TMesh cut = refine(mesh, {{elements(mesh).tile_of_cell[mesh.lattice->cell_at(0, 0, 1)]}}).mesh;
      auto next = std::make_unique<Space>(space(cut, poles));
      EXPECT_GT(next->n_points, now->n_points);
      EXPECT_LT(transfer(*now, *next)(random_net(now->n_points, 4)).residual, 1e-12);
      mesh = cut;
      now = std::move(next);
    }
  }
}

TEST(PolarRefinement, CoarseningReturnsToTheBaseMesh) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    std::mt19937 generator(seed);
    const TMesh base = polar(8, 4, 3);
    TMesh mesh = base;
    for (int step = 0; step < 3; ++step) mesh = refine(mesh, random_marks(mesh, 5, 1, generator)).mesh;
    mesh = merged_wherever_allowed(mesh, base);
    EXPECT_EQ(mesh.edges, base.edges);
  }
}

TEST(PolarRefinement, TheTransformReplacesElementsAtPolesOnly) {
  std::mt19937 generator(1);
  const TMesh mesh = refine(polar(8, 4, 2), random_marks(polar(8, 4, 2), 4, 0, generator)).mesh;
  const Space plain = space(mesh, PoleRule::plain), transformed = space(mesh, PoleRule::bezier_transform, 1);
  EXPECT_EQ(plain.n_points, transformed.n_points);
  const Net net = random_net(plain.n_points, 3);
  for (const auto& sites : transformed.collocation)
    for (const Site& site : sites) EXPECT_LT((value_at(transformed, net, site) - value_at(transformed, net, sites[0])).norm(), 1e-13);
  for (const Element& e : transformed.elements) EXPECT_LT((e.extraction->colwise().sum().array() - 1).abs().maxCoeff(), 1e-13);
}

}  // namespace
}  // namespace tanktread::spline
