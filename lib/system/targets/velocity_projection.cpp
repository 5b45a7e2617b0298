#include "system/targets/velocity_projection.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "base/indices.hpp"
#include "quadrature/gauss.hpp"
#include "system/targets/collocation.hpp"

namespace tanktread::coupling {

namespace {

/// Returns the tensor rule whose points are the zeros of the Bernoulli polynomial B4 on an element.
quadrature::TensorRule at_zeros() {
  const double from_end = 0.5 - std::sqrt(0.25 - 1 / std::sqrt(30.));  // t (1 - t) = 1/sqrt(30)
  const quadrature::GaussRule rule{Eigen::Vector2d(from_end, 1 - from_end), Eigen::Vector2d(0.5, 0.5)};
  return quadrature::tensor(rule, rule);
}

/// Values of the basis functions N_A and their derivatives with respect to s and t, at a set of points. Shapes (points, N).
struct Functions {
  Eigen::SparseMatrix<double> value, s, t;
};

Functions functions(const spline::Space& space, const stokes::Sites& sites) {
  return {value_matrix(space, sites), value_matrix(space, sites, &spline::Basis::s), value_matrix(space, sites, &spline::Basis::t)};
}

stokes::Sites places(std::span<const int> elements) {
  const quadrature::TensorRule rule = at_zeros();
  stokes::Sites sites;
  for (const int e : elements)
    for (int q = 0; q < rule.size(); ++q) sites.push_back({{e, rule.s[q], rule.t[q]}});
  return sites;
}

Net cross(const Net& a, const Net& b) {
  Net product(a.rows(), 3);
  for (Eigen::Index i = 0; i < a.rows(); ++i) product.row(i) = Eigen::RowVector3d(a.row(i)).cross(Eigen::RowVector3d(b.row(i)));
  return product;
}

/// Returns N_A times the area that each point represents on the surface with this net, up to a constant factor; shape (N, points).
Eigen::SparseMatrix<double> weighted(const Functions& of, const Net& net) {
  const Eigen::VectorXd areas = cross(of.s * net, of.t * net).rowwise().norm();
  return of.value.transpose() * areas.asDiagonal();
}

}  // namespace

VelocityProjection::VelocityProjection(const spline::Space& space, const Net& unstressed, const surface::Symmetry& symmetry,
                                       const membrane::DirectSolverOptions& direct, const Ranks& ranks)
    : symmetry_(symmetry.fundamental().empty() ? surface::Symmetry(space.n_points) : symmetry), mass_(direct, symmetry_), scalar_mass_(direct) {
  const int n_elements = static_cast<int>(space.elements.size());
  std::vector<int> elements = indices(n_elements);
  const Functions everywhere = functions(space, places(elements));
  mass_.factor(weighted(everywhere, unstressed) * everywhere.value);

  const auto points = [&](int e) { return std::span<const int>(space.elements[static_cast<std::size_t>(e)].points); };
  const surface::FundamentalElements fundamental = surface::fundamental_elements(symmetry_, n_elements, points);
  folded_ = fundamental.whole();
  const auto touches = [&](int e) { return std::ranges::any_of(points(e), [&](int a) { return symmetry_.source()[a] == a; }); };
  if (folded_)
    elements = fundamental.element;
  else
    std::erase_if(elements, [&](int e) { return !touches(e); });
  sites_ = places(elements);
  Functions of = functions(space, sites_);
  weighted_ = weighted(of, unstressed);
  own_ = ranks.share(static_cast<int>(sites_.size()));
  values_ = std::move(of.value), along_s_ = std::move(of.s), along_t_ = std::move(of.t);

  const std::vector<int>& all = symmetry_.fundamental();
  const auto row = [&](int a) { return static_cast<int>(std::ranges::lower_bound(all, symmetry_.source()[a]) - all.begin()); };
  std::vector<Eigen::Triplet<double>> copies, rows;
  for (int a = 0; a < space.n_points; ++a) {
    copies.emplace_back(a, row(a), 1);
    if (folded_ || symmetry_.source()[a] == a) rows.emplace_back(row(a), a, 1);
  }
  images_.resize(space.n_points, static_cast<Eigen::Index>(all.size()));
  images_.setFromTriplets(copies.begin(), copies.end());
  fundamental_.resize(images_.cols(), images_.rows());
  fundamental_.setFromTriplets(rows.begin(), rows.end());
  scalar_mass_.factor(fundamental_ * weighted_ * values_ * images_);
}

Net VelocityProjection::normals(const Net& x) const {
  return cross(along_s_ * x, along_t_ * x).rowwise().normalized();
}

Eigen::VectorXd VelocityProjection::scalar_values(const Eigen::VectorXd& at_sites) const {
  membrane::RightHandSides sums = fundamental_ * (weighted_ * at_sites);
  scalar_mass_.solve(sums, sums);
  return images_ * sums;
}

Net VelocityProjection::control_values(const Net& at_sites) const {
  Net sums = weighted_ * at_sites;
  if (folded_) surface::fold(symmetry_, sums);
  return mass_.solve(sums);
}

}  // namespace tanktread::coupling
