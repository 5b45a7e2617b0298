#include "system/shape_coordinates.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "system/parallel/agreement.hpp"
#include "system/targets/collocation.hpp"
#include "system/interface_motion.hpp"
#include "system/rigid_motion.hpp"

namespace tanktread::coupling {

ShapeCoordinates::ShapeCoordinates(CoupledMotion& motion, const State& state, const surface::Symmetry& symmetry, const Vec3& parity)
    : motion_(motion), state_(state), parity_(symmetry, parity), sites_(collocation_matrix(motion.capsule().membrane().space())),
      collocation_({}, parity == Vec3::Ones() ? symmetry : surface::Symmetry()), projection_(motion.capsule().projection()),
      layout_(motion.layout(symmetry, parity)) {
  const spline::Space& space = motion.capsule().membrane().space();
  const std::vector<Particle>& particles = motion.capsule().particles();
  const Net x = motion.shape(state);
  collocation_.factor(sites_);
  for (const int i : symmetry.fundamental()) {
    const auto contains = [i](const Particle& particle) { return particle.block.contains(i); };
    const Particle& particle = *std::ranges::find_if(particles, contains);
    if (particle.rigid) continue;
    if (particle.slides()) {
      const Vec3 normal = site_normal(space, x, space.collocation[static_cast<std::size_t>(i)]);
      add_along(i, normal);
      if (parity_.scalar_signs()[i] != 0) all_.push_back({i, projection_ ? Vec3(Vec3::Zero()) : normal});
      continue;
    }
    for (int c = 0; c < 3; ++c)
      if (parity_.signs()(i, c) != 0) all_.push_back({i, Vec3::Unit(c)});
  }
  if (projection_) {
    normals_ = projection_->normals(x);
    for (std::size_t i = 0; i < projection_->sites().size(); ++i) {
      const int e = projection_->sites()[i].front().element;
      const auto contains = [e](const Particle& one) { return one.block.contains_element(e); };
      if (!std::ranges::find_if(particles, contains)->slides()) normals_.row(static_cast<Eigen::Index>(i)).setZero();
    }
  }
  for (const Particle& particle : particles)
    if (particle.rigid) add_rigid(particle.block, x);
  for (const Particle& particle : particles)
    if (particle.slides()) carry_whole(particle.block);
  for (std::size_t k = 0; k < motion.fields().size(); ++k)
    for (const auto& [number, orbit] : layout_->independent(motion.id(k))) fields_.emplace_back(number, std::sqrt(orbit));
}

void ShapeCoordinates::add_rigid(const spline::Block& block, const Net& x) {
  const Net own = block.rows(x);
  const Vec3 centre = own.colwise().mean().transpose();
  const std::size_t first = rigid_.size();
  for (int k = 0; k < 6; ++k) {
    Net field = Net::Zero(x.rows(), 3);
    block.rows(field) = rigid_velocity(own, unit_motion(k), centre);
    for (std::size_t other = first; other < rigid_.size(); ++other) field -= rigid_[other].cwiseProduct(field).sum() * rigid_[other];
    rigid_.push_back(field / field.norm());
  }
}

/// Adds the tangential coordinates of a collocation site: one for each tangential direction in which symmetry and parity allow a displacement.
/// `normal`: unit normal at the site.
void ShapeCoordinates::add_along(int site, const Vec3& normal) {
  const Vec3 left = parity_.signs().row(site).transpose().cwiseAbs();
  const Mat3 tangential = Mat3::Identity() - normal * normal.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> directions(left.asDiagonal() * tangential * left.asDiagonal());
  for (int k = 0; k < 3; ++k)
    if (directions.eigenvalues()[k] > 0.5) along_.push_back({site, directions.eigenvectors().col(k)});
}

void ShapeCoordinates::follow(Dynamics& dynamics, const State& x) {
  const auto n = static_cast<Eigen::Index>(along_.size());
  if (n == 0) return;
  dynamics.velocity(x);
  dynamics.linearise(x);
  if (dynamics.mesh_motion(x).empty()) return;
  const auto motion_along = [&](const Net& d) {
    const State motion = dynamics.mesh_motion(motion_.state_of(d));
    return coordinates_along(motion_.shape(motion));
  };
  Eigen::MatrixXd slides(n, n), drawn(n, shape_size());
  for (Eigen::Index k = 0; k < n; ++k) slides.col(k) = motion_along(along(Eigen::VectorXd::Unit(n, k)));
  for (Eigen::Index k = 0; k < shape_size(); ++k) drawn.col(k) = motion_along(of_shape(Eigen::VectorXd::Unit(shape_size(), k)));
  const double scale = slides.diagonal().cwiseAbs().mean();
  for (const State& field : dynamics.relabellings(x)) {  // removes mesh rotations, because they do not change the shape (4.17)
    if (!admits(field)) continue;
    const Eigen::VectorXd turn = coordinates_along(motion_.shape(field)).normalized();
    slides -= turn * (turn.transpose() * slides + scale * turn.transpose());
    drawn -= turn * (turn.transpose() * drawn);
  }
  const std::vector<double> first = decided([&] {
    const Eigen::MatrixXd following = -slides.partialPivLu().solve(drawn);
    return std::vector<double>(following.reshaped().begin(), following.reshaped().end());
  });
  following_ = Eigen::Map<const Eigen::MatrixXd>(first.data(), n, shape_size());
}

/// Prepares the translations of a drop, so that coordinates represent them exactly, including their tangential part. Omits translations that do not
/// have the symmetry and parity of the displacements.
void ShapeCoordinates::carry_whole(const spline::Block& block) {
  for (int c = 0; c < 3; ++c) {
    Net field = Net::Zero(sites_.rows(), 3);
    field.middleRows(block.first_point, block.n_points).col(c).setOnes();
    Net symmetric = field;
    parity_.complete(symmetric);
    if (symmetric != field) continue;
    Eigen::VectorXd y = coordinates_of_shape(field);
    for (const Translation& other : translations_) {
      const double part = other.coordinates.dot(y);
      y -= part * other.coordinates, field -= part * other.field;
    }
    const double size = y.norm();
    translations_.push_back({y / size, field / size, {}});
  }
  for (Translation& one : translations_) one.tangential = one.field - normal_displacement(one.coordinates);
}

State ShapeCoordinates::displacement(const Eigen::VectorXd& y) const {
  const Net d = of_shape(y.head(shape_size()));
  if (fields_.empty()) return motion_.state_of(d);
  State change = motion_.slid(state_, d - normal_displacement(y)), of_fields(layout_);
  motion_.shape(change) = d;
  Eigen::Index k = shape_size();
  for (const auto& [number, factor] : fields_) of_fields.numbers()[number] = y[k++] / factor;
  layout_->complete(of_fields);
  change += of_fields;
  return change;
}

Net ShapeCoordinates::of_shape(const Eigen::VectorXd& y) const {
  Net d = normal_displacement(y);
  for (const Translation& one : translations_) d += one.coordinates.dot(y) * one.tangential;
  if (following_.size() > 0) d += along(following_ * y);
  return d;
}

/// Returns the control values of the displacement with the coordinates y, but without two tangential displacements that belong to y: the motion of
/// relaxing meshes (4.26), and the tangential part of translations of drops.
Net ShapeCoordinates::normal_displacement(const Eigen::VectorXd& y) const {
  Net at_sites = Net::Zero(sites_.rows(), 3);
  Eigen::VectorXd outward = Eigen::VectorXd::Zero(sites_.rows());
  for (std::size_t k = 0; k < all_.size(); ++k)
    if (projected(all_[k]))
      outward[all_[k].site] = y[static_cast<Eigen::Index>(k)];
    else
      at_sites.row(all_[k].site) += y[static_cast<Eigen::Index>(k)] * all_[k].direction.transpose();
  parity_.complete(at_sites);
  Net d = collocation_.solve(at_sites);
  if (projection_) {
    parity_.complete(outward);
    d += projection_->control_values((projection_->values() * outward).asDiagonal() * normals_);
  }
  for (std::size_t k = 0; k < rigid_.size(); ++k) d += y[static_cast<Eigen::Index>(all_.size() + k)] * rigid_[k];
  return d;
}

/// Returns the displacement with the tangential coordinates t and the normal coordinates y = 0.
Net ShapeCoordinates::along(const Eigen::VectorXd& t) const {
  Net at_sites = Net::Zero(sites_.rows(), 3);
  for (std::size_t k = 0; k < along_.size(); ++k) at_sites.row(along_[k].site) += t[static_cast<Eigen::Index>(k)] * along_[k].direction.transpose();
  parity_.complete(at_sites);
  const Net field = collocation_.solve(at_sites);
  return projection_ ? field - normal_displacement(coordinates_of_shape(field)) : field;
}

Eigen::VectorXd ShapeCoordinates::coordinates_along(const Net& field) const {
  const Net at_sites = sites_ * field;
  Eigen::VectorXd t(static_cast<Eigen::Index>(along_.size()));
  for (std::size_t k = 0; k < along_.size(); ++k) t[static_cast<Eigen::Index>(k)] = at_sites.row(along_[k].site).dot(along_[k].direction);
  return t;
}

bool ShapeCoordinates::admits(const State& change) const {
  constexpr double nearly = 1e-3;
  const Net own = motion_.shape(change);
  Net completed = own;
  parity_.complete(completed);
  return (completed - own).norm() <= nearly * own.norm();
}

Eigen::VectorXd ShapeCoordinates::coordinates(const State& change) const {
  const Net own = motion_.shape(change);
  Eigen::VectorXd y(size());
  y.head(shape_size()) = coordinates_of_shape(own);
  if (fields_.empty()) return y;
  State remainder = change - motion_.slid(state_, own - normal_displacement(y));
  layout_->project(remainder);
  Eigen::Index k = shape_size();
  for (const auto& [number, factor] : fields_) y[k++] = factor * remainder.numbers()[number];
  return y;
}

Eigen::VectorXd ShapeCoordinates::coordinates_of_shape(const Net& field) const {
  const Net at_sites = sites_ * field;
  Eigen::VectorXd y(shape_size()), outward;
  if (projection_) outward = projection_->scalar_values((projection_->values() * field).cwiseProduct(normals_).rowwise().sum());
  for (std::size_t k = 0; k < all_.size(); ++k)
    y[static_cast<Eigen::Index>(k)] = projected(all_[k]) ? outward[all_[k].site] : at_sites.row(all_[k].site).dot(all_[k].direction);
  for (std::size_t k = 0; k < rigid_.size(); ++k) y[static_cast<Eigen::Index>(all_.size() + k)] = rigid_[k].cwiseProduct(field).sum();
  return y;
}

}  // namespace tanktread::coupling
