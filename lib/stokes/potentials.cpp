#include "stokes/potentials.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "stokes/pair_kernel.hpp"

namespace tanktread::stokes {
namespace {

constexpr double factor = 1 / (8 * std::numbers::pi);

/// The place (s, t) of one panel that is nearest to y: best of a few samples, then Gauss-Newton steps kept inside the square.
std::pair<double, double> nearest(const surface::Patch& patch, const Vec3& y) {
  double s = 0.5, t = 0.5, best = 1e300;
  constexpr int samples = 4;
  for (int k = 0; k <= samples; ++k)
    for (int l = 0; l <= samples; ++l) {
      const double a = static_cast<double>(k) / samples, b = static_cast<double>(l) / samples;
      const double distance = (surface::place(patch, a, b) - y).squaredNorm();
      if (distance < best) best = distance, s = a, t = b;
    }
  for (int step = 0; step < 30; ++step) {
    const surface::Jet at = surface::jet(patch, s, t);
    const Vec3 r = y - at.x;
    const double g11 = at.s.dot(at.s), g12 = at.s.dot(at.t), g22 = at.t.dot(at.t), d1 = at.s.dot(r), d2 = at.t.dot(r);
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

surface::Patch Potentials::patch(int panel, const std::vector<double>& bezier) const {
  return {surface_.panels[panel].table->degree, &bezier[surface_.panels[panel].first_bezier]};
}

std::optional<Foot> Potentials::foot(const Vec3& y) {
  std::optional<Foot> best;
  for (const int e : surface_.near(y)) {
    const surface::Patch here = patch(e, surface_.bezier);
    const auto [s, t] = nearest(here, y);
    const surface::Jet at = surface::jet(here, s, t);
    const double distance = (y - at.x).norm();
    if (best && best->distance <= distance) continue;
    const Vec3 n = at.s.cross(at.t).normalized();
    best = Foot{{e, s, t}, at.x, n, distance, (y - at.x).dot(n) < 0};
  }
  return best;
}

/// The sum over all panels, over 8 pi: far(first, count, sum) of each run of nodes whose rule is enough for y, near(bezier, table, sum) of every
/// other panel, `bezier` where its Bezier points begin.
template <class Far, class Near>
Vec3 Potentials::integral(const Vec3& y, const Far& far, const Near& near) {
  Vec3 total = Vec3::Zero(), part;
  int next = 0;
  const auto run = [&](int end) {
    if (end > next) far(next, end - next, part.data()), total += part;
    evaluations_.far += end - next;
  };
  for (const int e : std::vector<int>(surface_.near(y))) {
    const Panel& panel = surface_.panels[e];
    const PointTable& table = surface_.near_field.rule(e, y);
    run(panel.first_node);
    next = panel.first_node + panel.table->n_nodes;
    near(panel.first_bezier, table, part.data()), total += part;
    evaluations_.near += table.points;
  }
  run(surface_.panels.n_nodes());
  return factor * total;
}

/// What the far nodes carry in f, as point forces.
PointForces Potentials::forces(const std::vector<double> (&f)[3]) const {
  const auto& node = surface_.node;
  return {surface_.panels.n_nodes(), node[0].data(), node[1].data(), node[2].data(), f[0].data(), f[1].data(), f[2].data()};
}

std::vector<Vec3> Potentials::single_layer(const Net& f, std::span<const Vec3> points) {
  take(f);
  for (auto& component : field_)
    for (std::size_t k = 0; k < weight_.size(); ++k) component[k] *= weight_[k];
  const PointForces all = forces(field_);
  std::vector<Vec3> u;
  for (const Vec3& y : points)
    u.push_back(integral(
        y, [&](int first, int count, double* sum) { node_sum(all.part(first, count), y.data(), sum); },
        [&](std::size_t bezier, const PointTable& table, double* sum) {
          point_weights_.resize(table.packs());
          area_weights(table, &surface_.bezier[bezier], point_weights_.data());
          single_sum(table, &surface_.bezier[bezier], &bezier_field_[bezier], point_weights_.data(), y.data(), sum);
        }));
  return u;
}

std::vector<Vec3> Potentials::pressure_layer(std::span<const Vec3> points) {
  const PointForces all = forces(normal_);
  std::vector<Vec3> u;
  for (const Vec3& y : points)
    u.push_back(integral(
        y, [&](int first, int count, double* sum) { node_sum(all.part(first, count), y.data(), sum); },
        [&](std::size_t bezier, const PointTable& table, double* sum) { pressure_sum(table, &surface_.bezier[bezier], y.data(), sum); }));
  return u;
}

/// (1 / 8 pi) int (v_j - v0_j) T_ijk n_k dG of the field taken.
Vec3 Potentials::double_sum_about(const Vec3& y, const Vec3& v0) {
  const auto& node = surface_.node;
  const Stresslets all{surface_.panels.n_nodes(), node[0].data(),   node[1].data(),    node[2].data(),    field_[0].data(),
                       field_[1].data(),          field_[2].data(), normal_[0].data(), normal_[1].data(), normal_[2].data()};
  return integral(
      y, [&](int first, int count, double* sum) { node_sum(all.part(first, count), y.data(), v0.data(), sum); },
      [&](std::size_t bezier, const PointTable& table, double* sum) {
        double_sum(table, &surface_.bezier[bezier], &bezier_field_[bezier], y.data(), v0.data(), sum);
      });
}

void Potentials::take(const Net& field) {
  surface_.panels.bezier(field, bezier_field_);
  node_values(surface_.panels, bezier_field_, field_);
}

std::vector<Vec3> Potentials::double_layer(const Net& v, std::span<const Vec3> points) {
  take(v);
  std::vector<Vec3> u;
  for (const Vec3& y : points) {
    const std::optional<Foot> close = foot(y);
    const Vec3 v0 = close ? surface::place(patch(close->site.element, bezier_field_), close->site.s, close->site.t) : Vec3(Vec3::Zero());
    u.push_back(double_sum_about(y, v0) - (close && close->inside ? v0 : Vec3::Zero()));
  }
  return u;
}

std::vector<Mat3> Potentials::solid_angle(std::span<const Vec3> points) {
  std::vector<Mat3> angle(points.size());
  for (int j = 0; j < 3; ++j) {
    take(Net(Vec3::Unit(j).transpose().replicate(surface_.n_points, 1)));
    for (std::size_t k = 0; k < points.size(); ++k) angle[k].col(j) = double_sum_about(points[k], Vec3::Zero());
  }
  return angle;
}

}  // namespace tanktread::stokes
