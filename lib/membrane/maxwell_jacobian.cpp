// Derivatives of the Maxwell element's load and rate (3.24), exact at the state that linearise() keeps.

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "membrane/maxwell_element.hpp"

namespace tanktread::membrane {

namespace {

constexpr int gauss_room = max_order * max_order;

/// Components 11, 12, 22 of a symmetric tensor, and their product with another one of the opposite position.
using Symmetric = Eigen::Vector3d;
double contracted(const Symmetric& a, const Symmetric& b) { return a[0] * b[0] + 2 * a[1] * b[1] + a[2] * b[2]; }
double determinant(const Symmetric& a) { return a[0] * a[2] - a[1] * a[1]; }
Symmetric inverse(const Symmetric& a) { return Symmetric(a[2], -a[1], a[0]) / determinant(a); }

/// -g^ac dg_cd g^db.
Symmetric inverse_change(const Symmetric& up, const Symmetric& dg) {
  return -Symmetric(up[0] * up[0] * dg[0] + 2 * up[0] * up[1] * dg[1] + up[1] * up[1] * dg[2],
                    up[0] * up[1] * dg[0] + (up[0] * up[2] + up[1] * up[1]) * dg[1] + up[1] * up[2] * dg[2],
                    up[1] * up[1] * dg[0] + 2 * up[1] * up[2] * dg[1] + up[2] * up[2] * dg[2]);
}

Vec3 vector_of(const Pack* packs, int first, int lane) {
  const double* all = numbers(packs);
  const int lanes = pack_lanes();
  return {all[first * lanes + lane], all[(first + 1) * lanes + lane], all[(first + 2) * lanes + lane]};
}

}  // namespace

struct MaxwellElement::Point {
  Vec3 a_s, a_t;             // tangents
  Symmetric g, up, c;        // g_ab, g^ab, C^ab
  double gamma, kappa, j, t;  // sqrt |g|, sqrt |C|, J, t

  Point(const Vec3& s, const Vec3& r, const Symmetric& strain) : a_s(s), a_t(r), g(s.dot(s), s.dot(r), r.dot(r)), up(inverse(g)), c(strain) {
    gamma = std::sqrt(determinant(g)), kappa = std::sqrt(determinant(c)), j = gamma * kappa, t = contracted(c, g);
  }

  /// The changes that those of the tangents and of C make.
  struct Change {
    Symmetric up, c;
    double div, phi, j, t;  // of up and C; (d gamma)/gamma, (d kappa)/kappa, dJ, dt
  };
  Change change(const Vec3& ds, const Vec3& dr, const Symmetric& dc) const {
    const Symmetric dg(2 * a_s.dot(ds), a_s.dot(dr) + a_t.dot(ds), 2 * a_t.dot(dr));
    const double div = contracted(up, dg) / 2, phi = contracted(inverse(c), dc) / 2;
    return {inverse_change(up, dg), dc, div, phi, j * (div + phi), contracted(dc, g) + contracted(c, dg)};
  }

  /// S^ab of E (3.23) per parametric area, dE = S^ab x_,a.dx_,b, and its change.
  Symmetric stress(const MaxwellSpring& spring) const {
    const double k = spring.dilatation_modulus / 2 * (j - 1) * (3 * j - 1);
    return spring.shear_modulus * (c / kappa - gamma * up) + k * gamma * up;
  }
  Symmetric stress_change(const MaxwellSpring& spring, const Change& d) const {
    const double k = spring.dilatation_modulus / 2;
    const Symmetric metric = gamma * (d.div * up + d.up);
    return spring.shear_modulus * ((d.c - d.phi * c) / kappa - metric) + k * ((j - 1) * (3 * j - 1) * metric + (6 * j - 4) * d.j * gamma * up);
  }

  /// Change of T dC^ab/dt (3.24).
  Symmetric rate_change(const Change& d) const {
    return 2 * j / t * ((2 * d.j - j * d.t / t) * up + j * d.up) - d.j / (j * j) * c - (2 - 1 / j) * d.c;
  }
};

/// Calls use(group, batch, Gauss point, lane, row of q, point, change, changes of the tangents) for every Gauss point of every element.
template <class Use>
void MaxwellElement::each_change(const Net& dx, const Eigen::VectorXd& dq, const Use& use) const {
  for (const Group& group : groups_)
    for (const Batch& batch : group.batches) {
      Pack a[6 * gauss_room], da[6 * gauss_room];
      tangents(group, batch, known_x_, a);
      tangents(group, batch, dx, da);
      for (int q = 0; q < group.n_gauss(); ++q)
        for (int l = 0; l < batch.used; ++l) {
          const Eigen::Index row = first_[static_cast<std::size_t>(batch.elements[static_cast<std::size_t>(l)])] + q;
          const Eigen::Vector3d unit = unit_.row(row);
          const Point at(vector_of(a, 6 * q, l), vector_of(a, 6 * q + 3, l), known_q_.segment<3>(3 * row).cwiseProduct(unit));
          const Vec3 ds = vector_of(da, 6 * q, l), dt = vector_of(da, 6 * q + 3, l);
          const typename Point::Change change = at.change(ds, dt, dq.segment<3>(3 * row).cwiseProduct(unit));
          use(group, batch, q, l, row, at, change, ds, dt);
        }
    }
}

void MaxwellElement::linearise(const Net&) {
  known_x_ = x_, known_q_ = q_;
  known_rates_.assign(static_cast<std::size_t>(unit_.rows()), {});
  for (int k = 0; k < 3; ++k)
    each_change(Net::Zero(x_.rows(), 3), Eigen::Vector3d::Unit(k).replicate(unit_.rows(), 1),
                [&](const Group&, const Batch&, int, int, Eigen::Index row, const Point& at, const Point::Change& change, const Vec3&, const Vec3&) {
                  known_rates_[static_cast<std::size_t>(row)].col(k) = at.rate_change(change).cwiseQuotient(time_ * unit_.row(row).transpose());
                });
}

Net MaxwellElement::load_change(const Net& dx, const Eigen::VectorXd& dq) const {
  Net d = Net::Zero(space_.n_points, 3);
  Pack p[6 * gauss_room] = {};
  const int lanes = pack_lanes();
  each_change(dx, dq, [&](const Group& group, const Batch& batch, int q, int l, Eigen::Index, const Point& at, const Point::Change& change,
                          const Vec3& ds, const Vec3& dt) {
    const Symmetric s = at.stress(spring_), more = at.stress_change(spring_, change);
    const double weight = group.weight[static_cast<std::size_t>(q)];
    const Vec3 along_s = weight * (more[0] * at.a_s + more[1] * at.a_t + s[0] * ds + s[1] * dt);
    const Vec3 along_t = weight * (more[1] * at.a_s + more[2] * at.a_t + s[1] * ds + s[2] * dt);
    for (int k = 0; k < 3; ++k) numbers(p)[(6 * q + k) * lanes + l] = along_s[k], numbers(p)[(6 * q + 3 + k) * lanes + l] = along_t[k];
    if (q + 1 < group.n_gauss() || l + 1 < batch.used) return;
    add_transpose(group, batch, p, d);
    std::ranges::fill(p, Pack{});
  });
  return d;
}

Eigen::VectorXd MaxwellElement::rate_change(const Net& dx, const Eigen::VectorXd& dq, const Net&) const {
  Eigen::VectorXd rate(size());
  each_change(dx, dq, [&](const Group&, const Batch&, int, int, Eigen::Index row, const Point& at, const Point::Change& change, const Vec3&,
                          const Vec3&) { rate.segment<3>(3 * row) = at.rate_change(change).cwiseQuotient(time_ * unit_.row(row).transpose()); });
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
