#include "stokes/ambient_flow.hpp"

namespace tanktread::stokes {
namespace {

Mat3 four_roll(double a) {
  Mat3 gradient;
  gradient << 1 + a, 0, 1 - a, 0, 0, 0, -1 + a, 0, -1 - a;
  return gradient / 2;
}

Mat3 unit_gradient(const FlowOptions& options) {
  Mat3 gradient = Mat3::Zero();
  if (options.type == "simple shear") gradient(0, 2) = 1;
  if (options.type == "four-roll") return four_roll(options.roll_parameter.value());
  if (options.type == "planar hyperbolic") return four_roll(1);
  if (options.type == "uniaxial extension") gradient.diagonal() << -0.5, -0.5, 1;
  if (options.type == "linear") return options.gradient.value();
  return gradient;
}

}  // namespace

AmbientFlow::AmbientFlow(const FlowOptions& options)
    : gradient_(unit_gradient(options) * (options.type == "linear" ? 1. : options.shear_rate)), rate_(options.rate()) {
  if (options.type == "uniform") velocity_ = options.velocity.value();
}

}  // namespace tanktread::stokes
