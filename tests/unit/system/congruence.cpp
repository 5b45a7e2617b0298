// Tests of the rotations and reflections that map the wall of a duct to itself. They map rows of the wall's operator to other rows, and divide the
// operator into parts of different parity.

#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "system/solids/ducts/congruence.hpp"
#include "system/solids/ducts/wall.hpp"

namespace tanktread::coupling {
namespace {

surface::TubeOptions circle() {
  surface::TubeOptions o;
  o.radius = 1, o.azimuthal_elements = 8, o.axial_elements = 6;
  return o;
}

surface::TubeOptions rectangle(double side) {
  surface::TubeOptions o = circle();
  o.section = "rectangle", o.radius.reset(), o.sides = Eigen::Vector2d(2, side);
  return o;
}

surface::TubeWall open(const surface::TubeOptions& o) { return surface::tube_wall(surface::outline(o), o, 2 * std::numbers::pi); }

surface::TubeWall bent() {
  surface::TubeOptions o = circle();
  o.channel.emplace();
  o.channel->depth = 0.5, o.channel->half_length = 2;
  o.channel->bend_radius = 3, o.channel->bend_start = 1, o.channel->bend_angle = 90;
  return surface::channel_wall(std::make_shared<const surface::Channel>(o), 8);
}

/// Returns the number of maps of a wall, and the number of azimuthal points whose rows are not images of other rows.
std::pair<std::size_t, int> found(const surface::TubeWall& wall) {
  quadrature::Options rule;
  const std::vector<WallSymmetry> maps = wall_symmetries(wall, Wall(wall, rule).points().sites());
  int own = 0;
  const std::vector<OrbitRepresentative> all = orbit_representatives(maps, wall.n_around);
  for (int k = 0; k < wall.n_around; ++k) {
    const auto& [point, from] = all[static_cast<std::size_t>(k)];
    EXPECT_EQ(from->image[static_cast<std::size_t>(point)], k);
    own += point == k;
  }
  return {maps.size(), own};
}

TEST(WallSymmetry, FindsAllMapsOfASection) {
  EXPECT_EQ(found(open(circle())), std::pair(std::size_t{16}, 1));
  EXPECT_EQ(found(open(rectangle(2))).first, 8u);
  EXPECT_EQ(found(open(rectangle(1))).first, 4u);
  EXPECT_EQ(found(bent()).first, 2u);
}

// `apply` sums over all targets and does not know of the maps.
TEST(WallSymmetry, MapsRowsOfTheWallToRows) {
  quadrature::Options rule;
  rule.tolerance = 1e-6;
  const surface::TubeWall periodic = surface::periodic_tube_wall(surface::outline(circle()), circle(), 3, 6);
  for (const surface::TubeWall& surface : {open(circle()), open(rectangle(1)), bent(), periodic}) {
    const Wall wall(surface, rule);
    Net f(wall.points().sites().rows(), 3);
    for (Eigen::Index i = 0; i < f.rows(); ++i) {
      const Vec3 x = wall.points().sites().row(i).transpose();
      const double phase = 2 * std::numbers::pi * x[0] / 3;
      f.row(i) << std::sin(phase) + x[1], x[2] * std::cos(phase), 0.3 - x[1] * x[2];
    }
    EXPECT_LT((wall.solve(wall.apply(f)) - f).norm() / f.norm(), 1e-5);  // tolerance of integrals times the condition number
  }
}

TEST(Reflections, OfAWallAreFoundWithItsImagesAlongTheAxis) {
  const auto order = [&](const surface::TubeWall& wall) { return reflections(wall, positions(wall, wall.sites)).order(); };
  surface::TubeOptions odd = circle();
  odd.azimuthal_elements = 7;
  EXPECT_EQ(order(open(circle())), 8);
  EXPECT_EQ(order(open(rectangle(1))), 8);
  EXPECT_EQ(order(open(odd)), 4);
  EXPECT_EQ(order(bent()), 2);
  EXPECT_EQ(order(surface::periodic_tube_wall(surface::outline(circle()), circle(), 3, 6)), 8);
}

// A dense matrix whose entries satisfy A(Q i, Q p) = Q A(i, p) Q^T, and its factors (4.37) for fields without and with a symmetry.
TEST(WallFactors, AreThoseOfTheWholeMatrix) {
  const surface::TubeWall wall = open(rectangle(1));
  const Net sites = positions(wall, wall.sites);
  const auto n = static_cast<int>(sites.rows());
  const surface::Symmetry group = reflections(wall, sites);
  const auto block = [&](int i, int p) -> Mat3 {
    const Vec3 d = (sites.row(i) - sites.row(p)).transpose(), at = sites.row(p).transpose();
    return std::exp(-d.squaredNorm()) * (Mat3::Identity() + d * d.transpose() + 0.3 * at * at.transpose());
  };
  Eigen::MatrixXd whole(3 * n, 3 * n);
  for (int i = 0; i < n; ++i)
    for (int p = 0; p < n; ++p) whole.block<3, 3>(3 * i, 3 * p) = block(i, p) + (i == p ? 3 : 0) * Mat3::Identity();
  Net f = Net::Random(n, 3);
  const auto as_vector = [](const Net& net) { return Eigen::Map<const Eigen::VectorXd>(net.data(), net.size()); };
  const Ranks ranks;
  for (const bool symmetric : {false, true}) {
    const surface::Symmetry fields = symmetric ? surface::Symmetry({group.images()[1]}, sites) : surface::Symmetry(n);
    WallFactors factors(group, fields);
    for (const int k : ranks.share(static_cast<int>(factors.fundamental().size())))
      for (int p = 0; p < n; ++p) {
        const int i = factors.fundamental()[static_cast<std::size_t>(k)];
        factors.add(i, p, whole.block<3, 3>(3 * i, 3 * p));
      }
    factors.factor(ranks);
    fields.complete(f);
    const Eigen::VectorXd of = whole * as_vector(f), transposed = whole.transpose() * as_vector(f);
    EXPECT_LT((factors.solve(Eigen::Map<const Net>(of.data(), n, 3)) - f).norm() / f.norm(), 1e-12);
    EXPECT_LT((factors.solve_transposed(Eigen::Map<const Net>(transposed.data(), n, 3)) - f).norm() / f.norm(), 1e-12);
  }
}

}  // namespace
}  // namespace tanktread::coupling
