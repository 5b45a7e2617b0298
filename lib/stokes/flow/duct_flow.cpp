#include "stokes/flow/duct_flow.hpp"

#include <stdexcept>

#include <Eigen/LU>

#include "stokes/flow/duct_boundary.hpp"

namespace tanktread::stokes {

std::unique_ptr<DuctProfile> duct_profile(const surface::TubeOptions& options, const surface::Outline& outline) {
  if (!options.exact_flow()) return std::make_unique<BoundaryProfile>(outline, options.flow_elements);
  if (options.section == "circle") return ellipse_profile(surface::Vec2::Constant(options.radius.value()));
  if (options.section == "ellipse") return ellipse_profile(options.semi_axes.value());
  if (options.section == "rectangle") return rectangle_profile(options.sides.value());
  throw std::logic_error(options.list() + "/section " + options.section + " has no formula for its flow");
}

DuctFlow::DuctFlow(const surface::TubeOptions& options, double viscosity, double mean_velocity)
    : DuctFlow(surface::outline(options), nullptr, viscosity, mean_velocity) {
  *this = DuctFlow(outline_, duct_profile(options, outline_), viscosity, mean_velocity);
}

DuctFlow::DuctFlow(surface::Outline outline, std::shared_ptr<const DuctProfile> profile, double viscosity, double mean_velocity)
    : outline_(std::move(outline)), profile_(std::move(profile)), viscosity_(viscosity), mean_velocity_(mean_velocity) {
  scale_ = profile_ ? mean_velocity * outline_.area() / profile_->flow_rate() : 0;
  pressure_gradient_ = viscosity * scale_;
}

DuctFlow::Samples DuctFlow::samples(const Net& x, bool derivatives) const {
  const Eigen::ArrayXd x2 = x.col(1), x3 = x.col(2);
  Samples s{Eigen::ArrayXd(x.rows()), Eigen::ArrayXd(derivatives ? x.rows() : 0), Eigen::ArrayXd(derivatives ? x.rows() : 0)};
  profile_->evaluate(static_cast<int>(x.rows()), x2.data(), x3.data(), s.u.data(), derivatives ? s.u2.data() : nullptr, s.u3.data());
  s.u *= scale_, s.u2 *= scale_, s.u3 *= scale_;
  return s;
}

Net DuctFlow::velocities(const Net& x) const {
  Net v = Net::Zero(x.rows(), 3);
  v.col(0) = samples(x, false).u;
  return v;
}

std::vector<Mat3> DuctFlow::gradients(const Net& x) const {
  const Samples s = samples(x, true);
  std::vector<Mat3> out(static_cast<std::size_t>(x.rows()), Mat3::Zero());
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    out[static_cast<std::size_t>(i)](0, 1) = s.u2[i], out[static_cast<std::size_t>(i)](0, 2) = s.u3[i];
  return out;
}

Net DuctFlow::tractions(const Net& x, const Net& n) const {
  const Samples s = samples(x, true);
  Net f(x.rows(), 3);
  const Eigen::ArrayXd minus_p = pressure_gradient_ * x.col(0).array(), mu2 = viscosity_ * s.u2, mu3 = viscosity_ * s.u3;
  f.col(0) = minus_p * n.col(0).array() + mu2 * n.col(1).array() + mu3 * n.col(2).array();
  f.col(1) = minus_p * n.col(1).array() + mu2 * n.col(0).array();
  f.col(2) = minus_p * n.col(2).array() + mu3 * n.col(0).array();
  return f;
}

Vec3 DuctFlow::velocity(const Vec3& x) const { return velocities(Net(x.transpose())).row(0); }
Mat3 DuctFlow::gradient(const Vec3& x) const { return gradients(Net(x.transpose()))[0]; }

DuctFlow::Maximum DuctFlow::maximum() const {
  constexpr int grid = 40;
  const auto [low, high] = outline_.box();
  Net x(0, 3);
  for (int j = 1; j < grid; ++j)
    for (int i = 1; i < grid; ++i) {
      const surface::Vec2 p = low + surface::Vec2((high - low).array() * Eigen::Array2d(i, j) / grid);
      if (!outline_.inside(p)) continue;
      x.conservativeResize(x.rows() + 1, 3);
      x.row(x.rows() - 1) << 0, p[0], p[1];
    }
  Eigen::Index best;
  samples(x, false).u.maxCoeff(&best);
  Vec3 place = x.row(best);
  const double step = 1e-4 * radius();
  for (int k = 0; k < 20; ++k) {
    const auto slope = [&](double d2, double d3) -> surface::Vec2 { return gradient(Vec3(place + Vec3(0, d2, d3))).row(0).tail<2>(); };
    Eigen::Matrix2d hessian;
    hessian << (slope(step, 0) - slope(-step, 0)) / (2 * step), (slope(0, step) - slope(0, -step)) / (2 * step);
    const surface::Vec2 move = -hessian.lu().solve(slope(0, 0));
    place.tail<2>() += move;
    if (move.norm() < 1e-12 * radius()) break;
  }
  return {place.tail<2>(), velocity(place)[0]};
}

}  // namespace tanktread::stokes
