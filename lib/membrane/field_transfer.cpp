// Transfer of fields to another mesh of the same surface.

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "membrane/maxwell_element.hpp"
#include "membrane/surfactant.hpp"
#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"
#include "surface/geometry.hpp"

namespace tanktread::membrane {

Eigen::VectorXd Surfactant::transferred(const Field& field, const Net& x, const std::function<spline::Site(const spline::Site&)>& site) const {
  const auto& from = static_cast<const Surfactant&>(field);
  Eigen::VectorXd contents = Eigen::VectorXd::Zero(size());
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const spline::Element& element = space_.elements[e];
    const quadrature::TensorRule& rule = quadrature::tensor_gauss(quadrature::gauss_order(gauss_points, element.degree));
    for (Eigen::Index q = 0; q < rule.size(); ++q) {
      const spline::Basis here = spline::basis(element, rule.s[q], rule.t[q]);
      const Net own = x(element.points, Eigen::all);
      const Vec3 s = own.transpose() * here.s, t = own.transpose() * here.t;
      const double c = from.concentration_at(site({static_cast<int>(e), rule.s[q], rule.t[q]})), content = rule.weights[q] * s.cross(t).norm() * c;
      for (std::size_t a = 0; a < element.points.size(); ++a) contents[element.points[a]] += content * here.value[static_cast<Eigen::Index>(a)];
    }
  }
  return (from.mass(from.q_) / contents.sum() * contents).cwiseQuotient(share_);
}

namespace {

using Symmetric = Eigen::Vector3d;  // components 11, 12, 22

Eigen::Matrix2d matrix(const Symmetric& a) { return (Eigen::Matrix2d() << a[0], a[1], a[1], a[2]).finished(); }

/// Applies a scalar function to a symmetric 2 x 2 matrix, through its eigenvalues.
template <class Function>
Symmetric function_of(const Eigen::Matrix2d& a, const Function& f) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> pairs(a);
  const Eigen::Matrix2d result = pairs.eigenvectors() * pairs.eigenvalues().unaryExpr(f).asDiagonal() * pairs.eigenvectors().transpose();
  return {result(0, 0), result(0, 1), result(1, 1)};
}

/// Returns the Cholesky factor L of the metric g = L L^T, from the contravariant metric g^-1. L maps components to an orthonormal frame that does not
/// depend on the size of the element.
Eigen::Matrix2d frame(const Symmetric& raised) { return matrix(raised).inverse().llt().matrixL(); }

/// Returns the values at s of all Lagrange polynomials on these nodes.
Eigen::VectorXd lagrange(const Eigen::VectorXd& nodes, double s) {
  Eigen::VectorXd values = Eigen::VectorXd::Ones(nodes.size());
  for (Eigen::Index i = 0; i < nodes.size(); ++i)
    for (Eigen::Index j = 0; j < nodes.size(); ++j)
      if (j != i) values[i] *= (s - nodes[j]) / (nodes[i] - nodes[j]);
  return values;
}

}  // namespace

/// Returns the number of Gauss points per direction of an element.
int MaxwellElement::order(std::size_t element) const {
  const Eigen::Index end = element + 1 < first_.size() ? first_[element + 1] : unit_.rows();
  return static_cast<int>(std::lround(std::sqrt(static_cast<double>(end - first_[element]))));
}

/// Returns the image of each coefficient and its sign. Gauss points are permuted with their element. If the image swaps the two parameters, the
/// components 11 and 22 are swapped. If the image reverses only one parameter, component 12 changes sign.
std::vector<std::pair<int, double>> MaxwellElement::images(const surface::Image& image) const {
  std::vector<std::pair<int, double>> all;
  for (std::size_t e = 0; e < first_.size(); ++e) {
    const surface::Turn& turn = image.turn[e];
    const int n = order(e), first = static_cast<int>(first_[static_cast<std::size_t>(image.element[e])]);
    for (int q = 0; q < n * n; ++q)
      for (int k = 0; k < 3; ++k)
        all.emplace_back(3 * (first + turn.bernstein(q, n - 1)) + (turn.exchanged ? 2 - k : k), k == 1 && turn.turned[0] != turn.turned[1] ? -1 : 1);
  }
  return all;
}

/// Returns log(L^T C L) at each Gauss point for the state set last: the logarithm of the strain C in the orthonormal frame L of the surface.
Eigen::MatrixX3d MaxwellElement::logarithms() const {
  Eigen::MatrixX3d all(unit_.rows(), 3);
  const Eigen::MatrixX3d raised = raised_metric(x_);
  for (Eigen::Index row = 0; row < raised.rows(); ++row) {
    const Eigen::Matrix2d l = frame(raised.row(row)), c = matrix(q_.segment<3>(3 * row).cwiseProduct(unit_.row(row).transpose()));
    all.row(row) = function_of(l.transpose() * c * l, [](double value) { return std::log(value); });
  }
  return all;
}

/// Interpolates the logarithms of the strain from the Gauss points to a parametric point.
Eigen::Vector3d MaxwellElement::interpolated(const Eigen::MatrixX3d& logarithms, const spline::Site& site) const {
  const auto element = static_cast<std::size_t>(site.element);
  const int n = order(element);
  const Eigen::VectorXd nodes = quadrature::tensor_gauss(n).s.head(n);
  const Eigen::VectorXd by_s = lagrange(nodes, site.s), by_t = lagrange(nodes, site.t);
  Symmetric sum = Symmetric::Zero();
  for (int k = 0; k < n * n; ++k) sum += by_s[k % n] * by_t[k / n] * logarithms.row(first_[element] + k).transpose();
  return sum;
}

surface::FieldsAt MaxwellElement::values_at() const {
  return [this, known = logarithms()](const spline::Site& site) -> Eigen::VectorXd {
    const surface::Point at = surface::point(space_, x_, site);
    Eigen::Matrix<double, 3, 2> tangents;
    tangents << at.a1, at.a2;
    const Eigen::Matrix2d l = (tangents.transpose() * tangents).llt().matrixL();
    const Eigen::Matrix<double, 3, 2> axes = tangents * l.transpose().inverse();
    return (axes * matrix(interpolated(known, site)) * axes.transpose()).reshaped();
  };
}

Eigen::VectorXd MaxwellElement::transferred(const Field& field, const Net& x, const std::function<spline::Site(const spline::Site&)>& site) const {
  const auto& from = static_cast<const MaxwellElement&>(field);
  const Eigen::MatrixX3d known = from.logarithms();
  Eigen::MatrixX3d here(unit_.rows(), 3);
  for (std::size_t e = 0; e < first_.size(); ++e) {
    const quadrature::TensorRule& rule = quadrature::tensor_gauss(order(e));
    for (Eigen::Index q = 0; q < rule.size(); ++q) {
      here.row(first_[e] + q) = from.interpolated(known, site({static_cast<int>(e), rule.s[q], rule.t[q]}));
    }
  }
  Eigen::VectorXd result(size());
  const Eigen::MatrixX3d raised = raised_metric(x);
  for (Eigen::Index row = 0; row < raised.rows(); ++row) {
    const Eigen::Matrix2d back = frame(raised.row(row)).inverse();
    const Eigen::Matrix2d strain = matrix(function_of(matrix(here.row(row)), [](double value) { return std::exp(value); }));
    const Eigen::Matrix2d c = back.transpose() * strain * back;
    result.segment<3>(3 * row) = Symmetric(c(0, 0), c(0, 1), c(1, 1)).cwiseQuotient(unit_.row(row).transpose());
  }
  return result;
}

}  // namespace tanktread::membrane
