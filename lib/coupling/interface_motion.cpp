#include "coupling/interface_motion.hpp"

#include <algorithm>

#include "coupling/collocation.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {

InterfaceMotion::InterfaceMotion(const spline::Space& space, const Net& initial, const std::string& motion, double speed,
                                 stokes::SingleLayer& layer, const std::vector<int>& own_points, const std::vector<int>& own_elements,
                                 const membrane::SymmetricSolver& collocation, const membrane::DirectSolverOptions& solver,
                                 const surface::Symmetry& symmetry, const Ranks& ranks)
    : space_(space),
      relaxed_(motion == "relaxed"),
      speed_(speed),
      own_points_(own_points),
      own_elements_(own_elements),
      sites_(collocation_matrix(space)),
      collocation_(collocation),
      ranks_(ranks),
      mesh_(space, initial, membrane::NeoHookean{1}),
      tangent_(mesh_),
      mass_(solver, symmetry) {
  if (!relaxed_) return;
  mass_.factor(membrane::MassMatrix(space).update(initial));
  layer.assemble(initial, stokes::Measure::reference, own_points_, layer_);
}

namespace {
/// At a site, or, at a plain pole, where elements have none themselves, the mean of theirs close by.
Vec3 normal(const spline::Space& space, const Net& x, std::span<const spline::Site> sites) {
  const surface::Point p = surface::point(space, x, sites.front());
  if (p.jacobian > 1e-9 * std::max(p.a1.squaredNorm(), p.a2.squaredNorm())) return p.n;
  constexpr double aside = 1e-4;
  Vec3 sum = Vec3::Zero();
  for (const spline::Site& s : sites) sum += surface::point(space, x, {s.element, s.s + aside * (0.5 - s.s), s.t + aside * (0.5 - s.t)}).n;
  return sum.normalized();
}

/// U (6.4) from b = dV/dx, for 3 V = b.x; of a velocity that is the same everywhere exactly that one.
Eigen::RowVector3d mean_motion(const Net& x, const Net& b, const Net& v) {
  const Net from_mean = x.rowwise() - x.colwise().mean();
  const Eigen::VectorXd outward = b.cwiseProduct(v).rowwise().sum();
  return 3 * outward.transpose() * from_mean / b.cwiseProduct(from_mean).sum();
}
}  // namespace

std::vector<Vec3> InterfaceMotion::normals_at(const Net& x) const {
  std::vector<Vec3> normals;
  for (const int i : own_points_) normals.push_back(normal(space_, x, space_.collocation[static_cast<size_t>(i)]));
  return normals;
}

/// R^-1 of U + n n.(v - U) + (1 - n n).w at the sites, w from the density f (empty: none).
Net InterfaceMotion::combined(const std::vector<Vec3>& normals, const Eigen::RowVector3d& mean, const Net& v, const Net& f) const {
  const Net across = sites_ * Net(v.rowwise() - mean);
  const Eigen::Map<const Eigen::VectorXd> density(f.data(), f.size());
  Net u(v.rows(), 3);
  for (size_t k = 0; k < own_points_.size(); ++k) {
    const int i = own_points_[k];
    const Vec3& n = normals[k];
    Vec3 along = Vec3::Zero();
    if (relaxed_) along = -speed_ * layer_.middleRows<3>(3 * static_cast<Eigen::Index>(k)) * density;
    u.row(i) = (along + n * n.dot(across.row(i).transpose() - along)).transpose() + mean;
  }
  ranks_.replicate(u);
  return collocation_.solve(u);
}

Net InterfaceMotion::velocity(const Net& x, const Net& b, const Net& v) {
  const Eigen::RowVector3d mean = mean_motion(x, b, v);
  if (!relaxed_) return combined(normals_at(x), mean, v, {});
  Net d(x.rows(), 3);
  mesh_.load(x, own_elements_, d);
  ranks_.replicate(d);
  return combined(normals_at(x), mean, v, mass_.solve(d));
}

void InterfaceMotion::linearise(const Net& x, const Net& b) {
  x_ = x, flux_ = b;
  normals_ = normals_at(x);
  if (relaxed_) tangent_.update(x, own_elements_);
}

Net InterfaceMotion::derivative(const Net& dv, const Net& delta) {
  const Eigen::RowVector3d mean = mean_motion(x_, flux_, dv);
  if (!relaxed_) return combined(normals_, mean, dv, {});
  Net h(delta.rows(), 3);
  tangent_.apply(delta, h);
  ranks_.replicate(h);
  return combined(normals_, mean, dv, mass_.solve(h));
}

}  // namespace tanktread::coupling
