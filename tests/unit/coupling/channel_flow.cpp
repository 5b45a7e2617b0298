// The flow of an empty channel: a straight one's is that of the duct, and the same fluid passes every section of another.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "coupling/channel_flow.hpp"

namespace tanktread::coupling {
namespace {

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

TEST(ChannelFlow, IsTheDuctsWhereItIsStraight) {
  const ChannelFlow flow(channel("straight", 16), 1.7, 1.3, {});
  const stokes::DuctFlow duct(flow);
  const Net v = flow.velocities(points()), exact = duct.velocities(points());
  EXPECT_LT((v - exact).norm() / exact.norm(), 3e-4);
  EXPECT_NEAR(flow.extra_pressure_drop(), 0, 1e-3 * flow.pressure_drop());
  const Mat3 gradient = flow.gradients(points())[1], exact_gradient = duct.gradients(points())[1];
  EXPECT_LT((gradient - exact_gradient).norm() / exact_gradient.norm(), 3e-2);
}

TEST(ChannelFlow, PassesEverySectionAlike) {
  const ChannelFlow flow(channel("constriction", 16), 1, 1, {});
  for (const double s : {-1.2, -0.5, 0., 0.3, 0.8}) EXPECT_NEAR(flow.flow_rate_at(s) / flow.flow_rate(), 1, 4e-4) << s;
  EXPECT_GT(flow.extra_pressure_drop(), 0);
}

TEST(ChannelFlow, CostsInASlenderChannelWhatLubricationSays) {
  surface::TubeOptions options = channel("constriction", 12);
  options.channel->depth = 0.2, options.channel->half_length = 8;
  options.channel->start = -10.5, options.channel->end = 10.5;
  const ChannelFlow flow(options, 1, 1, {});
  double lubrication = 0;  // 8 int (R^-4 - 1) ds
  constexpr int n = 2000;
  for (int k = 0; k < n; ++k) {
    const double s = -8 + 16. * (k + 0.5) / n;
    lubrication += 8 * 16. / n * (std::pow(flow.channel().section(s).factor[0], -4) - 1);
  }
  EXPECT_NEAR(flow.extra_pressure_drop() / lubrication, 1, 1e-2);
}

}  // namespace
}  // namespace tanktread::coupling
