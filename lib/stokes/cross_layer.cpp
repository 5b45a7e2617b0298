#include "stokes/cross_layer.hpp"

#include <algorithm>
#include <cassert>
#include <numbers>

#include "stokes/far_kernel.hpp"
#include "stokes/pair_kernel.hpp"

namespace tanktread::stokes {
namespace {

constexpr double factor = 1 / (8 * std::numbers::pi);

void sum_of(const PointForces& part, const double* x0, const double*, double* u) { node_sum(part, x0, u); }
void sum_of(const Stresslets& part, const double* x0, const double* v0, double* u) { node_sum(part, x0, v0, u); }
void sums_of(const PointForces& all, std::span<const Vec3> x0, std::span<const Vec3>, double* u) { far_sums(all, x0, u); }
void sums_of(const Stresslets& all, std::span<const Vec3> x0, std::span<const Vec3> v0, double* u) { far_sums(all, x0, v0, u); }

std::vector<Vec3> rows_of(const Net& net, std::span<const int> rows) {
  std::vector<Vec3> result;
  result.reserve(rows.size());
  for (const int i : rows) result.push_back(net.row(i).transpose());
  return result;
}

/// Gauss points a direction of the far rule; 0: those of targets on the surface. Off it, where near rules take over in time, the kernel is
/// smoother: with three the far part errs by 1e-8 to 2e-7 (tests/verify/tube_gap.cpp).
int far_order(const quadrature::Options& options) { return options.rule == "adaptive" && options.tolerance >= 1e-5 ? 3 : 0; }

/// The double layer errs up to five times as much under the same rules.
quadrature::Options sharper(quadrature::Options options, CrossLayer::Kernel kernel) {
  if (kernel == CrossLayer::Kernel::double_layer) options.tolerance /= 8;
  return options;
}

}  // namespace

CrossLayer::CrossLayer(const spline::Space& source, const quadrature::Options& options, Kernel kernel)
    : kernel_(kernel),
      surface_(source, sharper(options, kernel), kernel == Kernel::double_layer ? Steep::everywhere : Steep::nowhere, far_order(options)) {}

void CrossLayer::set_reference(const Net& unstressed) {
  surface_.panels.bezier(unstressed, bezier_unstressed_);
  node_weights(surface_.panels, bezier_unstressed_, weight_unstressed_);
}

void CrossLayer::place(const Net& x, Measure measure) {
  assert((measure == Measure::current || !weight_unstressed_.empty()) && "set_reference() comes first");
  const auto clock = phases_.time("setup");
  measure_ = measure;
  surface_.place(x);
  if (kernel_ == Kernel::double_layer) return node_normals(surface_.panels, surface_.bezier, normal_);
  if (measure == Measure::current)
    node_weights(surface_.panels, surface_.bezier, weight_);
  else
    weight_ = weight_unstressed_;
}

const Pack* CrossLayer::area_weights_of(int e, const PointTable& table) {
  const auto& surface = measure_ == Measure::current ? surface_.bezier : bezier_unstressed_;
  point_weights_.resize(table.packs());
  area_weights(table, &surface[surface_.panels[e].first_bezier], point_weights_.data());
  return point_weights_.data();
}

/// `own(e, table, k, sum)`: what panel e gives the target k under its near rule.
template <class Sources, class Own>
void CrossLayer::integrate(const Sources& all, const Net* v0, const Own& own, const Net& at, std::span<const int> targets, Net& u,
                           const Near* kept) {
  {
    const auto clock = phases_.time("far");
    Net sums(targets.size(), 3);
    sums_of(all, rows_of(at, targets), v0 ? rows_of(*v0, targets) : std::vector<Vec3>(), sums.data());
    for (std::size_t k = 0; k < targets.size(); ++k) u.row(targets[k]) = sums.row(static_cast<Eigen::Index>(k));
    evaluations_.far += static_cast<long long>(targets.size()) * all.n;
  }
  const auto clock = phases_.time("near");
  if (kept) {
    add_kept(*kept, v0, targets, u);
    for (const int i : targets) u.row(i) *= factor;
    return;
  }
  const double zero[3] = {0, 0, 0};
  for (const int i : targets) {
    const Vec3 y = at.row(i).transpose();
    for (const int e : surface_.near(y)) {
      const Panel& panel = surface_.panels[e];
      const PointTable& table = surface_.near_field.rule(e, y, {});
      Vec3 close, far;
      own(e, table, i, y, close);
      sum_of(all.part(panel.first_node, panel.table->n_nodes), y.data(), v0 ? v0->row(i).data() : zero, far.data());
      u.row(i) += (close - far).transpose();
      evaluations_.near += table.points + panel.table->n_nodes;
    }
    u.row(i) *= factor;
  }
}

void CrossLayer::apply(const Net& f, const Net& at, std::span<const int> targets, Net& u, const Near* kept) {
  if (kernel_ == Kernel::double_layer) return apply(f, Net::Zero(at.rows(), 3), at, targets, u, kept);
  {
    const auto clock = phases_.time("setup");
    values(f, strength_);
    for (auto& component : strength_)
      for (int k = 0; k < n_nodes(); ++k) component[k] *= weight_[k];
  }
  const auto& node = surface_.node;
  const PointForces all{n_nodes(),           node[0].data(),      node[1].data(),     node[2].data(),
                        strength_[0].data(), strength_[1].data(), strength_[2].data()};
  const auto own = [&](int e, const PointTable& table, int, const Vec3& y, Vec3& sum) {
    const std::size_t bezier = surface_.panels[e].first_bezier;
    single_sum(table, &surface_.bezier[bezier], &bezier_f_[bezier], area_weights_of(e, table), y.data(), sum.data());
  };
  integrate(all, nullptr, own, at, targets, u, kept);
}

void CrossLayer::apply(const Net& v, const Net& v0, const Net& at, std::span<const int> targets, Net& u, const Near* kept) {
  assert(kernel_ == Kernel::double_layer);
  {
    const auto clock = phases_.time("setup");
    values(v, strength_);
  }
  const auto& node = surface_.node;
  const Stresslets all{n_nodes(),           node[0].data(),      node[1].data(),    node[2].data(),    strength_[0].data(),
                       strength_[1].data(), strength_[2].data(), normal_[0].data(), normal_[1].data(), normal_[2].data()};
  const auto own = [&](int e, const PointTable& table, int i, const Vec3& y, Vec3& sum) {
    const std::size_t bezier = surface_.panels[e].first_bezier;
    double_sum(table, &surface_.bezier[bezier], &bezier_f_[bezier], y.data(), v0.row(i).data(), sum.data());
  };
  integrate(all, &v0, own, at, targets, u, kept);
}

void CrossLayer::values(const Net& field, std::vector<double> (&value)[3]) {
  surface_.panels.bezier(field, bezier_f_);
  node_values(surface_.panels, bezier_f_, value);
}

Eigen::VectorXd CrossLayer::moments(const std::vector<double>& g) const {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(surface_.n_points);
  Eigen::VectorXd of_bezier;
  for (int e = 0; e < surface_.panels.size(); ++e) {
    const Panel& panel = surface_.panels[e];
    const NodeTable& t = *panel.table;
    of_bezier = Eigen::Map<const Rows<double>>(t.value.data(), t.n_bernstein, t.n_nodes) *
                Eigen::Map<const Eigen::VectorXd>(&g[panel.first_node], t.n_nodes);
    const double* extraction = surface_.panels.extraction(e);
    for (int a = 0; a < panel.functions; ++a, extraction += t.n_bernstein)
      sums[surface_.panels.points(e)[a]] += Eigen::Map<const Eigen::VectorXd>(extraction, t.n_bernstein).dot(of_bezier);
  }
  return sums;
}

/// Bernstein moments of panel e for y by a near rule.
void CrossLayer::near_moments(int e, const PointTable& table, const Vec3& y, double* moments) {
  const double* bezier = &surface_.bezier[surface_.panels[e].first_bezier];
  scratch_.resize(static_cast<std::size_t>(6) * table.packs());
  if (kernel_ == Kernel::double_layer) return double_moments(table, bezier, y.data(), scratch_.data(), moments);
  single_moments(table, bezier, area_weights_of(e, table), y.data(), scratch_.data(), moments);
}

CrossLayer::Near CrossLayer::near(const Net& at, std::span<const int> targets) {
  const auto clock = phases_.time("near");
  Near kept{{0}, {}, {}};
  for (const int i : targets) {
    const Vec3 y = at.row(i).transpose();
    for (const int e : surface_.near(y)) {
      const Panel& panel = surface_.panels[e];
      const NodeTable& t = *panel.table;
      const std::size_t first = kept.moments.size();
      kept.panels.push_back(e);
      kept.moments.resize(first + static_cast<std::size_t>(6) * t.n_bernstein);
      double* moments = &kept.moments[first];
      const PointTable& table = surface_.near_field.rule(e, y, {});
      near_moments(e, table, y, moments);
      evaluations_.near += table.points + t.n_nodes;
      for (int k = 0; k < t.n_nodes; ++k) {  // less those of the far rule
        const int node = panel.first_node + k;
        const Vec3 r = Vec3(surface_.node[0][node], surface_.node[1][node], surface_.node[2][node]) - y;
        const Mat3 g = kernel_ == Kernel::single_layer ? Mat3(weight_[node] * stokeslet(r))
                                                       : stresslet(r, Vec3(normal_[0][node], normal_[1][node], normal_[2][node]));
        const double entries[6] = {g(0, 0), g(0, 1), g(0, 2), g(1, 1), g(1, 2), g(2, 2)};
        for (int b = 0; b < t.n_bernstein; ++b)
          for (int c = 0; c < 6; ++c) moments[6 * b + c] -= entries[c] * t.value[static_cast<std::size_t>(t.n_nodes * b + k)];
      }
    }
    kept.first.push_back(kept.panels.size());
  }
  return kept;
}

void CrossLayer::add_kept(const Near& kept, const Net* v0, std::span<const int> targets, Net& u) const {
  const double* m = kept.moments.data();
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const int i = targets[k];
    const Vec3 base = v0 ? Vec3(v0->row(i)) : Vec3::Zero();
    double sum[3] = {0, 0, 0};
    for (std::size_t pair = kept.first[k]; pair < kept.first[k + 1]; ++pair) {
      const Panel& panel = surface_.panels[kept.panels[pair]];
      const int n_b = panel.table->n_bernstein;
      const double* f = &bezier_f_[panel.first_bezier];
      for (int b = 0; b < n_b; ++b, m += 6) {
        const double f1 = f[b] - base[0], f2 = f[n_b + b] - base[1], f3 = f[2 * n_b + b] - base[2];
        sum[0] += m[0] * f1 + m[1] * f2 + m[2] * f3;
        sum[1] += m[1] * f1 + m[3] * f2 + m[4] * f3;
        sum[2] += m[2] * f1 + m[4] * f2 + m[5] * f3;
      }
    }
    for (int c = 0; c < 3; ++c) u(i, c) += sum[c];
  }
}

/// The layer as dense_rows() wants it.
struct CrossLayer::Moments {
  CrossLayer& layer;

  const std::vector<int>& near(int, const Vec3& y) { return layer.surface_.near(y); }
  std::span<SelfPair> own(int) { return {}; }

  void own_moments(const Vec3& y, int e, const PointTable& table, SelfPair*, double* moments) { layer.near_moments(e, table, y, moments); }

  template <class Real>
  void far_nodes(PanelNodes<Real>& nodes, int first) const {
    if (layer.kernel_ == Kernel::single_layer)
      nodes.weight = layer.weight_.data() + first;
    else
      for (int c = 0; c < 3; ++c) nodes.normal[c] = layer.normal_[c].data() + first;
  }

  template <class Real>
  void finish(int, const Vec3&, Real*) const {}
};

template <class Real>
void CrossLayer::assemble_rows(const Net& at, std::span<const int> targets, Rows<Real>& a) {
  const auto clock = phases_.time("assembly");
  Moments moments{*this};
  dense_rows(surface_, targets, rows_of(at, targets), moments, evaluations_, a);
}

void CrossLayer::assemble(const Net& at, std::span<const int> targets, Rows<float>& a) { assemble_rows(at, targets, a); }
void CrossLayer::assemble(const Net& at, std::span<const int> targets, Rows<double>& a) { assemble_rows(at, targets, a); }

}  // namespace tanktread::stokes
