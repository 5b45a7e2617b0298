#include "stokes/double_layer.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "stokes/pair_kernel.hpp"

namespace tanktread::stokes {

namespace {

/// The rules of the target's own surface are chosen for int G f dG; this kernel, steeper by one order, errs up to five times as much
/// (tests/verify/layers.cpp).
quadrature::Options sharper(quadrature::Options options) {
  options.tolerance /= 8;
  return options;
}

}  // namespace

DoubleLayer::DoubleLayer(const spline::Space& space, const quadrature::Options& options, std::vector<double> factor)
    : surface_(space, sharper(options), Steep::across_gaps), factor_(std::move(factor)) {
  if (sums_by_tree(space, options)) tree_.emplace(options.tolerance / 2);  // measured: the largest error is a quarter of the tolerance
}

void DoubleLayer::share(int part, int parts, std::vector<int> everybody) {
  if (!tree_ || parts == 1) return;
  everybody_ = std::move(everybody);
  tree_->share(part, parts);
}

void DoubleLayer::place(const Net& x, std::span<const int> targets) {
  surface_.place(x);
  node_normals(surface_.panels, surface_.bezier, normal_);
  for (int e = 0; e < surface_.panels.size() && !factor_.empty(); ++e)
    for (auto& component : normal_)
      for (int k = 0; k < surface_.panels[e].table->n_nodes; ++k) component[surface_.panels[e].first_node + k] *= factor_[e];
  surface_.collocation_points(targets, at_);
  if (tree_) x_ = x;
}

void DoubleLayer::apply(const Net& x, const Net& v, std::span<const int> targets, Net& hv) {
  place(x, targets);
  surface_.panels.bezier(v, bezier_v_);
  node_values(surface_.panels, bezier_v_, velocity_);
  const std::span<const int> rows = shared() ? everybody_ : targets;
  tree_ ? add_by_tree(rows, hv) : add_far(rows, hv);
  add_near(targets, hv);
  for (const int i : rows) hv.row(i) /= 8 * std::numbers::pi;
}

/// v(x_i), which is subtracted from the integrand.
std::vector<Vec3> DoubleLayer::values(std::span<const int> targets) const {
  std::vector<Vec3> v0;
  for (const int i : targets) v0.push_back(surface_.self_field.value(i, surface_.panels, bezier_v_));
  return v0;
}

Stresslets DoubleLayer::nodes() const {
  const auto& node = surface_.node;
  return {surface_.panels.n_nodes(), node[0].data(),      node[1].data(),    node[2].data(),    velocity_[0].data(),
          velocity_[1].data(),       velocity_[2].data(), normal_[0].data(), normal_[1].data(), normal_[2].data()};
}

void DoubleLayer::add_far(std::span<const int> targets, Net& hv) {
  const Stresslets all = nodes();
  Net sums(targets.size(), 3);
  far_sums(all, at_, values(targets), sums.data());
  for (std::size_t k = 0; k < targets.size(); ++k) hv.row(targets[k]) = sums.row(static_cast<Eigen::Index>(k));
  evaluations_.far += static_cast<long long>(targets.size()) * all.n;
}

/// The tree and sum_q T_ijk n_k of this shape; Krylov solvers ask for one shape many times.
void DoubleLayer::place_tree(std::span<const int> targets) {
  if (tree_x_.rows() == x_.rows() && tree_x_ == x_ && std::ranges::equal(targets, tree_targets_)) return;
  surface_.place(*tree_);
  tree_->want(targets);
  stress_.resize(static_cast<std::size_t>(6) * surface_.n_points);
  tree_->sum<NormalStressKernel>({normal_[0].data(), normal_[1].data(), normal_[2].data()}, stress_.data());
  evaluations_.far += tree_->interactions();
  tree_x_ = x_;
  tree_targets_.assign(targets.begin(), targets.end());
}

/// sum_q (v - m)_j T_ijk n_k - (v0 - m)_j sum_q T_ijk n_k with the mean velocity m, so that a translation gives 0 exactly.
void DoubleLayer::add_by_tree(std::span<const int> targets, Net& hv) {
  place_tree(targets);
  const std::vector<Vec3> v0 = values(targets);
  const int n_nodes = surface_.panels.n_nodes();
  Vec3 mean;
  for (int c = 0; c < 3; ++c) mean[c] = Eigen::Map<const Eigen::VectorXd>(velocity_[c].data(), n_nodes).mean();
  constexpr int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (int c = 0; c < 6; ++c) {
    const auto [i, j] = at[c];
    moment_[c].resize(n_nodes);
    for (int k = 0; k < n_nodes; ++k)
      moment_[c][k] = ((velocity_[i][k] - mean[i]) * normal_[j][k] + (velocity_[j][k] - mean[j]) * normal_[i][k]) / 2;
  }
  tree_->sum<StressletKernel>(
      {moment_[0].data(), moment_[1].data(), moment_[2].data(), moment_[3].data(), moment_[4].data(), moment_[5].data()}, hv.data());
  evaluations_.far += tree_->interactions();
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const double* s = &stress_[static_cast<std::size_t>(6) * targets[k]];
    Mat3 stress;
    stress << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
    hv.row(targets[k]) -= (stress * (v0[k] - mean)).transpose();
  }
}

/// What the rules of close panels, and of those that a target of place() lies on, give beyond the far sum.
void DoubleLayer::add_near(std::span<const int> targets, Net& hv) {
  const Stresslets all = nodes();
  const std::vector<Vec3> v0 = values(targets);
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const auto replace = [&](int e, const PointTable& table, long long& count) {
      const Panel& panel = surface_.panels[e];
      Vec3 own, far;
      double_sum(table, &surface_.bezier[panel.first_bezier], &bezier_v_[panel.first_bezier], at_[k].data(), v0[k].data(), own.data());
      node_sum(all.part(panel.first_node, panel.table->n_nodes), at_[k].data(), v0[k].data(), far.data());
      hv.row(targets[k]) += (factor(e) * own - far).transpose();
      count += table.points + panel.table->n_nodes;
    };
    const std::span<SelfPair> own_panels = surface_.own(targets[k]);
    for (const int e : surface_.near(targets[k], at_[k])) replace(e, surface_.near_field.rule(e, at_[k], own_panels), evaluations_.near);
    for (SelfPair& pair : own_panels)
      replace(pair.panel, surface_.self_field.rule(pair, surface_.panels, surface_.bezier), evaluations_.self);
  }
}

/// The double layer as dense_rows() wants it.
struct DoubleLayer::Moments {
  DoubleLayer& layer;
  std::vector<Pack> scratch;

  const std::vector<int>& near(int i, const Vec3& x0) { return layer.surface_.near(i, x0); }
  std::span<SelfPair> own(int i) { return layer.surface_.own(i); }

  void own_moments(const Vec3& x0, int e, const PointTable& table, SelfPair*, double* moments) {
    scratch.resize(static_cast<std::size_t>(6) * table.packs());
    double_moments(table, &layer.surface_.bezier[layer.surface_.panels[e].first_bezier], x0.data(), scratch.data(), moments);
    for (int k = 0; k < 6 * layer.surface_.panels[e].table->n_bernstein; ++k) moments[k] *= layer.factor(e);
  }

  template <class Real>
  void far_nodes(PanelNodes<Real>& nodes, int first) const {
    for (int c = 0; c < 3; ++c) nodes.normal[c] = layer.normal_[c].data() + first;
  }

  /// - N_B(x_i) sum_C A_iC: what is subtracted from the integrand, by the same rules.
  template <class Real>
  void finish(int target, const Vec3&, Real* sums) const {
    double total[6] = {};
    for (int p = 0; p < layer.surface_.n_points; ++p)
      for (int c = 0; c < 6; ++c) total[c] += sums[assembly_block * (6 * static_cast<std::ptrdiff_t>(p) + c)];
    const auto [panel, basis] = layer.surface_.self_field.basis(target, layer.surface_.panels);
    for (int b = 0; b < basis.size(); ++b)
      for (int c = 0; c < 6; ++c)
        sums[assembly_block * (6 * static_cast<std::ptrdiff_t>(layer.surface_.panels.points(panel)[b]) + c)] -=
            static_cast<Real>(basis[b] * total[c]);
  }

  template <class Real>
  void assemble(const Net& x, std::span<const int> targets, Rows<Real>& a) {
    layer.place(x, targets);
    dense_rows(layer.surface_, targets, layer.at_, *this, layer.evaluations_, a);
  }
};

void DoubleLayer::assemble(const Net& x, std::span<const int> targets, Rows<float>& a) { Moments{*this, {}}.assemble(x, targets, a); }

void DoubleLayer::assemble(const Net& x, std::span<const int> targets, Rows<double>& a) { Moments{*this, {}}.assemble(x, targets, a); }

}  // namespace tanktread::stokes
