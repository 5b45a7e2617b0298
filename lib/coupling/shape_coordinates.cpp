#include "coupling/shape_coordinates.hpp"

#include <algorithm>

#include "coupling/collocation.hpp"
#include "coupling/interface_motion.hpp"

namespace tanktread::coupling {

ShapeCoordinates::ShapeCoordinates(const spline::Space& space, std::span<const Particle> particles, const surface::Symmetry& symmetry, const Net& x)
    : symmetry_(symmetry), sites_(collocation_matrix(space)), collocation_({}, symmetry) {
  collocation_.factor(sites_);
  for (const int i : symmetry_.fundamental()) {
    const auto holds = [i](const Particle& particle) { return particle.block.holds(i); };
    if (std::ranges::find_if(particles, holds)->slides()) {
      all_.push_back({i, site_normal(space, x, space.collocation[static_cast<std::size_t>(i)])});
      continue;
    }
    for (int c = 0; c < 3; ++c)
      if (symmetry_.signs().rows() == 0 || symmetry_.signs()(i, c) != 0) all_.push_back({i, Vec3::Unit(c)});
  }
}

Net ShapeCoordinates::displacement(const Eigen::VectorXd& y) const {
  Net at_sites = Net::Zero(sites_.rows(), 3);
  for (Eigen::Index k = 0; k < size(); ++k) at_sites.row(all_[k].site) += y[k] * all_[k].direction.transpose();
  symmetry_.complete(at_sites);
  return collocation_.solve(at_sites);
}

Eigen::VectorXd ShapeCoordinates::coordinates(const Net& field) const {
  const Net at_sites = sites_ * field;
  Eigen::VectorXd y(size());
  for (Eigen::Index k = 0; k < size(); ++k) y[k] = at_sites.row(all_[k].site).dot(all_[k].direction);
  return y;
}

}  // namespace tanktread::coupling
