#include "spline/transfer.hpp"

#include <gtest/gtest.h>

#include "samples.hpp"
#include "spline/extraction.hpp"
#include "spline/locate.hpp"
#include "spline/refinement.hpp"

namespace tanktread::spline {
namespace {

TEST(Transfer, ARefinedFieldIsTheSameFieldEverywhere) {
  const TMesh mesh = cube(4, 2);
  const Space coarse = space(mesh, ExtraordinaryRule::catmull_clark);
  const Space fine = space(refine(mesh, {{0}, {5, true, false}, {40, false, true}}).mesh, ExtraordinaryRule::catmull_clark);
  const Net net = random_net(coarse.n_points, 1);
  const auto transfer = spline::transfer(coarse, fine);
  const auto moved = transfer(net);
  EXPECT_LT(moved.residual, 1e-13);
  const Locator in_coarse(coarse);
  for (int k = 0; k < int(fine.elements.size()); ++k) {
    const Site here{k, 0.3, 0.9};
    EXPECT_LT((value_at(fine, moved.net, here) - value_at(coarse, net, in_coarse(place(fine, here)))).norm(), 1e-13);
  }
}

TEST(Transfer, ControlPointsFarFromACutAreBitwiseEqual) {
  const TMesh mesh = cube(12, 1);
  const TMesh cut = refine(mesh, {{elements(mesh).tile_of_cell[mesh.lattice->cell_at(0, 12, 12)]}}).mesh;
  const Space coarse = space(mesh, ExtraordinaryRule::catmull_clark), fine = space(cut, ExtraordinaryRule::catmull_clark);
  const Net net = random_net(coarse.n_points, 1), moved = transfer(coarse, fine)(net).net;
  const auto old_point = control_points(mesh);
  const auto at = anchors(cut);
  int copied = 0;
  for (int i = 0; i < fine.n_points; ++i) copied += old_point[at[i]] >= 0 && moved.row(i) == net.row(old_point[at[i]]);
  EXPECT_LT(copied, coarse.n_points);
  EXPECT_GT(copied, coarse.n_points - 49);  // a cut has an effect up to three elements away in each direction
}

TEST(Transfer, ResidualDetectsSpacesThatAreNotNested) {
  const Space fine = space(cube(6), ExtraordinaryRule::g1), coarse = space(cube(3), ExtraordinaryRule::g1);
  EXPECT_GT(transfer(coarse, fine)(random_net(coarse.n_points, 1)).residual, 1e-3);
}

TEST(Projection, ReproducesFieldsOfTheSpace) {
  const Space coarse = space(cube(4), ExtraordinaryRule::catmull_clark);
  const Space other = space(refine(cube(4, 2), {{3}, {50}}).mesh, ExtraordinaryRule::catmull_clark);
  const Net net = random_net(coarse.n_points, 2);
  const auto there = projection(coarse, other)(net), back = projection(other, coarse)(there.net);
  for (double d : there.defect) EXPECT_LT(d, 1e-12);
  EXPECT_LT((back.net - net).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace tanktread::spline
