#include "stokes/flow/duct_flow.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "stokes/flow/ambient_flow.hpp"
#include "surface/walls/channel.hpp"

namespace tanktread::stokes {
namespace duct_flow_test {

constexpr double pi = std::numbers::pi;

surface::TubeOptions circle(double radius) {
  surface::TubeOptions tube;
  tube.section = "circle", tube.radius = radius;
  return tube;
}

surface::TubeOptions ellipse(double a, double b) {
  surface::TubeOptions tube;
  tube.section = "ellipse", tube.semi_axes = surface::Vec2(a, b);
  return tube;
}

surface::TubeOptions rectangle(double w, double h) {
  surface::TubeOptions tube;
  tube.section = "rectangle", tube.sides = surface::Vec2(w, h);
  return tube;
}

TEST(DuctFlow, IsPoiseuilleFlowInACircle) {
  const DuctFlow flow(circle(1.5), 2, 3);
  EXPECT_NEAR(flow.velocity(Vec3(7, 0.3, -0.4))[0], 6 * (1 - 0.25 / 2.25), 1e-13) << "twice the mean on the axis";
  EXPECT_NEAR(flow.pressure_gradient(), 8 * 2 * 3 / (1.5 * 1.5), 1e-12);
  EXPECT_NEAR(flow.flow_rate(), 3 * pi * 1.5 * 1.5, 1e-12);
  EXPECT_NEAR(flow.radius(), 1.5, 1e-14);
  EXPECT_LT(flow.maximum().place.norm(), 1e-9);
  EXPECT_NEAR(flow.maximum().velocity, 6, 1e-12);
}

TEST(DuctFlow, HasTheKnownFlowRates) {
  EXPECT_NEAR(duct_profile(ellipse(1, 0.5), surface::outline(ellipse(1, 0.5)))->flow_rate(), pi * 0.125 / 5, 1e-15);
  const auto rate = [](double w, double h) { return rectangle_profile({w, h})->flow_rate(); };
  EXPECT_NEAR(rate(2, 2) / 16, 0.035144253739, 1e-12);  // tolerance: rounding of the known value, here and below
  EXPECT_NEAR(rate(2, 1), 2 * 0.0571704193, 2e-10);
  EXPECT_NEAR(rate(1, 3), 3 * 0.0658292328, 3e-10);
  EXPECT_NEAR(rate(5, 1), 5 * 0.0728291885, 5e-10);
}

/// Checks gradient, momentum equation and traction of the flow at several points against finite differences.
void expect_consistent(const DuctFlow& flow) {
  const auto [low, high] = flow.outline().box();
  const double h = 1e-4 * flow.radius();
  for (const double s : {0.07, 0.3, 0.5, 0.8})
    for (const double t : {0.06, 0.5, 0.7, 0.94}) {
      const Vec3 x(0.3, low[0] + s * (high[0] - low[0]), low[1] + t * (high[1] - low[1]));
      if (flow.outline().distance(x.tail<2>()) < 10 * h) continue;
      const auto at = [&](int c, double d) { return Vec3(x + d * Vec3::Unit(c)); };
      const Mat3 l = flow.gradient(x);
      for (int c : {1, 2})
        EXPECT_NEAR(l(0, c), (flow.velocity(at(c, h)) - flow.velocity(at(c, -h)))[0] / (2 * h), 1e-6);  // h^2 u''' and round-off/h
      const double laplacian = (flow.gradient(at(1, h)) - flow.gradient(at(1, -h)))(0, 1) / (2 * h) +
                               (flow.gradient(at(2, h)) - flow.gradient(at(2, -h)))(0, 2) / (2 * h);
      EXPECT_NEAR(flow.viscosity() * laplacian, -flow.pressure_gradient(), 1e-5 * flow.pressure_gradient()) << x.transpose();
      const Vec3 n = Vec3(1, 2, -2) / 3;
      const Vec3 traction = flow.pressure_gradient() * x[0] * n + flow.viscosity() * (l + l.transpose()) * n;
      EXPECT_LT((Vec3(flow.tractions(x.transpose(), n.transpose()).row(0)) - traction).norm(), 1e-12 * traction.norm());
    }
}

surface::TubeOptions by_elements(surface::TubeOptions tube) {
  tube.flow = "boundary elements";
  return tube;
}

surface::TubeOptions capillary() {
  surface::TubeOptions tube;
  tube.section = "file", tube.outline = {SOURCE_DIRECTORY "/inputs/capillary_outline.csv"};
  return tube;
}

/// Returns an example of a tube with the cross-section `word`.
surface::TubeOptions example(const std::string& word) {
  if (word == "circle") return circle(1.2);
  if (word == "ellipse") return ellipse(1.3, 0.8);
  if (word == "rectangle") return rectangle(1.7, 2);
  if (word == "file") return capillary();
  throw std::logic_error("add an example of the cross-section " + word);
}

/// Expects that two outlines have equal areas and equal distances from several points.
void expect_equal(const surface::Outline& one, const surface::Outline& other, const std::string& word) {
  EXPECT_NEAR(one.area(), other.area(), 1e-12) << word;
  for (const surface::Vec2& p : {surface::Vec2(0, 0), surface::Vec2(0.3, -0.2), surface::Vec2(-0.1, 0.5), surface::Vec2(2, 3)})
    EXPECT_NEAR(one.distance(p), other.distance(p), 1e-12) << word << " " << p.transpose();
}

TEST(DuctFlow, AndTheOutlineAreKnownForEachSection) {
  for (const std::string& word : surface::duct_sections) {
    const surface::TubeOptions tube = example(word);
    tube.check();
    const surface::Outline outline = surface::outline(tube);
    if (tube.outline)
      EXPECT_TRUE(std::isinf(tube.half_width())) << word << ": not known before the file is read";
    else
      EXPECT_NEAR(tube.half_width(), outline.distance(surface::Vec2::Zero()), 1e-12) << word;

    surface::TubeOptions narrowed = tube;
    narrowed.channel.emplace();
    narrowed.channel->depth = 0.4, narrowed.channel->half_length = 3;
    for (const std::string directions : {"x2", "x3", "x2 x3"}) {
      narrowed.channel->directions = directions;
      const surface::Channel channel(narrowed);
      const surface::Outline middle = channel.outline(0);
      EXPECT_NEAR(middle.area(), (directions == "x2 x3" ? 0.36 : 0.6) * outline.area(), 1e-12) << word;
      const surface::TubeOptions section = channel.tube(0);
      expect_equal(surface::outline(section), section.outline ? outline : middle, word);  // the outline of a file is not scaled
    }

    if (!tube.exact_flow()) continue;
    const DuctFlow exact(tube, 1.3, 0.7), numerical(by_elements(tube), 1.3, 0.7);
    // Measured errors of 96 boundary elements: 3.3e-9 in a rectangle, 8e-12 in an ellipse.
    EXPECT_NEAR(numerical.pressure_gradient() / exact.pressure_gradient(), 1, 1e-8) << word;
    for (const double share : {0., 0.3, 0.8}) {
      const surface::Vec2 p = share * outline.point(0, 0.7);
      EXPECT_NEAR(numerical.velocity(Vec3(0, p[0], p[1]))[0], exact.velocity(Vec3(0, p[0], p[1]))[0], 1e-8) << word << " " << share;
    }
  }
}

TEST(DuctFlow, ThrowsForASectionWithoutADefinition) {
  surface::TubeOptions star = rectangle(1, 2);
  star.section = "star";
  EXPECT_THROW(star.exact_flow(), std::logic_error);
  EXPECT_THROW(duct_profile(star, surface::outline(rectangle(1, 2))), std::logic_error);
}

TEST(DuctFlow, SatisfiesItsEquationAndHasTheGradientOfItsVelocity) {
  expect_consistent(DuctFlow(capillary(), 1.3, 0.7));
  expect_consistent(DuctFlow(by_elements(rectangle(1, 3)), 1.3, 0.7));
  expect_consistent(DuctFlow(circle(1), 1.3, 0.7));
  expect_consistent(DuctFlow(ellipse(1.2, 0.9), 1.3, 0.7));
  expect_consistent(DuctFlow(rectangle(1, 3), 1.3, 0.7));
  expect_consistent(DuctFlow(rectangle(2, 2), 1.3, 0.7));
}

TEST(DuctFlow, VanishesOnTheWallOfARectangle) {
  const DuctFlow flow(rectangle(2, 3), 1, 1);
  const auto& outline = flow.outline();
  for (int k = 0; k < 4; ++k)
    for (const double s : {1e-3, 0.2, 0.5, 0.93}) {
      const surface::Vec2 p = outline.point(k, s * outline.side_length(k));
      EXPECT_LT(std::abs(flow.velocity(Vec3(0, p[0], p[1]))[0]), 1e-12);
    }
  EXPECT_NEAR(DuctFlow(rectangle(1, 1), 1, 0.035144253739).maximum().velocity, 0.073671353282, 1e-11);  // rounding of the known values
}

TEST(DuctFlow, HasTheRequestedMeanVelocity) {
  const DuctFlow flow(capillary(), 1, 0.7);
  const auto [low, high] = flow.outline().box();
  constexpr int grid = 100;  // a sum over the points of a grid, of second order because v vanishes on the wall
  Net x(grid * grid, 3);
  Eigen::Index n = 0;
  for (int j = 0; j < grid; ++j)
    for (int i = 0; i < grid; ++i) {
      const surface::Vec2 p = low + surface::Vec2((high - low).array() * Eigen::Array2d(i + 0.5, j + 0.5) / grid);
      if (flow.outline().inside(p)) x.row(n++) << 0, p[0], p[1];
    }
  const double flow_rate = flow.velocities(x.topRows(n)).col(0).sum() * (high - low).prod() / (grid * grid);
  EXPECT_NEAR(flow_rate / flow.flow_rate(), 1, 4e-4);
  EXPECT_NEAR(flow.radius(), 1, 1e-9) << "the shipped outline is made so";
  const auto top = flow.maximum();
  EXPECT_GE(top.velocity, flow.velocities(x.topRows(n)).maxCoeff());
  EXPECT_LT(flow.gradient(Vec3(0, top.place[0], top.place[1])).norm(), 1e-9);
}

TEST(DuctFlow, IsTheFlowOfTypeDuct) {
  FlowOptions options;
  options.type = "duct", options.mean_velocity = 2, options.shear_rate = 1;
  const auto duct = std::make_shared<const DuctFlow>(circle(0.5), 1, 2);
  const AmbientFlow flow(options, duct);
  const Vec3 x(3, 0.1, 0.2);
  EXPECT_EQ(flow.velocity(x), duct->velocity(x));
  EXPECT_EQ(flow.gradient(x), duct->gradient(x));
  EXPECT_EQ(flow.velocities(x.transpose()).row(0), duct->velocity(x).transpose());
  EXPECT_NEAR(flow.rate(), 4, 1e-13) << "mean velocity over R_T";
  EXPECT_EQ(options.speed(0.3), 2) << "of Ca";
  EXPECT_FALSE(flow.affine());
  EXPECT_THROW(AmbientFlow{options}, std::invalid_argument);
}

}  // namespace duct_flow_test
}  // namespace tanktread::stokes
