// Tests of channels: sections along a straight or bent centre line, and the wall surface through them.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "surface/geometry.hpp"
#include "surface/symmetry.hpp"
#include "surface/walls/tube_wall.hpp"

namespace tanktread::surface {
namespace {

using std::numbers::pi;

TubeOptions constriction() {
  TubeOptions o;
  o.radius = 1;
  o.azimuthal_elements = 12;
  o.channel.emplace();
  o.channel->depth = 0.5, o.channel->half_length = 2;
  return o;
}

TubeOptions step() {
  TubeOptions o = constriction();
  o.section = "rectangle", o.radius.reset(), o.sides = Eigen::Vector2d(4, 4);
  o.channel->profile = "step", o.channel->directions = "x3", o.channel->half_length = 1, o.channel->corner_radius = 0.2;
  return o;
}

TubeOptions bend() {
  TubeOptions o = constriction();
  o.channel->bend_radius = 3, o.channel->bend_start = 1, o.channel->bend_angle = 90;
  return o;
}

TEST(Channel, HasTheRadiusOfItsProfile) {
  const Channel round(constriction());
  for (const double s : {-3., -1.7, 0., 0.4, 2.})
    EXPECT_NEAR(round.section(s).factor[0], std::abs(s) < 2 ? 1 - (1 + std::cos(pi * s / 2)) / 4 : 1, 1e-14);
  const Channel slit(step());
  EXPECT_NEAR(slit.section(0).factor[1], 0.5, 1e-14);
  EXPECT_NEAR(slit.section(0).factor[0], 1, 1e-14);
  EXPECT_NEAR(slit.section(-0.9).factor[1], (1 + 0.2 - std::sqrt(0.04 - 0.01)) / 2, 1e-9);   // the arc of the rounded edge
  EXPECT_NEAR(slit.section(1.1).factor[1], (2 - 0.2 + std::sqrt(0.04 - 0.01)) / 2, 1e-9);
  EXPECT_NEAR(slit.smallest_radius(), 1, 1e-12);
}

TEST(Channel, ThrowsForAProfileOrSectionWithoutADefinition) {
  TubeOptions options = constriction();
  options.channel->profile = "zigzag";
  EXPECT_THROW(Channel{options}, std::logic_error);
  options = constriction(), options.section = "star";
  EXPECT_THROW(options.half_width(), std::logic_error);
  EXPECT_THROW(outline(options), std::logic_error);
}

TEST(Channel, FindsThePositionOfAPointInTheChannel) {
  for (const TubeOptions& options : {constriction(), step(), bend()}) {
    const Channel channel(options);
    for (const double s : {-3., -0.5, 0.3, 1.5, 4., 7.})
      for (const Vec2& y : {Vec2(0.3, -0.2), Vec2(-0.5, 0.6)}) {
        const Channel::Section at = channel.section(s);
        const Vec3 x = at.centre + at.factor[0] * y[0] * at.normal + at.factor[1] * y[1] * Vec3::UnitZ();
        EXPECT_LT((channel.coordinates(x) - Vec3(s, y[0], y[1])).norm(), 1e-9) << s;
      }
    EXPECT_FALSE(channel.inside(Vec3(-3, 0, 2.5)));
    EXPECT_FALSE(channel.inside(Vec3(channel.start() - 0.1, 0, 0)));
    EXPECT_TRUE(channel.inside(Vec3(-3, 0.3, 0.6)));
  }
}

TEST(Channel, HasAWallWithItsMirrorPlanes) {
  TubeOptions oblong = step();
  oblong.sides = Eigen::Vector2d(4.8, 4), oblong.azimuthal_elements = 24;
  for (const TubeOptions& options : {constriction(), step(), oblong}) {
    const TubeWall wall = channel_wall(std::make_shared<const Channel>(options), options.azimuthal_elements);
    const Net* nets[] = {&wall.net};
    for (const Vec3& signs : {Vec3(1, -1, 1), Vec3(1, 1, -1)}) {
      const auto found = image(wall.space, nets, signs);
      ASSERT_TRUE(found) << options.section << ": two points are in each corner, one of either side";
      std::vector<int> often(found->point.size());
      for (const int a : found->point) ++often[static_cast<std::size_t>(a)];
      EXPECT_EQ(std::ranges::count(often, 1), wall.space.n_points);
    }
  }
}

TEST(Channel, HasAWallThroughItsSections) {
  double before = 0;
  for (const int m : {12, 24}) {
    TubeOptions options = constriction();
    options.azimuthal_elements = m;
    const auto channel = std::make_shared<const Channel>(options);
    const TubeWall wall = channel_wall(channel, m);
    double error = 0;
    for (int e = 0; e < static_cast<int>(wall.space.elements.size()); ++e) {
      const Point p = point(wall.space, wall.net, {e, 0.3, 0.6});
      EXPECT_LT(p.n.dot(Vec3(0, p.x[1], p.x[2])), 0);  // normal into the fluid
      const double off = std::abs(p.x.tail<2>().norm() - channel->section(p.x[0]).factor[0]);
      error = std::max(error, off);  // also near the jumps of the curvature at |s| = 2, because knots are there
    }
    if (before > 0) {
      EXPECT_GT(std::log2(before / error), 3.3);
    }
    before = error;
  }
  EXPECT_LT(before, 1e-4);
}

TEST(Channel, HasCreasesWhereItsCurvatureJumps) {
  const std::vector<double> ends = {-2, 2}, bends = {-2, 2, 3, 3 + 3 * pi / 2};
  TubeOptions straight_first = bend();
  straight_first.channel->bend_start = 3;
  for (const auto& [options, places] : {std::pair(constriction(), ends), std::pair(straight_first, bends)}) {
    const Channel channel(options);
    const std::vector<double> knots = channel.knots(channel.elements());
    for (const double place : places) EXPECT_EQ(std::ranges::count(knots, place), 3) << place;
    EXPECT_EQ(knots.size(), static_cast<std::size_t>(channel.elements()) + 1 + 2 * places.size());
    EXPECT_TRUE(std::ranges::is_sorted(knots));
    const TubeWall wall = channel_wall(std::make_shared<const Channel>(options), 12);
    EXPECT_EQ(wall.n_along, channel.elements() + 3 + 2 * static_cast<int>(places.size()));
    for (const auto& sites : wall.space.collocation)
      for (const spline::Site& site : sites)
        EXPECT_LT((value(wall.space, wall.net, site) - value(wall.space, wall.net, sites.front())).norm(), 1e-12);
    for (int e = 0; e + 12 < static_cast<int>(wall.space.elements.size()); ++e)  // the normal is continuous between e and e + 12
      EXPECT_LT((point(wall.space, wall.net, {e, 1, 0.5}).n - point(wall.space, wall.net, {e + 12, 0, 0.5}).n).norm(), 1e-7);
  }
  EXPECT_EQ(Channel(step()).knots(40).size(), 41u) << "the sides of a step would have many points at one place";
  EXPECT_EQ(Channel(constriction()).knots(1).size(), 2u) << "too few elements";
}

TEST(Channel, HasAWallThatBends) {
  const auto channel = std::make_shared<const Channel>(bend());
  const TubeWall wall = channel_wall(channel, 24);
  for (int e = 0; e < static_cast<int>(wall.space.elements.size()); ++e) {
    const Vec3 at = channel->coordinates(value(wall.space, wall.net, {e, 0.4, 0.3}));
    EXPECT_NEAR(at.tail<2>().norm(), 1, 3e-3);
  }
}

void refused(const TubeOptions& options, const std::string& words) {
  try {
    Channel channel(options);
    ADD_FAILURE() << "not refused: " << words;
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(Channel, IsRejectedIfItIsWrong) {
  TubeOptions closed = constriction(), short_end = constriction(), tight = bend(), round = step();
  closed.channel->depth = 0.999;
  refused(closed, "The channel is closed at s");
  short_end.channel->start = -3;
  refused(short_end, "1.7 R_T");
  tight.channel->bend_radius = 1.01;
  refused(tight, "Channel/bend radius");
  round.channel->corner_radius = 0.7;
  refused(round, "Channel/corner radius");
}

}  // namespace
}  // namespace tanktread::surface
