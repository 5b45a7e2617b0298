#include "stokes/flow/duct_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <Eigen/LU>

#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"
#include "surface/spline_lines.hpp"

namespace tanktread::stokes {

namespace {

using surface::CubicCurve;
using surface::Outline;
using surface::PlaneCurve;
using Crowding = OutlineSpace::Crowding;

constexpr double right_angle = std::numbers::pi / 2;

/// Returns the grading exponent (p or r of OutlineSpace) for a corner with this angle. At the distance s from a corner of angle a the density behaves
/// like s^(pi/a - 1), and like s log s at a right angle.
double exponent(double angle) { return angle < 1.05 * right_angle ? 2 : 3; }

double crowded(const Crowding& c, double t) {
  const double a = std::pow(t, c.first), b = std::pow(1 - t, c.last);
  return a / (a + b);
}

double crowded_slope(const Crowding& c, double t) {
  const double a = std::pow(t, c.first), b = std::pow(1 - t, c.last);
  return std::pow(t, c.first - 1) * std::pow(1 - t, c.last - 1) * (c.first * (1 - t) + c.last * t) / ((a + b) * (a + b));
}

/// Returns t with w(t) = w, where w(t) is the increasing grading function of OutlineSpace, by bisection.
double uncrowded(const Crowding& c, double w) {
  double low = 0, high = 1;
  for (int k = 0; k < 60; ++k) (crowded(c, (low + high) / 2) < w ? low : high) = (low + high) / 2;
  return (low + high) / 2;
}

/// Returns the knots of the spline that represents this side of the outline, as values of the parameter t of OutlineSpace.
std::vector<double> own_knots(const PlaneCurve& side, const Crowding& crowding) {
  const auto [first, last] = surface::range(side);
  const bool open = !surface::closed(side);
  std::vector<double> out = open ? std::vector<double>{0, 1} : std::vector<double>{first, last};
  const auto* cubic = std::get_if<CubicCurve>(&side);
  if (!cubic) return out;
  for (std::size_t i = 1; i + 1 < cubic->breaks.size(); ++i) {
    const double u = cubic->breaks[i];
    out.insert(out.end() - 1, open ? uncrowded(crowding, (u - first) / (last - first)) : u);
  }
  return out;
}

/// Returns the number of elements of each side, at least two, proportional to the square root of the side's length. A short side is close to a corner
/// everywhere, and therefore needs more elements per length.
std::vector<int> shares(const Outline& outline, int elements) {
  if (outline.smooth()) return {elements};
  double total = 0;
  for (int k = 0; k < outline.n_sides(); ++k) total += std::sqrt(outline.side_length(k));
  std::vector<int> out;
  for (int k = 0; k < outline.n_sides(); ++k)
    out.push_back(std::max(2, static_cast<int>(std::ceil(elements * std::sqrt(outline.side_length(k)) / total - 1e-9))));
  return out;
}

/// Divides every interval between two knots evenly, and returns the ends of the elements. The length of an element is about (last knot - first
/// knot)/elements, and at most 1.25 times this value.
std::vector<double> divided(const std::vector<double>& knots, int elements) {
  const double most = 1.25 * (knots.back() - knots.front()) / elements;
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const int pieces = knots.size() == 2 ? elements : static_cast<int>(std::ceil((knots[i + 1] - knots[i]) / most));
    for (int j = 0; j < pieces; ++j) out.push_back(knots[i] + (knots[i + 1] - knots[i]) * j / pieces);
  }
  out.push_back(knots.back());
  return out;
}

}  // namespace

OutlineSpace::OutlineSpace(const Outline& outline, int elements) : outline_(outline) {
  const auto share = shares(outline, elements);
  surface::Line line;
  for (int k = 0; k < outline.n_sides(); ++k) {
    crowding_.push_back({exponent(outline.corner_angle(k)), exponent(outline.corner_angle((k + 1) % outline.n_sides()))});
    const auto knots = divided(own_knots(outline.side(k), crowding_.back()), share[static_cast<std::size_t>(k)]);
    const bool closed = surface::closed(outline.side(k));
    const std::size_t first_site = line.sites.size();
    add(line, knots, closed, !closed);
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      const auto& [functions, extraction] = line.pieces[elements_.size()];
      if (closed) sites_.push_back({k, knots[i], static_cast<int>(elements_.size())});
      elements_.push_back({k, knots[i], knots[i + 1], functions, extraction});
    }
    for (std::size_t i = first_site; i < line.sites.size() && !closed; ++i) {
      const auto& [element, local] = line.sites[i].back();
      const auto& [side, begin, end, functions, bernstein] = elements_[static_cast<std::size_t>(element)];
      sites_.push_back({k, begin + local * (end - begin), element});
    }
  }
}

surface::PlaneJet OutlineSpace::at(int side, double t) const {
  if (surface::closed(outline_.side(side))) return outline_.at(side, t);
  const auto [first, last] = surface::range(outline_.side(side));
  const Crowding& c = crowding_[static_cast<std::size_t>(side)];
  surface::PlaneJet j = outline_.at(side, first + (last - first) * crowded(c, t));
  j.d *= (last - first) * crowded_slope(c, t);
  return j;
}

namespace {

// Gauss points per interval. points: nodes of (2.17), per element. points_far: integrals of (2.15) over elements that do not contain the target.
// points_log: integrals of (2.15), with their logarithmic singularity, from a target on the element to an end of the element.
constexpr int points = 8, points_far = 10, points_log = 16;
constexpr int sweeps = 2;
using std::numbers::pi;
using surface::PlaneJet;
using surface::Vec2;

/// Returns the values of the four basis functions of an element.
Eigen::Vector4d functions(const OutlineElement& e, double t) {
  Eigen::Vector4d b;
  spline::bernstein(3, (t - e.begin) / (e.end - e.begin), b.data());
  return e.bernstein * b;
}

/// One row of the collocation equations (2.15): the matrix entries and the right-hand side of one target, integrated over the elements.
class Row {
 public:
  Row(const OutlineSpace& space, const Vec2& origin, const OutlineSite& site)
      : space_(space), origin_(origin), site_(site), target_(space.at(site.side, site.t).x), value_((target_ - origin).squaredNorm() / 4) {}

  void element(const OutlineElement& e) {
    e_ = &e;
    weight_.setZero();
    double t = site_.t;  // parameter of the target. At the first knot of a closed side, the target also lies at the end of the last element, where
                         // its parameter is t plus the period
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

  /// Integrates from t0, the parameter of the target, to the end t = `end` of the element, with the substitution t = t0 + (end - t0) s^4.
  void logarithmic(double t0, double end) {
    const auto& rule = quadrature::gauss(points_log);
    for (int q = 0; q < rule.size(); ++q) {
      const double s = rule.nodes[q];
      node(t0 + (end - t0) * s * s * s * s, std::abs(end - t0) * 4 * s * s * s * rule.weights[q]);
    }
  }

  /// Integrates over a <= t <= b. Bisects the interval until the distance of each part from the target is at least the length of the part.
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
  for (const OutlineElement& e : space.elements())  // the integral of each Bernstein polynomial is a quarter of the element's length
    for (int a = 0; a < 4; ++a) matrix(n, e.functions[static_cast<std::size_t>(a)]) += (e.end - e.begin) * e.bernstein.row(a).sum() / 4;
  return matrix.partialPivLu().solve(right).head(n);
}

/// Adds the quadrature nodes of (2.17). Returns, for each node, the flux q times the weight dl of the node (dl is a length along the outline).
Eigen::VectorXd BoundaryProfile::add_nodes(const OutlineSpace& space, const Eigen::VectorXd& sigma) {
  const auto& rule = quadrature::gauss(points);
  Eigen::VectorXd flux(points * n_elements_);
  double psi = 0;  // psi of (2.17) at the start of the current element: the integral of the flux q along the outline
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

/// Improves psi of (2.17) between the collocation points by Cauchy's formula int (F - F_i)/(zeta - zeta_i) d zeta = 0 for F = v_c + i psi. The
/// integral is replaced by a sum over the nodes j. Its term j = i is the increment dF_i = dv_c + i q dl of F along the length dl of the node. The
/// formula is solved for F_i. Only psi is changed, not v_c:
///   F_i = [ sum_j F_j c_ij + dF_i ] / sum_j c_ij,   c_ij = dzeta_j/(zeta_j - zeta_i), j /= i                                       (2.18)
/// Before the first sweep, psi is the integral of the cubic spline for q. The error of this spline alternates in sign from knot to knot. The sum
/// averages the error out, because the coefficients of psi vary smoothly from node to node.
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
