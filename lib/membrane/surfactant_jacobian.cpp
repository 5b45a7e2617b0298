// Derivatives of the surfactant's load (3.18) and transport (3.17), exact at the state that linearise() keeps.

#include <algorithm>
#include <cmath>

#include "membrane/surfactant.hpp"
#include "membrane/surfactant_kernel.hpp"

namespace tanktread::membrane {

namespace {

constexpr std::size_t most_gauss_points = 144, functions_of_element = 64;  // of an element
constexpr double shift_ratio = 1.25;                           // of neighbouring shifts for which solve() has factors

/// Returns the neighbouring value in a geometric sequence, so that factors depend on the present shift only.
double rounded(double shift) { return std::pow(shift_ratio, std::round(std::log(shift) / std::log(shift_ratio))); }

Eigen::VectorXd own_values(const std::vector<int>& points, const Eigen::VectorXd& values) {
  Eigen::VectorXd own(static_cast<Eigen::Index>(points.size()));
  for (std::size_t a = 0; a < points.size(); ++a) own[static_cast<Eigen::Index>(a)] = values[points[a]];
  return own;
}

Net own_rows(const std::vector<int>& points, const Net& net) {
  Net own(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t a = 0; a < points.size(); ++a) own.row(static_cast<Eigen::Index>(a)) = net.row(points[a]);
  return own;
}

}  // namespace

/// Changes at the Gauss points of an element: tangents and concentration, three fields each and one; div = (dJ)/J; contravariant metric.
struct Surfactant::MetricChange {
  double s[3 * most_gauss_points], t[3 * most_gauss_points], c[most_gauss_points], c_s[most_gauss_points], c_t[most_gauss_points];
  double div[most_gauss_points], g11[most_gauss_points], g12[most_gauss_points], g22[most_gauss_points];
};

/// Calls use(element, its points as linearised, change) for every element. Without `dc` the concentration does not change.
template <class Use>
void Surfactant::each_change(const Net& dx, const Eigen::VectorXd* dc, const Use& use) const {
  MetricChange change{};
  for (std::size_t e = 0; e < known_.size(); ++e) {
    const ElementPoints& at = known_[e];
    const std::vector<int>& points = space_.elements[e].points;
    const Net own = own_rows(points, dx);
    sample(3, at.n, at.functions, at.by_s.data(), own.data(), change.s);
    sample(3, at.n, at.functions, at.by_t.data(), own.data(), change.t);
    if (dc) {
      const Eigen::VectorXd own_c = own_values(points, *dc);
      sample(1, at.n, at.functions, at.value.data(), own_c.data(), change.c);
      sample(1, at.n, at.functions, at.by_s.data(), own_c.data(), change.c_s);
      sample(1, at.n, at.functions, at.by_t.data(), own_c.data(), change.c_t);
    }
    const double *g11 = at.metric.data(), *g12 = g11 + at.n, *g22 = g12 + at.n;
    for (int q = 0; q < at.n; ++q) {
      double ss = 0, st = 0, tt = 0;  // of the covariant metric
      for (int i = q; i < 3 * at.n; i += at.n) {
        const double s = at.s[static_cast<std::size_t>(i)], t = at.t[static_cast<std::size_t>(i)];
        ss += 2 * s * change.s[i], st += s * change.t[i] + t * change.s[i], tt += 2 * t * change.t[i];
      }
      change.div[q] = 0.5 * (g11[q] * ss + 2 * g12[q] * st + g22[q] * tt);
      change.g11[q] = -(g11[q] * g11[q] * ss + 2 * g11[q] * g12[q] * st + g12[q] * g12[q] * tt);
      change.g12[q] = -(g11[q] * g12[q] * ss + (g11[q] * g22[q] + g12[q] * g12[q]) * st + g12[q] * g22[q] * tt);
      change.g22[q] = -(g12[q] * g12[q] * ss + 2 * g12[q] * g22[q] * st + g22[q] * g22[q] * tt);
    }
    use(e, at, change);
  }
}

void Surfactant::linearise(const Net& slip) {
  known_ = elements_;
  known_x_ = x_;
  known_slip_.clear();
  if (slip.rows() == 0) return;
  for (std::size_t e = 0; e < known_.size(); ++e) {
    const ElementPoints& at = known_[e];
    known_slip_.emplace_back(3 * static_cast<std::size_t>(at.n));
    sample(3, at.n, at.functions, at.value.data(), own_rows(space_.elements[e].points, slip).data(), known_slip_.back().data());
  }
}

/// M dc = dm - (dM) c.
Eigen::VectorXd Surfactant::value_change(const Net& dx, const Eigen::VectorXd& dq) const {
  Net content = Net::Zero(space_.n_points, 3);  // the solver has three columns
  content.col(0) = share_.cwiseProduct(dq);
  each_change(dx, nullptr, [&](std::size_t e, const ElementPoints& at, const MetricChange& change) {
    double spread[most_gauss_points], none[most_gauss_points] = {}, rows[functions_of_element];
    for (int q = 0; q < at.n; ++q) spread[q] = at.area()[q] * at.c[static_cast<std::size_t>(q)] * change.div[q];
    test(1, at.n, at.functions, at.value.data(), at.value.data(), spread, none, rows);
    const std::vector<int>& points = space_.elements[e].points;
    for (std::size_t a = 0; a < points.size(); ++a) content(points[a], 0) -= rows[a];
  });
  return solver_.solve(known_mass_.update(known_x_), content).col(0);
}

Net Surfactant::load_change(const Net& dx, const Eigen::VectorXd& dc) const {
  Net d = Net::Zero(space_.n_points, 3);
  each_change(dx, &dc, [&](std::size_t e, const ElementPoints& at, const MetricChange& change) {
    double along_s[3 * most_gauss_points], along_t[3 * most_gauss_points], rows[3 * functions_of_element];
    for (int q = 0; q < at.n; ++q) {
      const double c = at.c[static_cast<std::size_t>(q)], area = clean_tension_ * at.area()[q], less = options_.tension(c) - 1;
      const double more = options_.tension_slope(c) * change.c[q] + less * change.div[q];
      for (int i = q; i < 3 * at.n; i += at.n) {
        const double s = at.s[static_cast<std::size_t>(i)], t = at.t[static_cast<std::size_t>(i)];
        const auto [up_s, up_t] = at.raised(q, more * s + less * change.s[i], more * t + less * change.t[i]);
        along_s[i] = area * (up_s + less * (change.g11[q] * s + change.g12[q] * t));
        along_t[i] = area * (up_t + less * (change.g12[q] * s + change.g22[q] * t));
      }
    }
    test(3, at.n, at.functions, at.by_s.data(), at.by_t.data(), along_s, along_t, rows);
    const std::vector<int>& points = space_.elements[e].points;
    for (std::size_t a = 0; a < points.size(); ++a) d.row(points[a]) += Eigen::Map<const Eigen::RowVector3d>(rows + 3 * a);
  });
  return d;
}

Eigen::VectorXd Surfactant::rate_change(const Net& dx, const Eigen::VectorXd& dc, const Net& slip_change) const {
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(space_.n_points);
  each_change(dx, &dc, [&](std::size_t e, const ElementPoints& at, const MetricChange& change) {
    const std::vector<int>& points = space_.elements[e].points;
    double w[3 * most_gauss_points] = {}, dw[3 * most_gauss_points] = {};
    double along_s[most_gauss_points], along_t[most_gauss_points], rows[functions_of_element];
    if (!known_slip_.empty()) std::ranges::copy(known_slip_[e], w);
    if (slip_change.rows() > 0) sample(3, at.n, at.functions, at.value.data(), own_rows(points, slip_change).data(), dw);
    for (int q = 0; q < at.n; ++q) {
      const double c = at.c[static_cast<std::size_t>(q)];
      const auto gradient = static_cast<std::size_t>(3 * at.n + q);
      double h_s = -diffusivity_ * at.s[gradient], h_t = -diffusivity_ * at.t[gradient];
      double dh_s = -diffusivity_ * change.c_s[q], dh_t = -diffusivity_ * change.c_t[q];
      for (int i = q; i < 3 * at.n; i += at.n) {
        const double s = at.s[static_cast<std::size_t>(i)], t = at.t[static_cast<std::size_t>(i)];
        const double moved = change.c[q] * w[i] + c * dw[i];
        h_s += c * w[i] * s, h_t += c * w[i] * t;
        dh_s += moved * s + c * w[i] * change.s[i], dh_t += moved * t + c * w[i] * change.t[i];
      }
      const auto [up_s, up_t] = at.raised(q, change.div[q] * h_s + dh_s, change.div[q] * h_t + dh_t);
      along_s[q] = at.area()[q] * (up_s + change.g11[q] * h_s + change.g12[q] * h_t);
      along_t[q] = at.area()[q] * (up_t + change.g12[q] * h_s + change.g22[q] * h_t);
    }
    test(1, at.n, at.functions, at.by_s.data(), at.by_t.data(), along_s, along_t, rows);
    for (std::size_t a = 0; a < points.size(); ++a) rate[points[a]] += rows[a];
  });
  return rate.cwiseQuotient(share_);
}

void Surfactant::freeze(const Net& x) {
  set_state(x, contents(x, Eigen::VectorXd::Ones(x.rows())));
  frozen_mass_ = mass_.update(x);
  frozen_stiffness_ = stiffness();
  factors_.reset();
}

/// int grad_s N_A.grad_s N_B dG of the shape set last.
Eigen::SparseMatrix<double> Surfactant::stiffness() const {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const ElementPoints& at = elements_[e];
    const std::vector<int>& points = space_.elements[e].points;
    for (std::size_t b = 0; b < points.size(); ++b) {
      double along_s[most_gauss_points], along_t[most_gauss_points], rows[functions_of_element];
      for (int q = 0; q < at.n; ++q) {
        const std::size_t place = b * static_cast<std::size_t>(at.n) + static_cast<std::size_t>(q);
        const auto [up_s, up_t] = at.raised(q, at.by_s[place], at.by_t[place]);
        along_s[q] = at.area()[q] * up_s, along_t[q] = at.area()[q] * up_t;
      }
      test(1, at.n, at.functions, at.by_s.data(), at.by_t.data(), along_s, along_t, rows);
      for (std::size_t a = 0; a < points.size(); ++a) entries.emplace_back(points[a], points[b], rows[a]);
    }
  }
  Eigen::SparseMatrix<double> matrix(space_.n_points, space_.n_points);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// (M + shift D K) c = r, M c the contents.
Eigen::VectorXd Surfactant::solve(double shift, const Eigen::VectorXd& r) const {
  if (diffusivity_ == 0 || frozen_mass_.rows() != r.size()) return r;
  if (const double close = rounded(shift); !factors_ || factored_shift_ != close) {
    factors_ = std::make_unique<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>(frozen_mass_ + close * diffusivity_ * frozen_stiffness_);
    factored_shift_ = close;
  }
  return (frozen_mass_ * factors_->solve(share_.cwiseProduct(r))).cwiseQuotient(share_);
}

void Surfactant::conserve(const Eigen::VectorXd& r, Eigen::VectorXd& dq) const { dq.array() += share_.dot(r - dq) / share_.sum(); }

std::vector<std::pair<int, double>> Surfactant::images(const surface::Image& image) const {
  std::vector<std::pair<int, double>> all;
  for (const int point : image.point) all.emplace_back(point, 1);
  return all;
}

Eigen::VectorXd Surfactant::contents(const Net& x, const Eigen::VectorXd& c) const { return (mass_.update(x) * c).cwiseQuotient(share_); }

}  // namespace tanktread::membrane
