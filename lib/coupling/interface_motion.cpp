#include "coupling/interface_motion.hpp"

#include <algorithm>
#include <iterator>

#include "coupling/collocation.hpp"
#include "stokes/single_layer.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {

InterfaceMotion::InterfaceMotion(const spline::Space& space, const Net& initial, std::span<const Particle> particles,
                                 const quadrature::Options& quadrature, const std::vector<int>& own_points, const std::vector<int>& own_elements,
                                 const membrane::SymmetricSolver& collocation, const membrane::SymmetricSolver& mass, const Ranks& ranks)
    : space_(space),
      sites_(collocation_matrix(space)),
      collocation_(collocation),
      mass_(mass),
      ranks_(ranks),
      mesh_(space, initial, membrane::NeoHookean{1}),
      tangent_(mesh_) {
  for (const Particle& particle : particles) {
    if (!particle.slides()) continue;
    const spline::Block& block = particle.block;
    drops_.push_back({block, particle.interface_motion == "relaxed", particle.interface_speed, {}, {}});
    Drop& drop = drops_.back();
    std::ranges::copy_if(own_points, std::back_inserter(drop.points), [&](int i) { return block.holds(i); });
    if (!drop.relaxed) continue;
    relaxed_ = true;
    const int end = block.first_element + block.n_elements;
    std::ranges::copy_if(own_elements, std::back_inserter(own_elements_), [&](int e) { return e >= block.first_element && e < end; });
    std::vector<int> targets;
    for (const int i : drop.points) targets.push_back(i - block.first_point);
    stokes::SingleLayer layer(*particle.space, quadrature);
    layer.set_reference(block.rows(initial));
    layer.assemble(block.rows(initial), stokes::Measure::reference, targets, drop.layer);
  }
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
  for (const Drop& drop : drops_)
    for (const int i : drop.points) normals.push_back(normal(space_, x, space_.collocation[static_cast<size_t>(i)]));
  return normals;
}

/// R^-1 of U + n n.(v - U) + (1 - n n).w at the sites, U at x with b = dV/dx there, w from the density f (empty: none).
Net InterfaceMotion::combined(const Net& x, const Net& b, const std::vector<Vec3>& normals, const Net& v, const Net& f) const {
  Net u = sites_ * v;
  size_t place = 0;
  for (const Drop& drop : drops_) {
    const spline::Block& block = drop.block;
    const Eigen::RowVector3d mean = mean_motion(block.rows(x), block.rows(b), block.rows(v));
    const Eigen::Map<const Eigen::VectorXd> density(f.data() + 3 * block.first_point, drop.relaxed ? 3 * block.n_points : 0);
    for (size_t k = 0; k < drop.points.size(); ++k) {
      const Vec3& n = normals[place++];
      Vec3 along = Vec3::Zero();
      if (drop.relaxed) along = -drop.speed * drop.layer.middleRows<3>(3 * static_cast<Eigen::Index>(k)) * density;
      auto row = u.row(drop.points[k]);
      row = (along + n * n.dot((row - mean).transpose() - along)).transpose() + mean;
    }
  }
  ranks_.replicate(u);
  return collocation_.solve(u);
}

Net InterfaceMotion::velocity(const Net& x, const Net& b, const Net& v) {
  if (!relaxed_) return combined(x, b, normals_at(x), v, {});
  Net d(x.rows(), 3);
  mesh_.load(x, own_elements_, d);
  ranks_.replicate(d);
  return combined(x, b, normals_at(x), v, mass_.solve(d));
}

void InterfaceMotion::linearise(const Net& x, const Net& b) {
  x_ = x, flux_ = b;
  normals_ = normals_at(x);
  if (relaxed_) tangent_.update(x, own_elements_);
}

Net InterfaceMotion::derivative(const Net& dv, const Net& delta) {
  if (!relaxed_) return combined(x_, flux_, normals_, dv, {});
  Net h(delta.rows(), 3);
  tangent_.apply(delta, h);
  ranks_.replicate(h);
  return combined(x_, flux_, normals_, dv, mass_.solve(h));
}

}  // namespace tanktread::coupling
