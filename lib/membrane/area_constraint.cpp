#include "membrane/area_constraint.hpp"

#include <cmath>

#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"

namespace tanktread::membrane {

namespace {

/// Returns x_,s and x_,t.
std::array<Vec3, 2> tangents(const spline::Element& element, const spline::Basis& basis, const Net& x) {
  const Net own = x(element.points, Eigen::all);
  return {own.transpose() * basis.s, own.transpose() * basis.t};
}

}  // namespace

AreaConstraint::AreaConstraint(const Membrane& membrane, const Eigen::VectorXd& mobility) : space_(&membrane.space()) {
  const Materials& materials = membrane.materials();
  for (int e = 0; e < static_cast<int>(space_->elements.size()); ++e) {
    const Material& material = materials.all[materials.of_element.empty() ? 0 : static_cast<std::size_t>(materials.of_element[e])];
    // The matrix of factor() has a row per Gauss point. With more than one point per element there are more rows than displacements.
    const auto parts = material.area_order == 1 ? split(material.law) : std::nullopt;
    if (!parts || parts->area.area == 0) continue;  // Skalak's law with C = 0 has no area elasticity
    const spline::Element& element = space_->elements[e];
    const quadrature::TensorRule& rule = quadrature::tensor_gauss(quadrature::gauss_order(material.area_order, element.degree));
    for (int q = 0; q < rule.size(); ++q) {
      const spline::Basis basis = spline::basis(element, rule.s[q], rule.t[q]);
      const auto [a, b] = tangents(element, basis, membrane.unstressed());
      const double det = a.cross(b).squaredNorm();
      points_.push_back({e, basis, parts->area, 1 / det, rule.weights[q] * std::sqrt(det)});
    }
  }
  mobility_.resize(3 * mobility.size());
  for (Eigen::Index i = 0; i < mobility_.size(); ++i) mobility_[i] = mobility[i / 3];
}

/// Returns the conditions t and their scaled gradient D (4.25) at the shape x. A displacement u changes the invariant I2 by 2 J_s^2 g^ab x_,a . u_,b,
/// where J_s^2 g^ab is the cofactor matrix of g_ab divided by |G|.
AreaConstraint::Rows AreaConstraint::rows(const Net& x) const {
  Rows result{{static_cast<Eigen::Index>(points_.size()), 3 * x.rows()}, Eigen::VectorXd(points_.size())};
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t q = 0; q < points_.size(); ++q) {
    const Point& at = points_[q];
    const spline::Element& element = space_->elements[static_cast<std::size_t>(at.element)];
    const auto [a, b] = tangents(element, at.basis, x);
    const double i2 = a.cross(b).squaredNorm() * at.inverse_det - 1;
    const Response<double> psi = at.law.response(0., i2);
    const double scale = std::sqrt(at.area * psi.psi22);
    const Vec3 by_s = 2 * scale * at.inverse_det * (b.squaredNorm() * a - a.dot(b) * b);
    const Vec3 by_t = 2 * scale * at.inverse_det * (a.squaredNorm() * b - a.dot(b) * a);
    for (std::size_t k = 0; k < element.points.size(); ++k) {
      const auto function = static_cast<Eigen::Index>(k);
      const Vec3 row = at.basis.s[function] * by_s + at.basis.t[function] * by_t;
      for (int c = 0; c < 3; ++c) entries.emplace_back(static_cast<int>(q), 3 * element.points[k] + c, row[c]);
    }
    result.t[static_cast<Eigen::Index>(q)] = at.area * psi.psi2 / scale;
  }
  result.d.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void AreaConstraint::factor(double time) {
  if (time == time_) return;
  time_ = time;
  Eigen::SparseMatrix<double> system = time * (now_.d * mobility_.asDiagonal() * now_.d.transpose());
  for (Eigen::Index q = 0; q < system.rows(); ++q) system.coeffRef(q, q) += 1;
  if (system_.rows() != system.rows()) system_.analyzePattern(system);
  system_.factorize(system);
}

/// Returns the displacement time m D'(1 + time D m D')^-1 y, shape (N, 3). y: one value per Gauss point. `time`: argument of factor(). D: gradient of
/// the area conditions, D' its transpose. m: mobility. If y = D r, this is the part of the displacement r that the operator P (4.25) removes.
Net AreaConstraint::removed(const Eigen::VectorXd& at_points) const {
  return as_net(time_ * mobility_.cwiseProduct(now_.d.transpose() * system_.solve(at_points)));
}

void AreaConstraint::restore_areas(Net& x, const Net& like, double time) {
  const Eigen::VectorXd wanted = rows(like).t;
  set_shape(x);
  for (int k = 0; k < 2; ++k) {
    factor(time);
    x -= removed(now_.t - wanted);
    set_shape(x);
  }
}

}  // namespace tanktread::membrane
