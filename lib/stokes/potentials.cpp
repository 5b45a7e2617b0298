#include "stokes/potentials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "spline/bernstein.hpp"
#include "stokes/far_kernel.hpp"
#include "stokes/pair_kernel.hpp"

namespace tanktread::stokes {
namespace {

constexpr double factor = 1 / (8 * std::numbers::pi);

/// x, x_,s, x_,t of a field with these Bezier points.
std::array<Vec3, 3> value(const double* bezier, int degree, double s, double t) {
  double bs[spline::max_degree + 1], bt[spline::max_degree + 1], ds[spline::max_degree + 1], dt[spline::max_degree + 1];
  spline::bernstein(degree, s, bs, ds, nullptr);
  spline::bernstein(degree, t, bt, dt, nullptr);
  const int n = degree + 1;
  std::array<Vec3, 3> sum{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double* q = bezier + n * j + i;
      const Vec3 p(q[0], q[n * n], q[2 * n * n]);
      sum[0] += bs[i] * bt[j] * p, sum[1] += ds[i] * bt[j] * p, sum[2] += bs[i] * dt[j] * p;
    }
  return sum;
}

/// The place of one panel that is nearest to y: best of a few samples, then Gauss-Newton steps kept inside the square.
std::pair<double, double> nearest(const double* bezier, int degree, const Vec3& y) {
  double s = 0.5, t = 0.5, best = 1e300;
  constexpr int samples = 4;
  for (int k = 0; k <= samples; ++k)
    for (int l = 0; l <= samples; ++l) {
      const double a = static_cast<double>(k) / samples, b = static_cast<double>(l) / samples;
      const double distance = (value(bezier, degree, a, b)[0] - y).squaredNorm();
      if (distance < best) best = distance, s = a, t = b;
    }
  for (int step = 0; step < 30; ++step) {
    const auto [x, a1, a2] = value(bezier, degree, s, t);
    const double g11 = a1.dot(a1), g12 = a1.dot(a2), g22 = a2.dot(a2), d1 = a1.dot(y - x), d2 = a2.dot(y - x);
    const double determinant = g11 * g22 - g12 * g12, before_s = s, before_t = t;
    s = std::clamp(s + (g22 * d1 - g12 * d2) / determinant, 0., 1.);
    t = std::clamp(t + (d2 - g12 * (s - before_s)) / g22, 0., 1.);  // with the step in s that was really made
    if (std::abs(s - before_s) + std::abs(t - before_t) < 1e-14) break;
  }
  return {s, t};
}

}  // namespace

Potentials::Potentials(const spline::Space& space, const quadrature::Options& options) : surface_(space, options, true) {}

void Potentials::place(const Net& x) {
  surface_.place(x);
  node_weights(surface_.panels, surface_.bezier, weight_);
  node_normals(surface_.panels, surface_.bezier, normal_);
}

std::optional<Foot> Potentials::foot(const Vec3& y) {
  std::optional<Foot> best;
  for (const int e : surface_.near(y)) {
    const Panel& panel = surface_.panels[e];
    const double* bezier = &surface_.bezier[panel.first_bezier];
    const auto [s, t] = nearest(bezier, panel.table->degree, y);
    const auto [x, a1, a2] = value(bezier, panel.table->degree, s, t);
    const double distance = (y - x).norm();
    if (best && best->distance <= distance) continue;
    const Vec3 n = a1.cross(a2).normalized();
    best = Foot{{e, s, t}, x, n, distance, (y - x).dot(n) < 0};
  }
  return best;
}

/// Calls far(first, count) for each run of nodes whose rule is enough for y, near(e, table) for every other panel.
template <class Add>
void Potentials::each_panel(const Vec3& y, const Add& add) {
  int next = 0;
  const auto run = [&](int end) {
    if (end > next) add.far(next, end - next);
    evaluations_.far += end - next;
  };
  for (const int e : std::vector<int>(surface_.near(y))) {
    const Panel& panel = surface_.panels[e];
    const PointTable& table = surface_.near_field.rule(e, y);
    run(panel.first_node);
    next = panel.first_node + panel.table->n_nodes;
    add.near(e, table);
    evaluations_.near += table.points;
  }
  run(surface_.panels.n_nodes());
}

namespace {

template <class Far, class Near>
struct Both {
  Far far;
  Near near;
};
template <class Far, class Near>
Both(Far, Near) -> Both<Far, Near>;

}  // namespace

std::vector<Vec3> Potentials::single_layer(const Net& f, std::span<const Vec3> points) {
  surface_.panels.bezier(f, bezier_field_);
  node_values(surface_.panels, bezier_field_, field_);
  for (auto& component : field_)
    for (std::size_t k = 0; k < weight_.size(); ++k) component[k] *= weight_[k];
  const auto& node = surface_.node;
  const PointForces all{surface_.panels.n_nodes(), node[0].data(),   node[1].data(),  node[2].data(),
                        field_[0].data(),          field_[1].data(), field_[2].data()};
  std::vector<Vec3> u;
  for (const Vec3& y : points) {
    Vec3 total = Vec3::Zero(), part;
    each_panel(y, Both{[&](int first, int count) {
                         node_sum(all.part(first, count), y.data(), part.data());
                         total += part;
                       },
                       [&](int e, const PointTable& table) {
                         const std::size_t bezier = surface_.panels[e].first_bezier;
                         point_weights_.resize(table.packs());
                         area_weights(table, &surface_.bezier[bezier], point_weights_.data());
                         single_sum(table, &surface_.bezier[bezier], &bezier_field_[bezier], point_weights_.data(), y.data(), part.data());
                         total += part;
                       }});
    u.push_back(factor * total);
  }
  return u;
}

std::vector<Vec3> Potentials::pressure_layer(std::span<const Vec3> points) {
  const auto& node = surface_.node;
  const PointForces all{surface_.panels.n_nodes(), node[0].data(),    node[1].data(),   node[2].data(),
                        normal_[0].data(),         normal_[1].data(), normal_[2].data()};
  std::vector<Vec3> u;
  for (const Vec3& y : points) {
    Vec3 total = Vec3::Zero(), part;
    each_panel(y, Both{[&](int first, int count) {
                         node_sum(all.part(first, count), y.data(), part.data());
                         total += part;
                       },
                       [&](int e, const PointTable& table) {
                         pressure_sum(table, &surface_.bezier[surface_.panels[e].first_bezier], y.data(), part.data());
                         total += part;
                       }});
    u.push_back(factor * total);
  }
  return u;
}

/// (1 / 8 pi) int (v_j - v0_j) T_ijk n_k dG of the field in bezier_field_ and field_.
Vec3 Potentials::double_sum_about(const Vec3& y, const Vec3& v0) {
  const auto& node = surface_.node;
  const Stresslets all{surface_.panels.n_nodes(), node[0].data(),   node[1].data(),    node[2].data(),    field_[0].data(),
                       field_[1].data(),          field_[2].data(), normal_[0].data(), normal_[1].data(), normal_[2].data()};
  Vec3 total = Vec3::Zero(), part;
  each_panel(y, Both{[&](int first, int count) {
                       node_sum(all.part(first, count), y.data(), v0.data(), part.data());
                       total += part;
                     },
                     [&](int e, const PointTable& table) {
                       const std::size_t bezier = surface_.panels[e].first_bezier;
                       double_sum(table, &surface_.bezier[bezier], &bezier_field_[bezier], y.data(), v0.data(), part.data());
                       total += part;
                     }});
  return factor * total;
}

std::vector<Vec3> Potentials::double_layer(const Net& v, std::span<const Vec3> points) {
  surface_.panels.bezier(v, bezier_field_);
  node_values(surface_.panels, bezier_field_, field_);
  std::vector<Vec3> u;
  for (const Vec3& y : points) {
    const std::optional<Foot> close = foot(y);
    Vec3 v0 = Vec3::Zero();
    if (close) {
      const Panel& panel = surface_.panels[close->site.element];
      v0 = value(&bezier_field_[panel.first_bezier], panel.table->degree, close->site.s, close->site.t)[0];
    }
    u.push_back(double_sum_about(y, v0) - (close && close->inside ? v0 : Vec3::Zero()));
  }
  return u;
}

std::vector<Mat3> Potentials::solid_angle(std::span<const Vec3> points) {
  std::vector<Mat3> angle(points.size());
  for (int j = 0; j < 3; ++j) {
    surface_.panels.bezier(Net(Vec3::Unit(j).transpose().replicate(surface_.n_points, 1)), bezier_field_);
    node_values(surface_.panels, bezier_field_, field_);
    for (std::size_t k = 0; k < points.size(); ++k) angle[k].col(j) = double_sum_about(points[k], Vec3::Zero());
  }
  return angle;
}

}  // namespace tanktread::stokes
