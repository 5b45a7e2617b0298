#include "system/interface_motion.hpp"

#include <algorithm>
#include <iterator>

#include "base/small_matrices.hpp"
#include "stokes/layer.hpp"
#include "surface/geometry.hpp"
#include "system/motion_of_shape.hpp"
#include "system/parallel/stop_together.hpp"

namespace tanktread::coupling {

InterfaceMotion::InterfaceMotion(const spline::Space& space, const Net& initial, const CapsuleParameters& parameters, const RowShare& layout,
                                 const Targets& targets, const membrane::SymmetricSolver& mass)
    : space_(space),
      targets_(targets),
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
    if (!projection_) drop.targets = drop.points;
    else
      for (int i = 0; i < static_cast<int>(targets.sites().size()); ++i)
        if (contains(targets.sites()[static_cast<size_t>(i)].front().element)) drop.targets.push_back(i);
    if (!drop.relaxed) continue;
    relaxed_ = true;
    std::ranges::copy_if(layout.touching(), std::back_inserter(own_elements_), contains);
    std::vector<int> own;
    for (const int i : drop.points) own.push_back(i - block.first_point);
    stokes::Layer layer(stokes::Layer::Kernel::single_layer, *particle.space, particle.space->collocation, parameters.quadrature);
    layer.set_shape(block.rows(initial));
    stop_together([&] { layer.assemble(own, drop.layer); });
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

/// Returns the normals at the targets. `at_sites`: normals at the collocation sites.
Net InterfaceMotion::normals_at_targets(const Net& x, const Net& at_sites) const { return projection_ ? projection_->normals(x) : at_sites; }

/// Returns the control values of a velocity at the targets. `fill` sets its rows at Drop::targets in a net of zeros.
Net InterfaceMotion::control_values(const std::function<void(Net&)>& fill) const {
  if (!projection_) return collocation_.solve(ranks_.filled(sites_.rows(), fill));
  Net at_targets = targets_.zero();
  fill(at_targets);
  return projection_->control_values(at_targets);
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
  Net u = targets_.values() * v;
  const Net at = targets_.values() * x, n = normals_at_targets(x, normals);
  const std::vector<MotionOfShape> shapes = motions(x, b, normals, v);
  // Replaces `velocities` v at the targets by W + `along` + n n.(v - W - `along`), and adds v - W - `along` to `slip_residual`.
  const auto combine = [&](const Net& along, Net& velocities) {
    for (size_t d = 0; d < drops_.size(); ++d) {
      for (const int i : drops_[d].targets) {
        const Eigen::RowVector3d with = shapes[d].at(at.row(i).transpose()).transpose() + along.row(i);
        slip_residual.row(i) += velocities.row(i) - with;
        velocities.row(i) = with + n.row(i).dot(velocities.row(i) - with) * n.row(i);
      }
    }
  };
  if (projection_) {
    const Eigen::SparseMatrix<double>& values = projection_->values();
    const Net w = ranks_.filled(x.rows(), [&](Net& own) { slide(x, f, own); });
    const Net free = values * collocation_.solve(w), along = along_interface(n, free);
    slip_residual = -free;
    const Net slid = projection_->control_values(along);
    combine(targets_.zero(), u);
    // The field `slid`, a fit of the tangential w, has a small normal part, which is subtracted so that w does not move the interface.
    const Eigen::VectorXd leak = values * projection_->scalar_values((values * slid).cwiseProduct(n).rowwise().sum());
    return projection_->control_values(u - leak.asDiagonal() * n) + slid;
  }
  slip_residual = Net::Zero(u.rows(), 3);
  Net w = Net::Zero(x.rows(), 3);
  slide(x, f, w);
  return collocation_.solve(ranks_.filled(x.rows(), [&](Net& own) {
    combine(w, u);
    own = u;
  }));
}

std::vector<Net> InterfaceMotion::rotations(const Net& x, std::span<const int> axes) const {
  if (axes.empty()) return {};
  const Net normals = projection_ ? projection_->normals(x) : normals_at(x), places = targets_.values() * x;
  std::vector<Net> all;
  for (const Drop& drop : drops_) {
    const Vec3 middle = drop.block.rows(x).colwise().mean().transpose();
    for (const int k : axes)
      all.push_back(control_values([&](Net& field) {
        for (const int i : drop.targets) {
          const Vec3 turn = Vec3::Unit(k).cross(Vec3(places.row(i).transpose()) - middle), n = normals.row(i).transpose();
          field.row(i) = (turn - n.dot(turn) * n).transpose();
        }
      }));
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

/// Returns the tangential part of the change of W (4.14) with the shape, per distance `aside`, at the targets. `normals`: at the targets.
Net InterfaceMotion::change_of_motion(const Displaced& to, const Net& normals, double aside) const {
  const std::vector<MotionOfShape> after = motions(to.x, to.b, to.normals, slip_.fluid);
  const Net at = targets_.values() * x_, there = targets_.values() * to.x;
  Net change = targets_.zero();
  for (size_t d = 0; d < drops_.size(); ++d)
    for (const int i : drops_[d].targets)
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
  return kept + control_values([&](Net& u) {
    const Net n = normals_at_targets(x_, normals_);
    u = normal_part_change(n, (normals_at_targets(to.x, to.normals) - n) / aside, slip_.residual);
    if (db.rows() > 0) u += change_of_motion(to, n, aside);
  });
}

}  // namespace tanktread::coupling
