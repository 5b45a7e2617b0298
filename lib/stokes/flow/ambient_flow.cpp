#include "stokes/flow/ambient_flow.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "base/small_matrices.hpp"

namespace tanktread::stokes {
namespace {

Mat3 four_roll(double a) {
  Mat3 gradient;
  gradient << 1 + a, 0, 1 - a, 0, 0, 0, -1 + a, 0, -1 - a;
  return gradient / 2;
}

/// Returns the velocity gradient of the flow for the shear rate 1; 0 for flows that are set elsewhere.
Mat3 unit_gradient(const FlowOptions& options) {
  constexpr std::array<std::string_view, 4> elsewhere{"quiescent", "uniform", "parabolic", "duct"};
  if (options.type == "simple shear") return Vec3::UnitX() * Vec3::UnitZ().transpose();
  if (options.type == "four-roll") return four_roll(options.roll_parameter.value());
  if (options.type == "planar hyperbolic") return four_roll(1);
  if (options.type == "uniaxial extension") return Vec3(-0.5, -0.5, 1).asDiagonal();
  if (options.type == "linear") return options.gradient.value();
  if (!options.user && std::ranges::find(elsewhere, options.type) == elsewhere.end())
    throw std::logic_error("no velocity is defined for Flow/type " + options.type);
  return Mat3::Zero();
}

}  // namespace

AmbientFlow::Field AmbientFlow::field(const FlowOptions& options) {
  Field field;
  field.gradient = unit_gradient(options) * options.shear_rate;  // shear_rate is 1 for flow types without the key `shear rate`
  if (options.type == "uniform") field.velocity = options.velocity.value();
  if (options.type == "parabolic") {
    field.velocity[0] = options.maximum_velocity.value();
    field.direction = Vec3::Unit(0);
    const double bend = -options.maximum_velocity.value() / (options.half_width.value() * options.half_width.value());
    field.curvature.diagonal() << 0, options.profile == "round" ? bend : 0, bend;
  }
  if (options.plates) fit_to_plates(options, field);
  return field;
}

/// Adds the uniform or linear flow (2.48) that makes the velocity at each plate equal to the given velocity of the plate. At a plate without a given
/// velocity, the added flow is 0. Between two plates, also adds the flow that the pressure gradient drives.
void AmbientFlow::fit_to_plates(const FlowOptions& options, Field& field) {
  const Plates& plates = *options.plates;
  const Vec3& n = plates.normal;
  const auto at = [&](const Vec3& x) -> Vec3 {
    if (options.user) return options.user->velocity(x);
    return field.velocity + field.gradient * x + x.dot(field.curvature * x) * field.direction;
  };
  const auto missing = [&](const std::optional<Vec3>& velocity, const Vec3& x) -> Vec3 { return velocity ? Vec3(*velocity - at(x)) : Vec3::Zero(); };
  const Vec3 first = missing(plates.velocity, plates.point);
  if (!plates.distance) {
    field.velocity += first;
    return;
  }
  const double d = *plates.distance, bottom = n.dot(plates.point);
  const Vec3 slope = (missing(plates.second_velocity, plates.point + d * n) - first) / d;
  field.velocity += first - bottom * slope;
  field.gradient += slope * n.transpose();
  if (!options.pressure_gradient) return;
  const Vec3 bend = *options.pressure_gradient / (2 * options.viscosity);
  field.velocity += bottom * (bottom + d) * bend;
  field.gradient -= (2 * bottom + d) * bend * n.transpose();
  field.direction = bend;
  field.curvature = n * n.transpose();
}

AmbientFlow::AmbientFlow(const FlowOptions& options, std::shared_ptr<const DuctFlow> duct)
    : duct_(std::move(duct)), user_(options.user), history_(options.history), steady_(field(options)), field_(steady_), rate_(options.rate()) {
  if ((options.type == "duct") != static_cast<bool>(duct_))
    throw std::invalid_argument("the flow of type `duct`, and no other, needs a duct");
}

bool AmbientFlow::set_time(double time, double start) {
  if (!history_) return false;
  const FlowHistory::Moment moment = history_->at(time, start);
  if (moment.amplitude == moment_.amplitude && moment.turn == moment_.turn) return false;
  moment_ = moment;
  field_ = turned(moment.turn, moment.amplitude).field_;
  return true;
}

double AmbientFlow::next_kink(double time) const { return history_ ? history_->next_kink(time) : std::numeric_limits<double>::infinity(); }

Mat3 AmbientFlow::deformation(double time) const {
  if (!affine()) return Mat3::Identity();
  const Mat3 steady = user_ ? Mat3(user_->gradient(Vec3::Zero()) + steady_.gradient) : steady_.gradient;
  return history_ ? history_->deformation(steady, time) : exponential(time * steady);
}

/// A symmetry at seven angles holds at every angle, because a polynomial flow is a polynomial of degree three in the sine and cosine of the angle,
/// which seven values determine. A registered flow, which may be of any form, is compared at 61 angles.
std::vector<AmbientFlow> AmbientFlow::rotated_copies() const {
  if (!history_ || !history_->angles) return {*this};
  std::vector<AmbientFlow> all;
  const int n = user_ ? 61 : 7;
  for (int k = 0; k < n; ++k) all.push_back(turned(history_->turn(360. / n * k), 1));
  return all;
}

/// Returns the flow at amplitude 1 rotated by Q about the origin and multiplied by the amplitude a.
AmbientFlow AmbientFlow::turned(const Mat3& q, double a) const {
  AmbientFlow flow = *this;
  flow.moment_ = {a, q};
  flow.field_ = {a * q * steady_.velocity, a * q * steady_.gradient * q.transpose(), a * q * steady_.direction,
                 q * steady_.curvature * q.transpose()};
  return flow;
}

Vec3 AmbientFlow::velocity(const Vec3& x) const {
  if (duct_) return moment_.amplitude * duct_->velocity(x);
  Vec3 v = field_.velocity + field_.gradient * x;
  if (user_) v += moment_.amplitude * moment_.turn * user_->velocity(moment_.turn.transpose() * x);
  return field_.direction.isZero(0) ? v : Vec3(v + x.dot(field_.curvature * x) * field_.direction);
}

Mat3 AmbientFlow::gradient(const Vec3& x) const {
  if (duct_) return moment_.amplitude * duct_->gradient(x);
  Mat3 gradient = field_.gradient;
  if (user_) gradient += moment_.amplitude * moment_.turn * user_->gradient(moment_.turn.transpose() * x) * moment_.turn.transpose();
  return field_.direction.isZero(0) ? gradient : Mat3(gradient + 2 * field_.direction * (field_.curvature * x).transpose());
}

Net AmbientFlow::velocities(const Net& x) const {
  if (duct_) return moment_.amplitude * duct_->velocities(x);
  if (user_) {
    Net v(x.rows(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i) v.row(i) = velocity(x.row(i).transpose()).transpose();
    return v;
  }
  Net v = (x * field_.gradient.transpose()).rowwise() + field_.velocity.transpose();
  if (!affine()) v += (x * field_.curvature).cwiseProduct(x).rowwise().sum() * field_.direction.transpose();
  return v;
}

std::vector<Mat3> AmbientFlow::gradients(const Net& x) const {
  std::vector<Mat3> all;
  if (duct_) {
    all = duct_->gradients(x);
    for (Mat3& gradient : all) gradient *= moment_.amplitude;
    return all;
  }
  for (Eigen::Index i = 0; i < x.rows(); ++i) all.push_back(gradient(x.row(i).transpose()));
  return all;
}

}  // namespace tanktread::stokes
