// The flow in an empty channel: a straight channel has the flow of the duct, and the flow rate is equal in all sections of a constricted channel. The
// response to a particle: a straight channel responds like the tube.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "system/solids/ducts/channel_flow.hpp"
#include "system/solids/shared_walls.hpp"
#include "system/solids/ducts/tube.hpp"

namespace tanktread::coupling {
namespace {

using std::numbers::pi;

surface::TubeOptions channel(const std::string& profile, int around) {
  surface::TubeOptions options;
  options.radius = 1;
  options.azimuthal_elements = around;
  options.channel.emplace();
  options.channel->profile = profile;
  options.channel->start = -2.8, options.channel->end = 2.8;
  if (profile == "constriction") options.channel->depth = 0.3, options.channel->half_length = 1;
  return options;
}

Net points() { return (Net(4, 3) << 0, 0, 0, 0.4, 0.3, -0.2, -0.7, 0, 0.6, 0.2, -0.65, 0.1).finished(); }

TEST(ChannelFlow, EqualsTheDuctFlowInAStraightChannel) {
  const ChannelFlow flow(channel("straight", 16), 1.7, 1.3, {});
  const stokes::DuctFlow duct(flow);
  const Net v = flow.velocities(points()), exact = duct.velocities(points());
  EXPECT_LT((v - exact).norm() / exact.norm(), 3e-4);
  EXPECT_NEAR(flow.extra_pressure_drop(), 0, 1e-3 * flow.pressure_drop());
  const Mat3 gradient = flow.gradients(points())[1], exact_gradient = duct.gradients(points())[1];
  EXPECT_LT((gradient - exact_gradient).norm() / exact_gradient.norm(), 3e-2);
}

TEST(ChannelFlow, HasTheSameFlowRateInEverySection) {
  const ChannelFlow flow(channel("constriction", 16), 1, 1, {});
  for (const double rate : flow.flow_rates_at({-1.2, -0.5, 0., 0.3, 0.8})) EXPECT_NEAR(rate / flow.flow_rate(), 1, 4e-4);
  EXPECT_GT(flow.extra_pressure_drop(), 0);
}

// A shared wall has the flow of the first channel. The flow of a channel with another mean velocity and viscosity is proportional to this flow.
TEST(ChannelFlow, OfASharedWallIsThatOfAWallOfItsOwn) {
  for (const double period : {0., 5.6}) {
    surface::TubeOptions options = channel("constriction", 12);
    if (period > 0) options.period = period, options.channel->start.reset(), options.channel->end.reset();
    const auto walls = std::make_shared<SharedWalls>();
    const ChannelFlow first(options, 1, 1, {}, {}, walls), second(options, 1.7, -0.3, {}, {}, walls), own(options, 1.7, -0.3, {});
    const Net before = first.velocities(points());
    EXPECT_EQ(first.wall(), second.wall());
    const Net shared = second.velocities(points()), alone = own.velocities(points());
    EXPECT_LT((shared - alone).norm(), 1e-12 * alone.norm()) << period;  // round-off
    EXPECT_NEAR(second.pressure_drop(), own.pressure_drop(), 1e-12 * std::abs(own.pressure_drop())) << period;
    EXPECT_LT((second.wall_traction() - own.wall_traction()).norm(), 1e-10 * own.wall_traction().norm()) << period;  // pressures cancel
    EXPECT_EQ(first.velocities(points()), before) << period;
  }
}

TEST(SharedWalls, AreEqualAndCountedOnce) {
  const surface::TubeOptions options = channel("constriction", 12);
  surface::TubeOptions other = options;
  other.channel->depth = 0.31;
  quadrature::Options finer;
  finer.tolerance = 1e-5;
  const auto walls = std::make_shared<SharedWalls>();
  const ChannelFlow one(options, 1, 1, {}, {}, walls), deeper(other, 1, 1, {}, {}, walls), sharper(options, 1, 1, finer, {}, walls);
  const ChannelFlow iterated(options, 1, 1, {}, {"iterative", 1e-8}, walls), again(options, 1, 2, {}, {}, walls);
  const auto wall = one.wall();
  const stokes::Evaluations of_one = walls->evaluations();
  EXPECT_EQ(again.wall(), wall);
  EXPECT_EQ(walls->evaluations().total(), of_one.total());
  for (const ChannelFlow* flow : {&deeper, &sharper, &iterated}) EXPECT_NE(flow->wall(), wall);
  EXPECT_GT(walls->evaluations().total(), of_one.total());
}

/// Near the ends of the constriction, where the curvature of the wall jumps, the shear stress falls up to the kink and rises after it, without
/// oscillation.
TEST(ChannelFlow, HasAShearStressWithoutOscillations) {
  const ChannelFlow flow(channel("constriction", 16), 1, 1, {});
  const surface::TubeWall& wall = *flow.fixed_wall();
  std::vector<double> shear;
  for (int e = 0; e < static_cast<int>(wall.space.elements.size()); e += 16)
    for (const double s : {0.2, 0.4, 0.6, 0.8}) {
      const surface::Point at = surface::point(wall.space, wall.net, {e, s, 0.5});
      const Vec3 f = surface::value(wall.space, flow.wall_traction(), {e, s, 0.5});
      if (at.x[0] > -1.6 && at.x[0] < -0.2) shear.push_back((f - f.dot(at.n) * at.n).norm());
    }
  int turns = 0;
  for (std::size_t k = 2; k < shear.size(); ++k) turns += (shear[k] - shear[k - 1]) * (shear[k - 1] - shear[k - 2]) < 0;
  EXPECT_GT(shear.size(), 30u);
  EXPECT_LE(turns, 1);
}

TEST(ChannelFlow, HasThePressureDropOfLubricationTheoryInASlenderChannel) {
  surface::TubeOptions options = channel("constriction", 12);
  options.channel->depth = 0.2, options.channel->half_length = 8;
  options.channel->start = -10.5, options.channel->end = 10.5;
  const ChannelFlow flow(options, 1, 1, {});
  double lubrication = 0;  // lubrication theory: 8 int (R^-4 - 1) ds
  constexpr int n = 2000;
  for (int k = 0; k < n; ++k) {
    const double s = -8 + 16. * (k + 0.5) / n;
    lubrication += 8 * 16. / n * (std::pow(flow.channel().section(s).factor[0], -4) - 1);
  }
  EXPECT_NEAR(flow.extra_pressure_drop() / lubrication, 1, 1e-2);
}

/// A sphere of radius 0.5 off the axis of the unit tube or of a straight channel, with a load and a velocity that conserves its volume.
struct InStraightChannel {
  spline::TMesh mesh = spline::cube(4);  // on cube(3) the interpolated flow of the channel has an error of 1e-4
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  Phases phases;
  Net x, f, v;
  std::unique_ptr<Tube> tube, channel;

  InStraightChannel(double ratio, int around) {
    surface::ParticleShape shape;
    shape.radius = 0.5, shape.center = Vec3(0.2, 0.1, -0.05);
    x = surface::resting_shape(space, mesh, shape);
    f = Net(x.rows(), 3), v = f;
    for (Eigen::Index i = 0; i < f.rows(); ++i) {
      f.row(i) << 1 + x(i, 1) * x(i, 1), x(i, 0), std::sin(3 * x(i, 2));
      v.row(i) << 1 + x(i, 2), x(i, 0) * x(i, 0), -x(i, 1);
    }
    const Net flux = surface::Geometry(space).volume_gradient(x);
    v -= flux.cwiseProduct(v).sum() / flux.squaredNorm() * flux;
    TubeParameters parameters;
    parameters.viscosity = 1.7;
    parameters.quadrature.tolerance = 1e-7;
    surface::TubeOptions options = coupling::channel("straight", around);
    options.channel->start = -pi + 0.2, options.channel->end = pi + 0.2, options.channel->axial_elements = around;
    channel = std::make_unique<Tube>(std::make_shared<const ChannelFlow>(options, 1.7, 1.3, parameters.quadrature), space, parameters, phases);
    options.channel.reset(), options.axial_elements = around;
    const stokes::DuctFlow flow(options, 1.7, 1.3);
    tube = std::make_unique<Tube>(surface::tube_wall(flow.outline(), options, 2 * pi), flow, space, parameters, phases);
    const Particle particle{.space = &space, .block = spline::whole(space), .viscosity_ratio = ratio};
    for (Tube* one : {tube.get(), channel.get()}) one->set_particles(x, {&particle, 1}), one->set_shape(x);
  }
};

TEST(Channel, RespondsLikeTheTubeIfItIsStraight) {
  for (const double ratio : {1., 5.}) {
    InStraightChannel s(ratio, 20);
    const Tube::Response tube = s.tube->respond(s.f, s.v), channel = s.channel->respond(s.f, s.v);
    EXPECT_LT((tube.velocity - channel.velocity).norm() / tube.velocity.norm(), 3e-4) << ratio;  // 1e-3 with 16 elements around, 9e-5 with 24
    EXPECT_NEAR(channel.pressure_drop / tube.pressure_drop, 1, 1e-4) << ratio;
    const Tube::Response alone = s.tube->respond({}, s.v), of_channel = s.channel->respond({}, s.v);
    EXPECT_NEAR(of_channel.pressure_drop, alone.pressure_drop, 1e-4 * std::abs(tube.pressure_drop)) << ratio;
  }
}

TEST(Channel, HasAFrozenResponse) {
  InStraightChannel s(5, 12);
  s.channel->freeze();
  const Net now = s.channel->respond(s.f, s.v).velocity;
  s.channel->set_shape(s.x + Eigen::RowVector3d(0.2, 0, 0.1).replicate(s.x.rows(), 1));
  EXPECT_LT((s.channel->frozen_response(s.f, s.v) - now).norm() / now.norm(), 1e-2);  // nine bits per entry
}

}  // namespace
}  // namespace tanktread::coupling
