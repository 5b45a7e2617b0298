#include "stokes/ambient_flow.hpp"

#include <stdexcept>

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

AmbientFlow::AmbientFlow(const FlowOptions& options, std::shared_ptr<const DuctFlow> duct)
    : duct_(std::move(duct)),
      gradient_(unit_gradient(options) * (options.type == "linear" ? 1. : options.shear_rate)),
      rate_(options.rate()) {
  if (options.type == "uniform") velocity_ = options.velocity.value();
  if ((options.type == "duct") != static_cast<bool>(duct_))
    throw std::invalid_argument("the flow of type `duct`, and no other, needs a duct");
}

Net AmbientFlow::velocities(const Net& x) const {
  if (duct_) return duct_->velocities(x);
  return (x * gradient_.transpose()).rowwise() + velocity_.transpose();
}

std::vector<Mat3> AmbientFlow::gradients(const Net& x) const {
  if (duct_) return duct_->gradients(x);
  return std::vector<Mat3>(static_cast<std::size_t>(x.rows()), gradient_);
}

}  // namespace tanktread::stokes
