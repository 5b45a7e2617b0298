// Derivatives of the surfactant's load (3.18) and transport (3.17), exact at the state stored by linearise(), by dual numbers.

#include <cmath>

#include "membrane/dual.hpp"
#include "membrane/packed.hpp"
#include "membrane/surfactant.hpp"
#include "membrane/surfactant_kernel.hpp"

namespace tanktread::membrane {

namespace {

constexpr double shift_ratio = 1.25;  // ratio of neighbouring values of the shift for which solve() computes factors

/// Returns the power of shift_ratio that is nearest to `spread`, the shift times the diffusivity divided by the initial area. Factors
/// computed for this power serve all shifts close to it. The result depends neither on earlier shifts nor on units.
double rounded(double spread) { return std::pow(shift_ratio, std::round(std::log(spread) / std::log(shift_ratio))); }

using Changing = Dual<double>;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

/// Surface and concentration at a Gauss point with their derivatives with respect to s and t, the Gauss weight times J, and the contravariant metric,
/// all as dual numbers.
struct Surfactant::Point {
  Vector<Changing> s, t;
  Changing c, c_s, c_t, area, g11, g12, g22;

  Changing up_s(const Changing& along_s, const Changing& along_t) const { return g11 * along_s + g12 * along_t; }
  Changing up_t(const Changing& along_s, const Changing& along_t) const { return g12 * along_s + g22 * along_t; }
};

/// Calls use(element, data of the element stored by linearise(), point) for every element. point(q) returns the quantities at Gauss point q as dual
/// numbers, with their derivatives along (dx, dc).
template <class Use>
void Surfactant::each_change(const Net& dx, const Eigen::VectorXd& dc, const Use& use) const {
  double s[4 * max_gauss], t[4 * max_gauss], c[max_gauss];
  for (std::size_t e = 0; e < known_.size(); ++e) {
    const ElementPoints& at = known_[e];
    const std::vector<int>& points = space_.elements[e].points;
    RowMajor own(points.size(), 4);
    own << dx(points, Eigen::all), dc(points);
    const Eigen::VectorXd own_c = own.col(3);
    sample(4, at.n, at.functions, at.by_s.data(), own.data(), s);
    sample(4, at.n, at.functions, at.by_t.data(), own.data(), t);
    sample(1, at.n, at.functions, at.value.data(), own_c.data(), c);
    use(e, at, [&](int q) {
      const auto along = [&](const std::vector<double>& known, const double* change, int k) {
        return Changing{known[static_cast<std::size_t>(k * at.n + q)], change[k * at.n + q]};
      };
      Point p;
      for (int k = 0; k < 3; ++k) p.s[static_cast<std::size_t>(k)] = along(at.s, s, k), p.t[static_cast<std::size_t>(k)] = along(at.t, t, k);
      p.c = along(at.c, c, 0), p.c_s = along(at.s, s, 3), p.c_t = along(at.t, t, 3);
      const Changing ss = dot(p.s, p.s), st = dot(p.s, p.t), tt = dot(p.t, p.t), det = ss * tt - st * st;
      p.area = at.weight[static_cast<std::size_t>(q)] * sqrt(det);
      p.g11 = tt / det, p.g12 = -st / det, p.g22 = ss / det;
      return p;
    });
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
    sample(3, at.n, at.functions, at.value.data(), RowMajor(slip(space_.elements[e].points, Eigen::all)).data(), known_slip_.back().data());
  }
}

/// Solves M dc = dm - (dM) c for the change dc of the concentration, with the mass matrix M and the change dm of the contents m = M c.
Eigen::VectorXd Surfactant::value_change(const Net& dx, const Eigen::VectorXd& dq) const {
  Eigen::VectorXd content = share_.cwiseProduct(dq);
  each_change(dx, Eigen::VectorXd::Zero(dq.size()), [&](std::size_t e, const ElementPoints& at, const auto& point) {
    double spread[max_gauss], none[max_gauss] = {}, rows[spline::most_functions];
    for (int q = 0; q < at.n; ++q) spread[q] = -at.c[static_cast<std::size_t>(q)] * point(q).area.slope;
    test(1, at.n, at.functions, at.value.data(), at.value.data(), spread, none, rows);
    add_rows(e, rows, content);
  });
  return solver_.solve_scalar(known_mass_.update(known_x_), content);
}

Net Surfactant::load_change(const Net& dx, const Eigen::VectorXd& dc) const {
  Net d = Net::Zero(space_.n_points, 3);
  each_change(dx, dc, [&](std::size_t e, const ElementPoints& at, const auto& point) {
    double along_s[3 * max_gauss], along_t[3 * max_gauss], rows[3 * spline::most_functions];
    for (int q = 0; q < at.n; ++q) {
      const Point p = point(q);
      const Changing tension{options_.tension(p.c.value) - 1, options_.tension_slope(p.c.value) * p.c.slope};
      const Changing less = clean_tension_ * (tension * p.area);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(q) + k * static_cast<std::size_t>(at.n);
        along_s[i] = (less * p.up_s(p.s[k], p.t[k])).slope, along_t[i] = (less * p.up_t(p.s[k], p.t[k])).slope;
      }
    }
    test(3, at.n, at.functions, at.by_s.data(), at.by_t.data(), along_s, along_t, rows);
    add_rows(e, rows, d);
  });
  return d;
}

Eigen::VectorXd Surfactant::rate_change(const Net& dx, const Eigen::VectorXd& dc, const Net& slip_change) const {
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(space_.n_points);
  each_change(dx, dc, [&](std::size_t e, const ElementPoints& at, const auto& point) {
    double dw[3 * max_gauss] = {}, along_s[max_gauss], along_t[max_gauss], rows[spline::most_functions];
    if (slip_change.rows() > 0)
      sample(3, at.n, at.functions, at.value.data(), RowMajor(slip_change(space_.elements[e].points, Eigen::all)).data(), dw);
    for (int q = 0; q < at.n; ++q) {
      const Point p = point(q);
      Vector<Changing> w;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(q) + k * static_cast<std::size_t>(at.n);
        w[k] = {known_slip_.empty() ? 0 : known_slip_[e][i], dw[i]};
      }
      const Changing h_s = p.c * dot(w, p.s) - diffusivity_ * p.c_s, h_t = p.c * dot(w, p.t) - diffusivity_ * p.c_t;
      along_s[q] = (p.area * p.up_s(h_s, h_t)).slope, along_t[q] = (p.area * p.up_t(h_s, h_t)).slope;
    }
    test(1, at.n, at.functions, at.by_s.data(), at.by_t.data(), along_s, along_t, rows);
    add_rows(e, rows, rate);
  });
  return rate.cwiseQuotient(share_);
}

void Surfactant::freeze(const Net& x) {
  set_state(x, contents(x, Eigen::VectorXd::Ones(x.rows())));
  frozen_mass_ = mass_.update(x);
  frozen_stiffness_ = stiffness();
  factors_.reset();
}

/// Returns the stiffness matrix K_AB = int grad_s N_A.grad_s N_B dGamma of the shape set last.
Eigen::SparseMatrix<double> Surfactant::stiffness() const {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const ElementPoints& at = elements_[e];
    const std::vector<int>& points = space_.elements[e].points;
    for (std::size_t b = 0; b < points.size(); ++b) {
      double along_s[max_gauss], along_t[max_gauss], rows[spline::most_functions];
      for (int q = 0; q < at.n; ++q) {
        const std::size_t index = b * static_cast<std::size_t>(at.n) + static_cast<std::size_t>(q);
        const auto [up_s, up_t] = at.raised(q, at.by_s[index], at.by_t[index]);
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

/// Solves (M + shift D K) c = m for the concentration c, with mass M, diffusivity D, stiffness K, and contents m given by the coefficients r. Returns
/// the coefficients of the contents M c.
Eigen::VectorXd Surfactant::solve(double shift, const Eigen::VectorXd& r) const {
  if (diffusivity_ == 0 || frozen_mass_.rows() != r.size()) return r;
  const double area = share_.sum();  // area of the initial surface
  if (const double close = area * rounded(shift * diffusivity_ / area); !factors_ || factored_spread_ != close) {
    factors_ = std::make_unique<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>(frozen_mass_ + close * frozen_stiffness_);
    factored_spread_ = close;
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
