#include "membrane/surfactant.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"

namespace tanktread::membrane {

Surfactant::Surfactant(const spline::Space& space, const Net& initial, const SurfactantOptions& options, double clean_tension, double diffusivity)
    : space_(space), options_(options), clean_tension_(clean_tension), diffusivity_(diffusivity), mass_(space) {
  constexpr int points = 4;  // a direction at degree 3, as the membrane's
  for (const spline::Element& element : space.elements) {
    const quadrature::TensorRule& rule = quadrature::tensor_gauss(points + std::max(0, element.degree - 3));
    const auto n = static_cast<Eigen::Index>(rule.size()), functions = static_cast<Eigen::Index>(element.points.size());
    ElementPoints& at = elements_.emplace_back();
    for (Eigen::MatrixXd* table : {&at.value, &at.by_s, &at.by_t}) table->resize(n, functions);
    at.weight = rule.weights;
    for (Eigen::Index q = 0; q < n; ++q) {
      const spline::Basis basis = spline::basis(element, rule.s[q], rule.t[q]);
      at.value.row(q) = basis.value.transpose(), at.by_s.row(q) = basis.s.transpose(), at.by_t.row(q) = basis.t.transpose();
    }
  }
  const Eigen::SparseMatrix<double>& mass = mass_.update(initial);
  solver_.factor(mass);
  share_ = mass * Eigen::VectorXd::Ones(initial.rows());
}

void Surfactant::place(const Net& x, const Eigen::VectorXd& q) {
  Net content = Net::Zero(x.rows(), 3);  // of which the solver takes three columns
  content.col(0) = share_.cwiseProduct(q);
  concentration_ = solver_.solve(mass_.update(x), content).col(0);
  smallest_ = INFINITY, largest_ = -INFINITY;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    ElementPoints& at = elements_[e];
    const std::vector<int>& points = space_.elements[e].points;
    const Eigen::MatrixX3d own = x(points, Eigen::all);
    at.s = at.by_s * own, at.t = at.by_t * own;
    const Eigen::VectorXd ss = at.s.rowwise().squaredNorm(), tt = at.t.rowwise().squaredNorm(), st = at.s.cwiseProduct(at.t).rowwise().sum();
    const Eigen::VectorXd det = ss.cwiseProduct(tt) - st.cwiseAbs2();
    at.g11 = tt.cwiseQuotient(det), at.g12 = -st.cwiseQuotient(det), at.g22 = ss.cwiseQuotient(det);
    at.area = at.weight.cwiseProduct(det.cwiseSqrt());
    at.c = at.value * concentration_(points);
    smallest_ = std::min(smallest_, at.c.minCoeff()), largest_ = std::max(largest_, at.c.maxCoeff());
  }
  if (!(options_.tension(largest_) > 0))
    throw RunFailure(formatted("the surfactant leaves no surface tension where its concentration is %.4g of the initial one", largest_));
}

/// sum_A += sum_q (N_A,s along_s + N_A,t along_t), rows of the functions of element e.
void Surfactant::scatter(const ElementPoints& at, std::size_t e, const Eigen::MatrixXd& along_s, const Eigen::MatrixXd& along_t, auto& sum) const {
  const Eigen::MatrixXd rows = at.by_s.transpose() * along_s + at.by_t.transpose() * along_t;
  const std::vector<int>& points = space_.elements[e].points;
  for (std::size_t a = 0; a < points.size(); ++a) sum.row(points[a]) += rows.row(static_cast<Eigen::Index>(a));
}

Net Surfactant::load() const {
  Net d = Net::Zero(space_.n_points, 3);
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const ElementPoints& at = elements_[e];
    const Eigen::VectorXd less = clean_tension_ * at.area.cwiseProduct(at.c.unaryExpr([&](double c) { return options_.tension(c) - 1; }));
    const auto contravariant = [&](const Eigen::VectorXd& by_s, const Eigen::VectorXd& by_t) -> Eigen::MatrixXd {
      return less.cwiseProduct(by_s).asDiagonal() * at.s + less.cwiseProduct(by_t).asDiagonal() * at.t;
    };
    scatter(at, e, contravariant(at.g11, at.g12), contravariant(at.g12, at.g22), d);
  }
  return d;
}

Eigen::VectorXd Surfactant::rate(const Net& faster) const {
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(space_.n_points);
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const ElementPoints& at = elements_[e];
    const std::vector<int>& points = space_.elements[e].points;
    const Eigen::MatrixX3d w = at.value * Eigen::MatrixX3d(faster(points, Eigen::all));
    const Eigen::VectorXd c = concentration_(points);
    const Eigen::VectorXd by_s = at.c.cwiseProduct(w.cwiseProduct(at.s).rowwise().sum()) - diffusivity_ * (at.by_s * c);
    const Eigen::VectorXd by_t = at.c.cwiseProduct(w.cwiseProduct(at.t).rowwise().sum()) - diffusivity_ * (at.by_t * c);
    const Eigen::VectorXd along_s = at.area.cwiseProduct(at.g11.cwiseProduct(by_s) + at.g12.cwiseProduct(by_t));
    const Eigen::VectorXd along_t = at.area.cwiseProduct(at.g12.cwiseProduct(by_s) + at.g22.cwiseProduct(by_t));
    scatter(at, e, along_s, along_t, rate);
  }
  return rate.cwiseQuotient(share_);
}

}  // namespace tanktread::membrane
