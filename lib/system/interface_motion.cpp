#include "system/interface_motion.hpp"

#include <algorithm>
#include <iterator>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "base/small_matrices.hpp"
#include "stokes/layer.hpp"
#include "surface/geometry.hpp"

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
    radius_ = std::min(radius_, particle.radius);
    drops_.push_back({block, particle.interface_motion == MeshMotion::relaxed, particle.interface_turns, particle.interface_speed, {}, {}, {}});
    Drop& drop = drops_.back();
    const auto holds = [&](int e) { return block.holds_element(e); };
    std::ranges::copy_if(layout.points(), std::back_inserter(drop.points), [&](int i) { return block.holds(i); });
    if (projection_)
      for (int i = 0; i < static_cast<int>(projection_->sites().size()); ++i)
        if (holds(projection_->sites()[static_cast<size_t>(i)].front().element)) drop.places.push_back(i);
    if (!drop.relaxed) continue;
    relaxed_ = true;
    std::ranges::copy_if(layout.touching(), std::back_inserter(own_elements_), holds);
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

/// Returns the mean velocity U (6.4) of a drop from the fluid velocity v at its control points and b = dV/dx. `from_mean`: control points minus their
/// mean. Exact if the velocity is uniform.
Eigen::RowVector3d mean_motion(const Net& from_mean, const Net& b, const Net& v) {
  const Eigen::VectorXd outward = b.cwiseProduct(v).rowwise().sum();
  return 3 * outward.transpose() * from_mean / b.cwiseProduct(from_mean).sum();
}

/// Returns half the vorticity of v, averaged over the interior, from v at the control points and b = dV/dx. `from_mean`: control points minus their
/// mean. Exact for a rigid rotation.
Vec3 mean_rotation(const Net& from_mean, const Net& b, const Net& v) {
  const Mat3 volume = b.transpose() * from_mean, flux = b.transpose() * (v.rowwise() - v.colwise().mean());
  const Mat3 gradient = volume.partialPivLu().solve(flux).transpose();
  return axial_vector(gradient) / 2;
}

/// Returns the velocity of the points y in a rotation about the origin.
Net rotated(const Vec3& rotation, const Net& y) { return -y.rowwise().cross(rotation.transpose()); }

/// Returns the weight g (4.14) of an axis, divided by m. m is about 1.6 D^2, with the Taylor deformation D of the drop in the plane normal to the
/// axis.
double weight_of_axis(double m) {
  constexpr double elongated = 0.02;  // value of m at the Taylor deformation D = 0.11, from which on g = 1: the mesh turns with the shape of the drop
  const double along = m / elongated;
  return along < 1 ? along * (3 - 2 * along) / elongated : 1 / m;
}

/// Returns the angular velocity Omega_s (4.14) of a shape that moves with the velocity u at the sites y. The area weight of a site is |b|, with the
/// volume gradient b = dV/dx of its control point.
Vec3 rotation_of_shape(const Net& y, const Net& normals, const Net& b, const Net& u) {
  Mat3 moments = Mat3::Zero();
  Vec3 across = Vec3::Zero();
  double inertia = 0;
  for (Eigen::Index i = 0; i < y.rows(); ++i) {
    const double area = b.row(i).norm();
    const Vec3 n = normals.row(i).transpose(), arm = Vec3(y.row(i).transpose()).cross(n);
    moments += area * arm * arm.transpose();
    across += area * arm * u.row(i).dot(n);
    inertia += area * y.row(i).squaredNorm() * 2 / 3;
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(moments / inertia);
  Vec3 rotation = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = axes.eigenvectors().col(k);
    rotation += weight_of_axis(axes.eigenvalues()[k]) * axis.dot(across) / inertia * axis;
  }
  return rotation;
}

/// Returns the centroid of a drop from its control points x and b = dV/dx, approximately: exactly that of a polyhedron with the volumes b.x/3.
Eigen::RowVector3d approximate_centroid(const Net& x, const Net& b) {
  const Eigen::RowVector3d mean = x.colwise().mean();
  const Net y = x.rowwise() - mean;
  const Eigen::VectorXd volumes = b.cwiseProduct(y).rowwise().sum();
  return mean + 0.75 * volumes.transpose() * y / volumes.sum();
}

/// State of a drop: at its control points the positions x, the volume gradient b = dV/dx and the fluid velocity v; at its collocation sites the
/// positions, normals and velocities.
struct Moving {
  Net x, b, v;
  Net places, normals, velocities;
};

/// Rigid motion W (4.14): a velocity and a rotation about `centre`.
struct MotionOfShape {
  Vec3 centre;
  RigidMotion motion;
};

/// Returns the rigid motion W (4.14) with which the mesh of a drop moves. `turns`: false if the rotation is to be zero.
MotionOfShape motion_of_shape(const Moving& drop, bool turns) {
  const Eigen::RowVector3d centre = approximate_centroid(drop.x, drop.b);
  const Net from_centre = drop.x.rowwise() - centre, y = drop.places.rowwise() - centre;
  const Vec3 of_fluid = mean_rotation(from_centre, drop.b, drop.v);
  const Eigen::RowVector3d mean = mean_motion(from_centre, drop.b, drop.v - rotated(of_fluid, from_centre));
  const Vec3 rotation = turns ? rotation_of_shape(y, drop.normals, drop.b, drop.velocities.rowwise() - mean) : Vec3(Vec3::Zero());
  return {centre.transpose(), {mean.transpose(), rotation}};
}

/// Returns the rotation about the mean of the control points that fits `from` best to `to`.
Mat3 rotation_between(const Net& from, const Net& to) {
  return nearest_rotation((to.rowwise() - to.colwise().mean()).transpose() * (from.rowwise() - from.colwise().mean()));
}
}  // namespace

Net InterfaceMotion::normals_at(const Net& x) const {
  return ranks_.filled(x.rows(), [&](Net& normals) {
    for (const Drop& drop : drops_)
      for (const int i : drop.points) normals.row(i) = site_normal(space_, x, space_.collocation[static_cast<size_t>(i)]).transpose();
  });
}

/// Sets the relaxation velocity w (4.6) at the rank-owned collocation sites from the density f of the mesh's elastic force.
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

/// Returns the control values of the mesh velocity (4.6), W + n n.(v - W) + (1 - n n).w, at the shape x. Here b = dV/dx, W is the rigid motion
/// (4.14), and w is the relaxation velocity, computed from the density f of the elastic force on the mesh; if f is empty, w = 0. Sets `rest` to
/// v - W - w at the collocation sites.
Net InterfaceMotion::combined(const Net& x, const Net& b, const Net& normals, const Net& v, const Net& f, Net& rest) const {
  Net u = sites_ * v;
  const Net places = sites_ * x;
  std::vector<MotionOfShape> shapes;
  for (const Drop& drop : drops_) {
    const auto own = [&](const Net& net) { return drop.block.rows(net); };
    shapes.push_back(motion_of_shape({own(x), own(b), own(v), own(places), own(normals), own(u)}, drop.turns));
  }
  // Replaces `velocities` v at the points `at` with the normals n by W + `along` + n n.(v - W - `along`), and adds v - W - `along` to `rest`.
  const auto combine = [&](const Net& at, const Net& n, const Net& along, std::vector<int> Drop::* rows, Net& velocities) {
    for (size_t d = 0; d < drops_.size(); ++d) {
      const auto& [centre, motion] = shapes[d];
      for (const int i : drops_[d].*rows) {
        const Vec3 whole = motion.velocity + motion.angular_velocity.cross(Vec3(at.row(i).transpose()) - centre);
        const Eigen::RowVector3d with = whole.transpose() + along.row(i);
        rest.row(i) += velocities.row(i) - with;
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
    rest = -free;
    const Net slid = projection_->control_values(along);
    combine(values * x, n, Net::Zero(n.rows(), 3), &Drop::places, u);
    const Eigen::VectorXd leak = values * projection_->scalar_values((values * slid).cwiseProduct(n).rowwise().sum());
    return projection_->control_values(u - leak.asDiagonal() * n) + slid;
  }
  rest = Net::Zero(u.rows(), 3);
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
        for (const int i : projection_ ? drop.places : drop.points) {
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

Net InterfaceMotion::velocity(const Net& x, const Net& b, const Net& v, const Net& given) {
  latest_.x = given;
  const Net normals = normals_at(x);
  if (!relaxed_) return combined(x, b, normals, v, {}, latest_.rest);
  latest_.density = sites_ * mass_.solve(ranks_.filled(x.rows(), [&](Net& d) { mesh_.load(x, own_elements_, d); }));
  return combined(x, b, normals, v, collocation_.solve(along_interface(normals, latest_.density)), latest_.rest);
}

void InterfaceMotion::linearise(const Net& x, const Net& b) {
  x_ = x, flux_ = b;
  normals_ = normals_at(x);
  known_ = same(latest_.x, x) ? latest_ : Latest();
  if (relaxed_) tangent_.update(x, own_elements_);
}

Net InterfaceMotion::derivative(const Net& dv, const Net& delta) {
  const double most = delta.cwiseAbs().maxCoeff();
  const bool turns = known_.x.size() > 0 && most > 0;
  const double aside = 1e-6 * radius_ / most;
  Net there, change, density, rest;
  if (turns) there = x_ + aside * delta, change = (normals_at(there) - normals_) / aside;
  if (relaxed_) {
    density = along_interface(normals_, sites_ * mass_.solve(ranks_.filled(delta.rows(), [&](Net& h) { tangent_.apply(delta, h); })));
    if (turns) density -= normal_part_change(normals_, change, known_.density);
    density = collocation_.solve(density);
  }
  const Net kept = combined(x_, flux_, normals_, dv, density, rest);
  if (!turns) return kept;
  if (projection_) {
    const Net n = projection_->normals(x_);
    return kept + projection_->control_values(normal_part_change(n, (projection_->normals(there) - n) / aside, known_.rest));
  }
  return kept + collocation_.solve(ranks_.filled(x_.rows(), [&](Net& u) { u = normal_part_change(normals_, change, known_.rest); }));
}

}  // namespace tanktread::coupling
