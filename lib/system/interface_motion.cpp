#include "system/interface_motion.hpp"

#include <algorithm>
#include <iterator>

#include "base/small_matrices.hpp"
#include "stokes/layer.hpp"
#include "surface/geometry.hpp"
#include "system/motion_of_shape.hpp"

namespace tanktread::coupling {

InterfaceMotion::InterfaceMotion(const spline::Space& space, const Net& initial, const CapsuleParameters& parameters, const Layout& layout,
                                 const Targets& targets, const membrane::SymmetricSolver& mass)
    : space_(space),
      sites_(targets.at_sites()),
      projection_(targets.projection()),
      collocation_(targets.collocation()),
      mass_(mass),
      ranks_(layout.ranks()),
      mesh_(space, initial, membrane::NeoHookean{1}),
      tangent_(mesh_) {
  for (const Particle& particle : parameters.particles) {
    if (!particle.slides()) continue;
    const spline::Block& block = particle.block;
    const bool relaxed = particle.interface_motion == MeshMotion::relaxed;
    const SharedMotion shared = !particle.interface_turns ? SharedMotion::translation
                                : relaxed                 ? SharedMotion::stretching
                                                          : SharedMotion::rigid;
    radius_ = std::min(radius_, particle.radius);
    drops_.push_back({block, relaxed, shared, particle.interface_speed, {}, {}, {}});
    Drop& drop = drops_.back();
    const auto contains = [&](int e) { return block.contains_element(e); };
    std::ranges::copy_if(layout.points(), std::back_inserter(drop.points), [&](int i) { return block.contains(i); });
    if (projection_)
      for (int i = 0; i < static_cast<int>(projection_->sites().size()); ++i)
        if (contains(projection_->sites()[static_cast<size_t>(i)].front().element)) drop.sites.push_back(i);
    if (!drop.relaxed) continue;
    relaxed_ = true;
    std::ranges::copy_if(layout.touching(), std::back_inserter(own_elements_), contains);
    std::vector<int> own;
    for (const int i : drop.points) own.push_back(i - block.first_point);
    stokes::Layer layer(stokes::Layer::Kernel::single_layer, *particle.space, particle.space->collocation, parameters.quadrature);
    layer.set_shape(block.rows(initial));
    layer.assemble(own, drop.layer);
  }
}

/// Returns the normal at a site. At a pole, where no element has a normal, averages the normals of the adjacent elements close to the pole.
Vec3 site_normal(const spline::Space& space, const Net& x, std::span<const spline::Site> sites) {
  const surface::Point p = surface::point(space, x, sites.front());
  if (p.jacobian > 1e-9 * std::max(p.a1.squaredNorm(), p.a2.squaredNorm())) return p.n;
  constexpr double aside = 1e-4;
  Vec3 sum = Vec3::Zero();
  for (const spline::Site& s : sites) sum += surface::point(space, x, {s.element, s.s + aside * (0.5 - s.s), s.t + aside * (0.5 - s.t)}).n;
  return sum.normalized();
}

namespace {
/// Returns the tangential part of a field, row by row.
Net along_interface(const Net& normals, Net field) {
  for (Eigen::Index i = 0; i < field.rows(); ++i) field.row(i) -= normals.row(i).dot(field.row(i)) * normals.row(i);
  return field;
}

/// Returns the change of n (n.field), the normal part of `field`, if the normals n change by `change` and the field does not change.
Net normal_part_change(const Net& normals, const Net& change, Net field) {
  for (Eigen::Index i = 0; i < field.rows(); ++i) {
    const double across = normals.row(i).dot(field.row(i)), tilted = change.row(i).dot(field.row(i));
    field.row(i) = across * change.row(i) + tilted * normals.row(i);
  }
  return field;
}
}  // namespace

Net InterfaceMotion::normals_at(const Net& x) const {
  return ranks_.filled(x.rows(), [&](Net& normals) {
    for (const Drop& drop : drops_)
      for (const int i : drop.points) normals.row(i) = site_normal(space_, x, space_.collocation[static_cast<size_t>(i)]).transpose();
  });
}

/// Sets the relaxation velocity w (4.6) at the rank-owned collocation sites. `f`: control values of the tangential part of the density of the mesh's
/// elastic force.
void InterfaceMotion::slide(const Net& x, const Net& f, Net& w) const {
  for (const Drop& drop : drops_) {
    if (!drop.relaxed) continue;
    const spline::Block& block = drop.block;
    const Mat3 turn = rotation_between(block.rows(mesh_.unstressed()), block.rows(x));
    const Net density = block.rows(f) * turn;  // rotated to the axes of the initial shape, in which the single layer A0 of the drop is stored
    const Eigen::Map<const Eigen::VectorXd> there(density.data(), density.size());
    for (size_t k = 0; k < drop.points.size(); ++k)
      w.row(drop.points[k]) = -drop.speed * (turn * (drop.layer.middleRows<3>(3 * static_cast<Eigen::Index>(k)) * there)).transpose();
  }
}

/// Returns the motion W (4.14) of each drop's shape. `b`: dV/dx. `normals`: at the collocation sites. `v`: control values of the fluid velocity.
std::vector<MotionOfShape> InterfaceMotion::motions(const Net& x, const Net& b, const Net& normals, const Net& v) const {
  const Net places = sites_ * x, velocities = sites_ * v;
  std::vector<MotionOfShape> shapes;
  for (const Drop& drop : drops_) {
    const auto own = [&](const Net& net) { return drop.block.rows(net); };
    shapes.push_back(motion_of_shape({own(x), own(b), own(v), own(places), own(normals), own(velocities)}, drop.shared));
  }
  return shapes;
}

/// Returns the control values of the mesh velocity (4.6), W + n n.(v - W) + (1 - n n).w, at the shape x. Here b = dV/dx, W is the motion of the shape
/// (4.14), and w is the relaxation velocity, computed by slide() from f; if f is empty, w = 0. Sets `slip_residual` to v - W - w at the sites
/// where u is evaluated.
Net InterfaceMotion::combined(const Net& x, const Net& b, const Net& normals, const Net& v, const Net& f, Net& slip_residual) const {
  Net u = sites_ * v;
  const Net places = sites_ * x;
  const std::vector<MotionOfShape> shapes = motions(x, b, normals, v);
  // Replaces `velocities` v at the points `at` with the normals n by W + `along` + n n.(v - W - `along`), and adds v - W - `along` to
  // `slip_residual`.
  const auto combine = [&](const Net& at, const Net& n, const Net& along, std::vector<int> Drop::* rows, Net& velocities) {
    for (size_t d = 0; d < drops_.size(); ++d) {
      for (const int i : drops_[d].*rows) {
        const Eigen::RowVector3d with = shapes[d].at(at.row(i).transpose()).transpose() + along.row(i);
        slip_residual.row(i) += velocities.row(i) - with;
        velocities.row(i) = with + n.row(i).dot(velocities.row(i) - with) * n.row(i);
      }
    }
  };
  if (projection_) {
    const Eigen::SparseMatrix<double>& values = projection_->values();
    const Net w = ranks_.filled(x.rows(), [&](Net& own) { slide(x, f, own); });
    u = values * v;
    const Net n = projection_->normals(x);
    const Net free = values * collocation_.solve(w), along = along_interface(n, free);
    slip_residual = -free;
    const Net slid = projection_->control_values(along);
    combine(values * x, n, Net::Zero(n.rows(), 3), &Drop::sites, u);
    const Eigen::VectorXd leak = values * projection_->scalar_values((values * slid).cwiseProduct(n).rowwise().sum());
    return projection_->control_values(u - leak.asDiagonal() * n) + slid;
  }
  slip_residual = Net::Zero(u.rows(), 3);
  Net w = Net::Zero(x.rows(), 3);
  slide(x, f, w);
  return collocation_.solve(ranks_.filled(x.rows(), [&](Net& own) {
    combine(places, normals, w, &Drop::points, u);
    own = u;
  }));
}

std::vector<Net> InterfaceMotion::rotations(const Net& x, std::span<const int> axes) const {
  if (axes.empty()) return {};
  const Net normals = projection_ ? projection_->normals(x) : normals_at(x);
  const Net places = (projection_ ? projection_->values() : sites_) * x;
  std::vector<Net> all;
  for (const Drop& drop : drops_) {
    const Vec3 middle = drop.block.rows(x).colwise().mean().transpose();
    for (const int k : axes) {
      const auto rotate = [&](Net& field) {
        for (const int i : projection_ ? drop.sites : drop.points) {
          const Vec3 turn = Vec3::Unit(k).cross(Vec3(places.row(i).transpose()) - middle), n = normals.row(i).transpose();
          field.row(i) = (turn - n.dot(turn) * n).transpose();
        }
      };
      Net everywhere = Net::Zero(places.rows(), 3);
      if (projection_) rotate(everywhere);
      all.push_back(projection_ ? projection_->control_values(everywhere) : collocation_.solve(ranks_.filled(places.rows(), rotate)));
    }
  }
  return all;
}

Net InterfaceMotion::velocity(const Net& x, const Net& b, const Net& v, Slip& slip) {
  slip.fluid = v;
  const Net normals = normals_at(x);
  if (!relaxed_) return combined(x, b, normals, v, {}, slip.residual);
  slip.density = sites_ * mass_.solve(ranks_.filled(x.rows(), [&](Net& d) { mesh_.load(x, own_elements_, d); }));
  return combined(x, b, normals, v, collocation_.solve(along_interface(normals, slip.density)), slip.residual);
}

void InterfaceMotion::linearise(const Net& x, const Net& b, const Slip& slip) {
  x_ = x, flux_ = b, slip_ = slip;
  normals_ = normals_at(x);
  shapes_ = slip_.known() ? motions(x, b, normals_, slip_.fluid) : std::vector<MotionOfShape>();
  if (relaxed_) tangent_.update(x, own_elements_);
}

/// Returns the tangential part of the change of W (4.14) with the shape, per distance `aside`, at the points `at`, which move to `there`.
Net InterfaceMotion::change_of_motion(const Displaced& to, const Net& at, const Net& there, const Net& normals, double aside,
                                      std::vector<int> Drop::* rows) const {
  const std::vector<MotionOfShape> after = motions(to.x, to.b, to.normals, slip_.fluid);
  Net change = Net::Zero(at.rows(), 3);
  for (size_t d = 0; d < drops_.size(); ++d)
    for (const int i : drops_[d].*rows)
      change.row(i) = (after[d].at(there.row(i).transpose()) - shapes_[d].at(at.row(i).transpose())).transpose() / aside;
  return along_interface(normals, std::move(change));
}

Net InterfaceMotion::derivative(const Net& dv, const Net& delta, const Net& db) {
  const double most = delta.cwiseAbs().maxCoeff();
  const bool turns = slip_.known() && most > 0;
  const double aside = turns ? 1e-6 * radius_ / most : 0;
  Net change, density, slip_residual;
  Displaced to;
  if (db.rows() > 0) to.b = flux_ + aside * db;
  if (turns) to.x = x_ + aside * delta, to.normals = normals_at(to.x), change = (to.normals - normals_) / aside;
  if (relaxed_) {
    density = along_interface(normals_, sites_ * mass_.solve(ranks_.filled(delta.rows(), [&](Net& h) { tangent_.apply(delta, h); })));
    if (turns) density -= normal_part_change(normals_, change, slip_.density);
    density = collocation_.solve(density);
  }
  const Net kept = combined(x_, flux_, normals_, dv, density, slip_residual);
  if (!turns) return kept;
  if (projection_) {
    const Net n = projection_->normals(x_), at = projection_->values() * x_;
    Net turned = normal_part_change(n, (projection_->normals(to.x) - n) / aside, slip_.residual);
    if (db.rows() > 0) turned += change_of_motion(to, at, projection_->values() * to.x, n, aside, &Drop::sites);
    return kept + projection_->control_values(turned);
  }
  return kept + collocation_.solve(ranks_.filled(x_.rows(), [&](Net& u) {
    u = normal_part_change(normals_, change, slip_.residual);
    if (db.rows() > 0) u += change_of_motion(to, sites_ * x_, sites_ * to.x, normals_, aside, &Drop::points);
  }));
}

}  // namespace tanktread::coupling
