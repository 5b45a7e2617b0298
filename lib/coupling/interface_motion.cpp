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
  layer_.assemble(own_points_, space.n_points, [&](std::span<const int> targets, stokes::Rows<float>& rows) {
    layer.assemble(initial, stokes::Measure::reference, targets, rows);
  });
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
}  // namespace

std::vector<Vec3> InterfaceMotion::normals_at(const Net& x) const {
  std::vector<Vec3> normals;
  for (const int i : own_points_) normals.push_back(normal(space_, x, space_.collocation[static_cast<size_t>(i)]));
  return normals;
}

/// R^-1 of n n.across + (1 - n n).w at the sites, w from the density f (empty: none).
Net InterfaceMotion::combined(const std::vector<Vec3>& normals, const Net& across, const Net& f) const {
  const Net v = sites_ * across;
  Net w = Net::Zero(v.rows(), 3), u(v.rows(), 3);
  if (relaxed_) layer_.apply(f, w);
  for (size_t k = 0; k < own_points_.size(); ++k) {
    const int i = own_points_[k];
    const Vec3 &n = normals[k], along = -speed_ * w.row(i).transpose();
    u.row(i) = (along + n * n.dot(v.row(i).transpose() - along)).transpose();
  }
  ranks_.replicate(u);
  return collocation_.solve(u);
}

Net InterfaceMotion::velocity(const Net& x, const Net& v) {
  if (!relaxed_) return combined(normals_at(x), v, {});
  Net d(x.rows(), 3);
  mesh_.load(x, own_elements_, d);
  ranks_.replicate(d);
  return combined(normals_at(x), v, mass_.solve(d));
}

void InterfaceMotion::linearise(const Net& x) {
  normals_ = normals_at(x);
  if (relaxed_) tangent_.update(x, own_elements_);
}

Net InterfaceMotion::derivative(const Net& dv, const Net& delta) {
  if (!relaxed_) return combined(normals_, dv, {});
  Net h(delta.rows(), 3);
  tangent_.apply(delta, h);
  ranks_.replicate(h);
  return combined(normals_, dv, mass_.solve(h));
}

}  // namespace tanktread::coupling
