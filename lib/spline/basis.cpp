#include "spline/basis.hpp"

namespace tanktread::spline {

Basis basis(const Element& element, double s, double t, int derivatives) {
  const int p = element.degree, n = p + 1;
  double bs[3][most_polynomial_degree + 1], bt[3][most_polynomial_degree + 1];
  if (derivatives == 0) {
    bernstein(p, s, bs[0]);
    bernstein(p, t, bt[0]);
  } else {
    bernstein(p, s, bs[0], bs[1], derivatives > 1 ? bs[2] : nullptr);
    bernstein(p, t, bt[0], bt[1], derivatives > 1 ? bt[2] : nullptr);
  }
  Eigen::VectorXd product(n * n);
  auto combine = [&](int ds, int dt) -> Eigen::VectorXd {
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) product[n * j + i] = bs[ds][i] * bt[dt][j];
    return *element.extraction * product;
  };
  Basis b;
  b.value = combine(0, 0);
  if (derivatives > 0) {
    b.s = combine(1, 0);
    b.t = combine(0, 1);
  }
  if (derivatives > 1) {
    b.ss = combine(2, 0);
    b.st = combine(1, 1);
    b.tt = combine(0, 2);
  }
  return b;
}

BezierPoints bezier_points(const Element& e, const Net& field) {
  const auto gather = [&](auto& P) {
    for (std::size_t i = 0; i < e.points.size(); ++i) P.row(Eigen::Index(i)) = field.row(e.points[i]);
  };
  if (e.degree == 3 && e.points.size() == 16) {  // regular element: fixed-size matrices are faster
    Eigen::Matrix<double, 16, 3> P;
    gather(P);
    return Eigen::Map<const Eigen::Matrix<double, 16, 16>>(e.extraction->data()).transpose().lazyProduct(P);
  }
  Eigen::Matrix<double, Eigen::Dynamic, 3> P(Eigen::Index(e.points.size()), 3);
  gather(P);
  return e.extraction->transpose().lazyProduct(P);
}

}  // namespace tanktread::spline
