#include "membrane/surfactant.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "membrane/packed.hpp"
#include "membrane/surfactant_kernel.hpp"
#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"

namespace tanktread::membrane {

using spline::most_functions;

Surfactant::Surfactant(const spline::Space& space, const Net& initial, const SurfactantOptions& options, double clean_tension, double diffusivity)
    : space_(space), bezier_(space), options_(options), clean_tension_(clean_tension), diffusivity_(diffusivity), mass_(space), known_mass_(space) {
  for (const spline::Element& element : space.elements) {
    const quadrature::TensorRule& rule = quadrature::tensor_gauss(quadrature::gauss_order(gauss_points, element.degree));
    ElementPoints& at = elements_.emplace_back();
    at.n = rule.size(), at.functions = static_cast<int>(element.points.size());
    assert(at.n <= max_gauss && at.functions <= most_functions);
    const auto n = static_cast<std::size_t>(at.n), table = n * element.points.size();
    for (std::vector<double>* one : {&at.value, &at.by_s, &at.by_t}) one->resize(table);
    for (std::vector<double>* one : {&at.s, &at.t, &at.metric}) one->resize(4 * n);
    at.c.resize(n);
    at.weight.assign(rule.weights.begin(), rule.weights.end());
    for (std::size_t q = 0; q < n; ++q) {
      const auto k = static_cast<Eigen::Index>(q);
      const spline::Basis basis = spline::basis(element, rule.s[k], rule.t[k]);
      for (std::size_t a = 0; a < element.points.size(); ++a) {
        const auto function = static_cast<Eigen::Index>(a);
        at.value[a * n + q] = basis.value[function], at.by_s[a * n + q] = basis.s[function], at.by_t[a * n + q] = basis.t[function];
      }
    }
  }
  const Eigen::SparseMatrix<double>& mass = mass_.update(initial);
  solver_.factor(mass);
  share_ = mass * Eigen::VectorXd::Ones(initial.rows());
}

/// Returns the contravariant components, at Gauss point q, of the vector with the covariant components along_s and along_t.
std::array<double, 2> Surfactant::ElementPoints::raised(int q, double along_s, double along_t) const {
  const double *g11 = &metric[static_cast<std::size_t>(q)], *g12 = g11 + n, *g22 = g12 + n;
  return {*g11 * along_s + *g12 * along_t, *g12 * along_s + *g22 * along_t};
}

void Surfactant::set_state(const Net& x, const Eigen::VectorXd& q) {
  x_ = x, q_ = q;
  concentration_ = solver_.solve_scalar(mass_.update(x), share_.cwiseProduct(q));
  double largest = -INFINITY;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    ElementPoints& at = elements_[e];
    const std::vector<int>& points = space_.elements[e].points;
    double own[4 * most_functions], c[most_functions];
    for (std::size_t a = 0; a < points.size(); ++a) {
      for (int k = 0; k < 3; ++k) own[4 * a + static_cast<std::size_t>(k)] = x(points[a], k);
      c[a] = own[4 * a + 3] = concentration_[points[a]];
    }
    sample(4, at.n, at.functions, at.by_s.data(), own, at.s.data());
    sample(4, at.n, at.functions, at.by_t.data(), own, at.t.data());
    sample(1, at.n, at.functions, at.value.data(), c, at.c.data());
    membrane::metric(at.n, at.s.data(), at.t.data(), at.weight.data(), at.metric.data());
    largest = std::max(largest, std::ranges::max(at.c));
  }
  if (!(options_.tension(largest) > 0))
    throw RunFailure(
        formatted("the surface tension vanishes where the surfactant concentration is %.4g times the initial one: set a smaller "
                  "Interface/surfactant/elasticity number or a larger diffusivity",
                  largest));
}

Net Surfactant::load() const {
  Net d = Net::Zero(space_.n_points, 3);
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const ElementPoints& at = elements_[e];
    double along_s[3 * max_gauss], along_t[3 * max_gauss], rows[3 * most_functions];
    for (int q = 0; q < at.n; ++q) {
      const double less = clean_tension_ * (options_.tension(at.c[static_cast<std::size_t>(q)]) - 1) * at.area()[q];
      for (int k = 0; k < 3; ++k) {
        const int i = k * at.n + q;
        const auto [up_s, up_t] = at.raised(q, at.s[static_cast<std::size_t>(i)], at.t[static_cast<std::size_t>(i)]);
        along_s[i] = less * up_s, along_t[i] = less * up_t;
      }
    }
    test(3, at.n, at.functions, at.by_s.data(), at.by_t.data(), along_s, along_t, rows);
    add_rows(e, rows, d);
  }
  return d;
}

Eigen::VectorXd Surfactant::rate(const Net& slip) const { return transport(slip, diffusivity_); }

/// Returns the rate of the coefficients when the control points slide with `mesh_velocity` over a fluid at rest, without diffusion. Their slip (fluid
/// minus control-point velocity) is then -mesh_velocity.
Eigen::VectorXd Surfactant::relabelled(const Net& mesh_velocity) const { return transport(-mesh_velocity, 0); }

/// Returns the rates dm_A/dt of (3.17) with the given diffusivity, divided by int N_A dGamma on the initial surface, which gives dq_A/dt.
Eigen::VectorXd Surfactant::transport(const Net& slip, double diffusivity) const {
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(space_.n_points);
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const ElementPoints& at = elements_[e];
    const std::vector<int>& points = space_.elements[e].points;
    double own[3 * most_functions], w[3 * max_gauss] = {}, along_s[max_gauss], along_t[max_gauss], rows[most_functions];
    if (slip.rows() > 0) {
      for (std::size_t a = 0; a < points.size(); ++a) Eigen::Map<Eigen::RowVector3d>(own + 3 * a) = slip.row(points[a]);
      sample(3, at.n, at.functions, at.value.data(), own, w);
    }
    const double *s = at.s.data(), *t = at.t.data();
    for (int q = 0; q < at.n; ++q) {
      double ws = 0, wt = 0;
      for (int i = q; i < 3 * at.n; i += at.n) ws += w[i] * s[i], wt += w[i] * t[i];
      const double c = at.c[static_cast<std::size_t>(q)];
      const auto [up_s, up_t] = at.raised(q, c * ws - diffusivity * s[3 * at.n + q], c * wt - diffusivity * t[3 * at.n + q]);
      along_s[q] = at.area()[q] * up_s, along_t[q] = at.area()[q] * up_t;
    }
    test(1, at.n, at.functions, at.by_s.data(), at.by_t.data(), along_s, along_t, rows);
    add_rows(e, rows, rate);
  }
  return rate.cwiseQuotient(share_);
}

surface::Range Surfactant::extremes() const {
  Net values = Net::Zero(space_.n_points, 3);
  values.col(0) = concentration_;
  return surface::coordinate_range(surface::Patches(bezier_, values), 0);
}

double Surfactant::concentration_at(const spline::Site& site) const {
  const spline::Element& element = space_.elements[static_cast<std::size_t>(site.element)];
  return concentration_(element.points).dot(spline::basis(element, site.s, site.t).value);
}

surface::FieldsAt Surfactant::values_at() const {
  double area = 0;
  for (const ElementPoints& at : elements_) area += std::accumulate(at.area(), at.area() + at.n, 0.);
  return [this, mean = mass(q_) / area](const spline::Site& site) { return Eigen::VectorXd::Constant(1, concentration_at(site) / mean); };
}

double Surfactant::energy() const {
  double sum = 0;
  for (const ElementPoints& at : elements_)
    for (int q = 0; q < at.n; ++q) sum += at.area()[q] * (options_.free_energy(at.c[static_cast<std::size_t>(q)]) - 1);
  return clean_tension_ * sum;
}

}  // namespace tanktread::membrane
