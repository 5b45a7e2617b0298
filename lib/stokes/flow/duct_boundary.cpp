#include "stokes/flow/duct_boundary.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include <Eigen/LU>

#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"

namespace tanktread::stokes {
namespace {

constexpr int points = 8, points_far = 10,
              points_log = 16;  // Gauss points: nodes of (2.17) an element; of (2.15) far away; with a logarithm
constexpr int sweeps = 2;
using std::numbers::pi;
using surface::PlaneJet;
using surface::Vec2;

double cross(const Vec2& a, const Vec2& b) { return a[0] * b[1] - a[1] * b[0]; }

/// The four functions of an element.
Eigen::Vector4d functions(const OutlineElement& e, double t) {
  Eigen::Vector4d b;
  spline::bernstein(3, (t - e.begin) / (e.end - e.begin), b.data());
  return e.bernstein * b;
}

/// One row of (2.15): what a target takes from the elements.
class Row {
 public:
  Row(const OutlineSpace& space, const Vec2& origin, const OutlineSite& site)
      : space_(space), origin_(origin), site_(site), target_(space.at(site.side, site.t).x), value_((target_ - origin).squaredNorm() / 4) {}

  void element(const OutlineElement& e) {
    e_ = &e;
    weight_.setZero();
    double t = site_.t;  // on a closed side the last knot is the first
    if (site_.side == e.side && t < e.begin && surface::closed(space_.outline().side(e.side))) {
      const auto [first, last] = surface::range(space_.outline().side(e.side));
      t += last - first;
    }
    if (site_.side == e.side && e.begin <= t && t <= e.end) {
      logarithmic(t, e.begin);
      logarithmic(t, e.end);
    } else {
      panel(e.begin, e.end, 0);
    }
  }

  const Eigen::Vector4d& weights() const { return weight_; }
  double right() const { return right_; }

 private:
  void node(double t, double weight) {
    const PlaneJet j = space_.at(e_->side, t);
    const Vec2 r = j.x - target_;
    const double square = r.squaredNorm();
    if (square == 0) return;
    weight_ -= weight * std::log(square) / (4 * pi) * functions(*e_, t);
    right_ -= weight * ((j.x - origin_).squaredNorm() / 4 - value_) * cross(r, j.d) / (2 * pi * square);
  }

  /// From the target's own place to one end: t = t0 + (end - t0) s^4.
  void logarithmic(double t0, double end) {
    const auto& rule = quadrature::gauss(points_log);
    for (int q = 0; q < rule.size(); ++q) {
      const double s = rule.nodes[q];
      node(t0 + (end - t0) * s * s * s * s, std::abs(end - t0) * 4 * s * s * s * rule.weights[q]);
    }
  }

  /// Halved until the target is at least a length away.
  void panel(double a, double b, int depth) {
    const double middle = (a + b) / 2;
    const Vec2 xa = space_.at(e_->side, a).x, xm = space_.at(e_->side, middle).x, xb = space_.at(e_->side, b).x;
    if (depth < 50 && (xm - target_).norm() < 1.5 * ((xm - xa).norm() + (xb - xm).norm())) {
      panel(a, middle, depth + 1);
      panel(middle, b, depth + 1);
      return;
    }
    const auto& rule = quadrature::gauss(points_far);
    for (int q = 0; q < rule.size(); ++q) node(a + (b - a) * rule.nodes[q], (b - a) * rule.weights[q]);
  }

  const OutlineSpace& space_;
  Vec2 origin_;
  const OutlineSite& site_;
  Vec2 target_;
  double value_, right_ = 0;
  const OutlineElement* e_ = nullptr;
  Eigen::Vector4d weight_;
};

}  // namespace

BoundaryProfile::BoundaryProfile(const surface::Outline& outline, int elements) : centroid_(outline.centroid()), radius_(outline.radius()) {
  const OutlineSpace space(outline, elements);
  n_elements_ = static_cast<int>(space.elements().size());
  const Eigen::VectorXd flux = add_nodes(space, density(space));
  for (int k = 0; k < sweeps; ++k) sweep(flux);
  flow_rate_ = 0;
  for (std::size_t i = 0; i < x_.size(); ++i)
    flow_rate_ += 2 * f_[i] * (x_[i] * dy_[i] - y_[i] * dx_[i]) / 8 + g_[i] * (x_[i] * dx_[i] + y_[i] * dy_[i]) / 2;
}

Eigen::VectorXd BoundaryProfile::density(const OutlineSpace& space) const {
  const int n = space.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + 1, n + 1);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n + 1);
  for (int i = 0; i < n; ++i) {
    Row row(space, centroid_, space.sites()[static_cast<std::size_t>(i)]);
    for (const OutlineElement& e : space.elements()) {
      row.element(e);
      for (int a = 0; a < 4; ++a) matrix(i, e.functions[static_cast<std::size_t>(a)]) += row.weights()[a];
    }
    matrix(i, n) = 1;
    right[i] = row.right();
  }
  for (const OutlineElement& e : space.elements())  // the integral of a Bernstein polynomial is a quarter of the element
    for (int a = 0; a < 4; ++a) matrix(n, e.functions[static_cast<std::size_t>(a)]) += (e.end - e.begin) * e.bernstein.row(a).sum() / 4;
  return matrix.partialPivLu().solve(right).head(n);
}

/// Returns q dl at the nodes.
Eigen::VectorXd BoundaryProfile::add_nodes(const OutlineSpace& space, const Eigen::VectorXd& sigma) {
  const auto& rule = quadrature::gauss(points);
  Eigen::VectorXd flux(points * n_elements_);
  double psi = 0;  // up to the element
  Eigen::Index node = 0;
  for (const OutlineElement& e : space.elements()) {
    Eigen::Vector4d control, b;
    for (int a = 0; a < 4; ++a) control[a] = sigma[e.functions[static_cast<std::size_t>(a)]];
    const Eigen::Vector4d bezier = e.bernstein.transpose() * control;
    const double h = e.end - e.begin;
    Eigen::Matrix<double, 5, 1> primitive = Eigen::Matrix<double, 5, 1>::Zero(), quartic;
    for (int i = 0; i < 4; ++i) primitive[i + 1] = primitive[i] + h * bezier[i] / 4;
    for (int q = 0; q < rule.size(); ++q) {
      const double w = h * rule.weights[q];
      const PlaneJet j = space.at(e.side, e.begin + h * rule.nodes[q]);
      const Vec2 x = j.x - centroid_;
      spline::bernstein(3, rule.nodes[q], b.data());
      spline::bernstein(4, rule.nodes[q], quartic.data());
      x_.push_back(x[0]), y_.push_back(x[1]), dx_.push_back(w * j.d[0]), dy_.push_back(w * j.d[1]);
      f_.push_back(x.squaredNorm() / 4), g_.push_back(psi + primitive.dot(quartic));
      flux[node++] = w * bezier.dot(b);
    }
    psi += primitive[4];
  }
  return flux;
}

/// psi between the collocation points, from Cauchy's formula int (F - F_i)/(zeta - zeta_i) d zeta = 0 by the sum over the nodes, with v_c as it is:
///   F_i = [ sum_j F_j c_ij + dF_i ] / sum_j c_ij,   c_ij = dzeta_j/(zeta_j - zeta_i), j /= i                                       (2.18)
/// What multiplies psi there is smooth, so that the error of the spline, which alternates from knot to knot, is averaged out.
void BoundaryProfile::sweep(const Eigen::VectorXd& flux) {
  using Complex = std::complex<double>;
  const std::size_t n = x_.size();
  std::vector<double> psi(n);
  for (std::size_t i = 0; i < n; ++i) {
    double one_re = 0, one_im = 0, re = (x_[i] * dx_[i] + y_[i] * dy_[i]) / 2, im = flux[static_cast<Eigen::Index>(i)];
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i) continue;
      const double x = x_[j] - x_[i], y = y_[j] - y_[i], inverse = 1 / (x * x + y * y);
      const double c_re = (dx_[j] * x + dy_[j] * y) * inverse, c_im = (dy_[j] * x - dx_[j] * y) * inverse;
      one_re += c_re, one_im += c_im;
      re += f_[j] * c_re - g_[j] * c_im, im += f_[j] * c_im + g_[j] * c_re;
    }
    psi[i] = (Complex(re, im) / Complex(one_re, one_im)).imag();
  }
  g_ = psi;
}

void BoundaryProfile::evaluate(int n, const double* x2, const double* x3, double* u, double* u2, double* u3) const {
  std::vector<double> x(static_cast<std::size_t>(n)), y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = x2[i] - centroid_[0], y[i] = x3[i] - centroid_[1];
  const CauchyNodes nodes{static_cast<int>(x_.size()), x_.data(), y_.data(), dx_.data(), dy_.data(), f_.data(), g_.data()};
  cauchy_sums(nodes, radius_, n, x.data(), y.data(), u, u2, u3);
  for (std::size_t i = 0; i < x.size(); ++i) u[i] -= (x[i] * x[i] + y[i] * y[i]) / 4;
  if (!u2) return;
  for (std::size_t i = 0; i < x.size(); ++i) u2[i] -= x[i] / 2, u3[i] -= y[i] / 2;
}

}  // namespace tanktread::stokes
