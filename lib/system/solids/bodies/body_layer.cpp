#include "system/solids/bodies/body_layer.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "surface/geometry.hpp"
#include "system/parallel/stop_together.hpp"

namespace tanktread::coupling {

namespace {

std::vector<Particle> without_others(std::span<const Particle> bodies) {
  std::vector<Particle> placed(bodies.begin(), bodies.end());
  set_blocks(placed);
  return placed;
}

spline::Space common_space(std::span<const Particle> bodies) {
  std::vector<const spline::Space*> spaces;
  for (const Particle& body : bodies) spaces.push_back(body.space);
  return spline::stacked(spaces);
}

}  // namespace

BodyLayer::BodyLayer(std::span<const Particle> bodies, const CapsuleParameters& parameters, std::span<const int> own, const Ranks& ranks)
    : bodies_(without_others(bodies)),
      space_(common_space(bodies_)),
      viscosity_(parameters.viscosity),
      ranks_(ranks),
      layer_(stokes::Layer::Kernel::single_layer, space_, space_.collocation, parameters.quadrature) {
  for (const Particle& body : bodies) {
    in_.push_back(body.block);
    for (int a = body.block.first_point; a < body.block.first_point + body.block.n_points; ++a) {
      points_.push_back(a);
      rows_.insert(rows_.end(), {3 * a, 3 * a + 1, 3 * a + 2});
    }
  }
  std::ranges::set_difference(own, points_, std::back_inserter(others_));
  if (!others_.empty()) beyond_.emplace(stokes::Layer::Kernel::single_layer, space_, stokes::Sites(), parameters.quadrature);
  if (!parameters.medium) return;
  layer_.set_medium(*parameters.medium);
  if (beyond_) beyond_->set_medium(*parameters.medium);
}

/// Sets the two vectors of the regularising term (2.10) of each body. flux_: flux vector b = dV/dx, with the volume V. outward_: s (R c)/(b.c), with
/// a scale s and the values R c of a velocity field c at the sites. Any field c with nonzero flux b.c makes the system regular; here c is the radial
/// field about the mean of the sites.
void BodyLayer::make_regular(const Net& x) {
  flux_ = outward_ = Net::Zero(x.rows(), 3);
  for (std::size_t p = 0; p < bodies_.size(); ++p) {
    const Net own = in_[p].rows(at_), outward = own.rowwise() - own.colwise().mean();
    in_[p].rows(flux_) = surface::Geometry(*bodies_[p].space).volume_gradient(in_[p].rows(x));
    in_[p].rows(outward_) = 2 * bodies_[p].radius / 3 / in_[p].rows(flux_).cwiseProduct(outward).sum() * outward;
  }
}

void BodyLayer::set_shape(const Net& x, const Net& at, bool keep_rows) {
  factors_.reset();  // frees the old factors before the new matrix is allocated
  at_ = at;
  make_regular(x);
  layer_.set_shape(x(points_, Eigen::all));
  if (beyond_) beyond_->set_shape(x(points_, Eigen::all));
  const std::vector<int> own = ranks_.share(static_cast<int>(points_.size()));
  const auto n = static_cast<Eigen::Index>(rows_.size());
  matrix_ = ranks_.assembled<Eigen::MatrixXd>(n, n, [&](Eigen::MatrixXd& all) {
    stokes::Rows<double> rows;
    stop_together([&] { layer_.assemble(own, rows); });
    for (std::size_t i = 0; i < own.size(); ++i) all.middleRows<3>(3 * own[i]) = rows.middleRows<3>(3 * static_cast<Eigen::Index>(i));
  });
  for (std::size_t p = 0; p < bodies_.size(); ++p) {
    const Eigen::Index first = 3 * bodies_[p].block.first_point, length = 3 * bodies_[p].block.n_points, in = 3 * in_[p].first_point;
    matrix_.block(first, first, length, length) += flat(outward_).segment(in, length) * flat(flux_).segment(in, length).transpose();
  }
  rows_of_others_.resize(0, 0);
  stop_together([&] {
    if (keep_rows && beyond_) beyond_->assemble(at_, others_, rows_of_others_);
    factors_.emplace(keep_rows ? matrix_ : std::exchange(matrix_, {}));
  });
}

Net BodyLayer::velocity(const Net& f) {
  const Net own = f(points_, Eigen::all) / viscosity_;
  Net u = Net::Zero(f.rows(), 3);
  if (own.rows() < f.rows())
    u = ranks_.assembled<Net>(f.rows(), 3, [&](Net& all) {
      if (!beyond_) return;
      if (rows_of_others_.size() == 0) return beyond_->apply(own, at_, others_, all);
      const Eigen::VectorXd there = rows_of_others_ * flat(own);
      for (std::size_t k = 0; k < others_.size(); ++k) all.row(others_[k]) = there.segment<3>(3 * static_cast<Eigen::Index>(k)).transpose();
    });
  if (matrix_.size() > 0) Eigen::Map<Eigen::VectorXd>(u.data(), u.size())(rows_) = matrix_ * flat(own);
  return u;
}

Net BodyLayer::regular(const Net& f) const {
  Net u = Net::Zero(f.rows(), 3);
  for (const spline::Block& block : in_)
    block.rows(u) = block.rows(flux_).cwiseProduct(block.rows(f)).sum() / viscosity_ * block.rows(outward_);
  return u;
}

Apply BodyLayer::preconditioner() const {
  return [this, n = flux_.size()](const double* in, double* out) {
    Eigen::Map<Eigen::VectorXd>(out, n) = solved(Eigen::Map<const Eigen::VectorXd>(in, n));
  };
}

Eigen::MatrixXd BodyLayer::solved(Eigen::MatrixXd columns) const {
  const Eigen::MatrixXd velocities = columns(rows_, Eigen::all);
  columns(rows_, Eigen::all) = viscosity_ * factors_->solve(velocities);
  return columns;
}

}  // namespace tanktread::coupling
