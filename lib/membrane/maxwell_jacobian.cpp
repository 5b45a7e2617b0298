// Derivatives of the Maxwell element's load and rate (3.24), exact at the state stored by linearise(), by dual numbers.

#include <algorithm>

#include <Eigen/LU>

#include "membrane/dual.hpp"
#include "membrane/maxwell_element.hpp"

namespace tanktread::membrane {

namespace {

using Changing = Dual<double>;
using Symmetric = Vector<Changing>;  // components 11, 12, 22

Changing determinant(const Symmetric& a) { return a[0] * a[2] - a[1] * a[1]; }

/// Returns the vector with the components packs[first .. first + 2] in the register lane `lane`, as dual numbers. Their directional derivatives are
/// taken from `changes`.
Vector<Changing> vector_of(const Pack* packs, const Pack* changes, int first, int lane) {
  const int lanes = pack_lanes();
  const auto number = [&](int k) { return Changing{numbers(packs)[(first + k) * lanes + lane], numbers(changes)[(first + k) * lanes + lane]}; };
  return {number(0), number(1), number(2)};
}

}  // namespace

/// Quantities at a Gauss point: tangents, metric g_ab, inverse metric g^ab, strain C^ab, sqrt |g|, sqrt |C|, and J and t of (3.23), all as dual
/// numbers.
struct MaxwellElement::Point {
  Vector<Changing> a_s, a_t;
  Symmetric g, up, c;
  Changing gamma, kappa, j, t;

  Point(const Vector<Changing>& s, const Vector<Changing>& r, const Symmetric& strain)
      : a_s(s), a_t(r), g{dot(s, s), dot(s, r), dot(r, r)}, c(strain) {
    const Changing det = determinant(g);
    up = {g[2] / det, -g[1] / det, g[0] / det};
    gamma = sqrt(det), kappa = sqrt(determinant(c)), j = gamma * kappa, t = c[0] * g[0] + 2.0 * (c[1] * g[1]) + c[2] * g[2];
  }

  /// Returns the stress S^ab of the energy E (3.23) per parametric area, dE = S^ab x_,a.dx_,b. k = 0, 1, 2 selects the component 11, 12, 22.
  Changing stress(const MaxwellSpring& spring, std::size_t k) const {
    const Changing dilatation = (spring.dilatation_modulus / 2) * ((j - 1.0) * (3.0 * j - 1.0)), metric = gamma * up[k];
    return spring.shear_modulus * (c[k] / kappa - metric) + dilatation * metric;
  }

  /// Returns the directional derivative of T dC^ab/dt (3.24), with T the relaxation time.
  Eigen::Vector3d rate_change() const {
    const auto rate = [&](std::size_t k) { return 2.0 * (j * j / t * up[k]) + (1.0 / j - 2.0) * c[k]; };
    return {rate(0).slope, rate(1).slope, rate(2).slope};
  }
};

/// Calls use(group, batch, q, lane, row, point) for every Gauss point q of every element. The element is in register lane `lane` of the batch. `row`:
/// index of the Gauss point among all elements. `point`: its tangents and strains, with their changes due to dx and dq.
template <class Use>
void MaxwellElement::each_change(const Net& dx, const Eigen::VectorXd& dq, const Use& use) const {
  for (const Group& group : groups_)
    for (const Batch& batch : group.batches) {
      Pack a[6 * max_gauss], da[6 * max_gauss];
      tangents(group, batch, known_x_, a);
      tangents(group, batch, dx, da);
      for (int q = 0; q < group.n_gauss(); ++q)
        for (int l = 0; l < batch.used; ++l) {
          const Eigen::Index row = first_[static_cast<std::size_t>(batch.elements[static_cast<std::size_t>(l)])] + q;
          const auto strain = [&](int k) { return unit_(row, k) * Changing{known_q_[3 * row + k], dq[3 * row + k]}; };
          use(group, batch, q, l, row, Point(vector_of(a, da, 6 * q, l), vector_of(a, da, 6 * q + 3, l), {strain(0), strain(1), strain(2)}));
        }
    }
}

void MaxwellElement::linearise(const Net&) {
  known_x_ = x_, known_q_ = q_;
  known_rates_.assign(static_cast<std::size_t>(unit_.rows()), {});
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXd change = rate_change(Net::Zero(x_.rows(), 3), Eigen::Vector3d::Unit(k).replicate(unit_.rows(), 1), {});
    for (Eigen::Index row = 0; row < unit_.rows(); ++row) known_rates_[static_cast<std::size_t>(row)].col(k) = change.segment<3>(3 * row);
  }
}

Net MaxwellElement::load_change(const Net& dx, const Eigen::VectorXd& dq) const {
  Net d = Net::Zero(space_.n_points, 3);
  Pack p[6 * max_gauss] = {};
  const int lanes = pack_lanes();
  each_change(dx, dq, [&](const Group& group, const Batch& batch, int q, int l, Eigen::Index, const Point& at) {
    const Changing s11 = at.stress(spring_, 0), s12 = at.stress(spring_, 1), s22 = at.stress(spring_, 2);
    const double weight = group.weight[static_cast<std::size_t>(q)];
    for (int k = 0; k < 3; ++k) {
      const Changing &s = at.a_s[static_cast<std::size_t>(k)], &t = at.a_t[static_cast<std::size_t>(k)];
      numbers(p)[(6 * q + k) * lanes + l] = weight * (s11 * s + s12 * t).slope;
      numbers(p)[(6 * q + 3 + k) * lanes + l] = weight * (s12 * s + s22 * t).slope;
    }
    if (q + 1 < group.n_gauss() || l + 1 < batch.used) return;
    add_transpose(group, batch, p, d);
    std::ranges::fill(p, Pack{});
  });
  return d;
}

Eigen::VectorXd MaxwellElement::rate_change(const Net& dx, const Eigen::VectorXd& dq, const Net&) const {
  Eigen::VectorXd rate(size());
  each_change(dx, dq, [&](const Group&, const Batch&, int, int, Eigen::Index row, const Point& at) {
    rate.segment<3>(3 * row) = at.rate_change().cwiseQuotient(time_ * unit_.row(row).transpose());
  });
  return rate;
}

Eigen::VectorXd MaxwellElement::solve(double shift, const Eigen::VectorXd& r) const {
  Eigen::VectorXd dq(size());
  for (Eigen::Index row = 0; row < unit_.rows(); ++row) {
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity() - shift * known_rates_[static_cast<std::size_t>(row)];
    dq.segment<3>(3 * row) = one.inverse() * r.segment<3>(3 * row);
  }
  return dq;
}

}  // namespace tanktread::membrane
