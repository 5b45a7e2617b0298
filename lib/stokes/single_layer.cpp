#include "stokes/single_layer.hpp"

#include <algorithm>
#include <cassert>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "stokes/identity_kernel.hpp"
#include "stokes/pair_kernel.hpp"

namespace tanktread::stokes {
namespace {

constexpr double factor = 1 / (8 * std::numbers::pi);

}  // namespace

SingleLayer::SingleLayer(const spline::Space& space, const quadrature::Options& options) : surface_(space, options) {
  if (sums_by_tree(space, options)) tree_.emplace(options.tolerance);
  points_ = surface::Symmetry(space.n_points).fundamental();
}

void SingleLayer::set_symmetry(const surface::Symmetry& symmetry) {
  surface_.set_symmetry(symmetry);
  points_ = symmetry.fundamental();
}

void SingleLayer::set_reference(const Net& unstressed) {
  surface_.panels.bezier(unstressed, bezier_unstressed_);
  node_weights(surface_.panels, bezier_unstressed_, weight_unstressed_);
  surface_.self_field.forget_weights();
}

void SingleLayer::place(const Net& x, Measure measure, std::span<const int> targets, bool lazily) {
  assert((measure == Measure::current || !weight_unstressed_.empty()) && "set_reference() comes first");
  measure_ = measure;
  lazily_ = lazily;
  lazily ? surface_.place_lazily(x) : surface_.place(x);
  if (measure == Measure::current)
    lazily ? weight_present_.resize(n_nodes()) : node_weights(surface_.panels, surface_.bezier, weight_present_);
  if (surface_.options.rule == "desingularised") node_normals(surface_.panels, surface_.bezier, normal_);
  surface_.collocation_points(targets, at_);
}

void SingleLayer::share(int part, int parts, std::vector<int> everybody) {
  if (!tree_ || parts == 1) return;
  everybody_ = std::move(everybody);
  tree_->share(part, parts);
}

std::span<const int> SingleLayer::rows(std::span<const int> targets) const { return shared() ? everybody_ : targets; }

PointForces SingleLayer::forces() const {
  const auto& node = surface_.node;
  return {n_nodes(), node[0].data(), node[1].data(), node[2].data(), force_[0].data(), force_[1].data(), force_[2].data()};
}

/// Bezier points, values and weights of the density on panel e, where it is asked for the first time.
void SingleLayer::load(int e) {
  if (loaded_[e]) return;
  loaded_[e] = 1;
  surface_.locate(e);
  surface_.panels.bezier(e, *density_, bezier_f_);
  node_values(surface_.panels, e, bezier_f_, force_);
  if (measure_ == Measure::current && lazily_) node_weights(surface_.panels, e, surface_.bezier, weight_present_);
  const auto& weight = measure_ == Measure::current ? weight_present_ : weight_unstressed_;
  const int first = surface_.panels[e].first_node, last = first + surface_.panels[e].table->n_nodes;
  for (auto& component : force_)
    for (int k = first; k < last; ++k) component[k] *= weight[k];
}

void SingleLayer::add_by_tree(std::span<const int> targets, Net& u) {
  const auto& [fundamental, weight] = surface_.fundamental();
  const std::vector<surface::Reflection>& images = surface_.reflections();
  for (const int e : fundamental) surface_.locate(e);
  surface_.place(*tree_, fundamental, points_);
  const std::span<const int> rows = this->rows(targets);
  std::vector<int> wanted, number;
  for (const int i : rows) number.push_back(static_cast<int>(std::ranges::lower_bound(points_, i) - points_.begin()));
  for (std::size_t g = 0; g <= images.size(); ++g)
    for (const int k : number) wanted.push_back(k + static_cast<int>(g * points_.size()));
  assert(std::ranges::all_of(number, [&, k = 0](int at) mutable { return points_[at] == rows[k++]; }) && "rows are of fundamental points");
  tree_->want(wanted);
  std::vector<double> carried[3];
  for (std::size_t k = 0; k < fundamental.size(); ++k) {
    const Panel& panel = surface_.panels[fundamental[k]];
    const int first = panel.first_node, n = panel.table->n_nodes;
    const bool asked = tree_->asks(static_cast<int>(carried[0].size()));  // panels are not split
    if (asked) load(fundamental[k]);
    for (int c = 0; c < 3; ++c)
      for (int q = 0; q < n; ++q) carried[c].push_back(asked ? weight[k] * force_[c][first + q] : 0);
  }
  Net there(points_.size() * (images.size() + 1), 3);
  tree_->sum<StokesletKernel>({carried[0].data(), carried[1].data(), carried[2].data()}, there.data());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    auto row = u.row(rows[k]);
    row = there.row(number[k]);
    for (std::size_t g = 0; g < images.size(); ++g)
      row += there.row(number[k] + static_cast<Eigen::Index>((g + 1) * points_.size())).cwiseProduct(images[g].signs.transpose());
  }
  evaluations_.far += tree_->interactions();
}

void SingleLayer::add_far(std::span<const int> targets, Net& u) {
  const auto clock = phases_.time("far");
  if (tree_) return add_by_tree(targets, u);
  const PointForces all = forces();
  Net sums(targets.size(), 3);
  far_sums(all, at_, sums.data());
  for (std::size_t k = 0; k < targets.size(); ++k) u.row(targets[k]) = sums.row(static_cast<Eigen::Index>(k));
  evaluations_.far += static_cast<long long>(targets.size()) * all.n;
}

template <class Sum>
void SingleLayer::add_near(std::span<const int> targets, const Sum& own_sum, Net& u) {
  const auto clock = phases_.time("near");
  const PointForces all = forces();
  Vec3 far;
  for (std::size_t k = 0; k < targets.size(); ++k)
    for (const int e : surface_.near(targets[k], at_[k])) {
      const Panel& panel = surface_.panels[e];
      const PointTable& table = surface_.near_field.rule(e, at_[k], surface_.self_field[targets[k]]);
      load(e);
      node_sum(all.part(panel.first_node, panel.table->n_nodes), at_[k].data(), far.data());
      u.row(targets[k]) += (own_sum(e, table, nullptr, at_[k]) - far).transpose();
      evaluations_.near += table.points + panel.table->n_nodes;
    }
}

template <class Sum>
void SingleLayer::add_self(std::span<const int> targets, const Sum& own_sum, Net& u) {
  const auto clock = phases_.time("self");
  const PointForces all = forces();
  Vec3 far;
  for (std::size_t k = 0; k < targets.size(); ++k)
    for (SelfPair& pair : surface_.own(targets[k])) {
      const Panel& panel = surface_.panels[pair.panel];
      const PointTable& table = surface_.self_field.rule(pair, surface_.panels, surface_.bezier);
      load(pair.panel);
      node_sum(all.part(panel.first_node, panel.table->n_nodes), at_[k].data(), far.data());
      u.row(targets[k]) += (own_sum(pair.panel, table, &pair, at_[k]) - far).transpose();
      evaluations_.self += table.points + panel.table->n_nodes;
    }
}

/// Weights of a rule on panel e, area included. On a panel that the target lies on those of the unstressed surface are kept.
const Pack* SingleLayer::area_weights_of(int e, const PointTable& table, SelfPair* pair) {
  const auto& surface = measure_ == Measure::current ? surface_.bezier : bezier_unstressed_;
  const bool kept = pair && measure_ == Measure::reference;
  std::vector<Pack>& weights = kept ? pair->weights : point_weights_;
  if (kept && !weights.empty()) return weights.data();
  weights.resize(table.packs());
  area_weights(table, &surface[surface_.panels[e].first_bezier], weights.data());
  return weights.data();
}

void SingleLayer::apply(const Net& x, const Net& f, Measure measure, std::span<const int> targets, Net& u) {
  {
    const auto clock = phases_.time("setup");
    const bool lazily = tree_ && surface_.options.rule != "desingularised";
    place(x, measure, targets, lazily);
    density_ = &f;
    loaded_.assign(surface_.panels.size(), 0);
    bezier_f_.resize(surface_.panels.bezier_size());
    for (auto& component : force_) component.resize(n_nodes());
    if (!lazily)
      for (int e = 0; e < surface_.panels.size(); ++e) load(e);
  }
  const auto own_sum = [&](int e, const PointTable& table, SelfPair* pair, const Vec3& x0) {
    const std::size_t bezier = surface_.panels[e].first_bezier;
    const Pack* weights = area_weights_of(e, table, pair);
    Vec3 sum;
    single_sum(table, &surface_.bezier[bezier], &bezier_f_[bezier], weights, x0.data(), sum.data());
    return sum;
  };
  add_far(targets, u);
  add_near(targets, own_sum, u);
  if (surface_.options.rule == "desingularised")
    subtract_identities(targets, u);
  else
    add_self(targets, own_sum, u);
  for (const int i : rows(targets)) u.row(i) *= factor;
}

void SingleLayer::apply_to_normal(const Net& x, std::span<const int> targets, Net& u) {
  {
    const auto clock = phases_.time("setup");
    place(x, Measure::current, targets);
    node_normals(surface_.panels, surface_.bezier, force_);
    loaded_.assign(surface_.panels.size(), 1);
  }
  const auto own_sum = [&](int e, const PointTable& table, SelfPair*, const Vec3& x0) {
    Vec3 sum;
    pressure_sum(table, &surface_.bezier[surface_.panels[e].first_bezier], x0.data(), sum.data());
    return sum;
  };
  add_far(targets, u);
  add_near(targets, own_sum, u);
  add_self(targets, own_sum, u);
  for (const int i : rows(targets)) u.row(i) *= factor;
}

/// M of the rule `desingularised`: u_i = sum_q G f w - M f(x_i), f = f_n n0 + f_t,
///   M f = sum_q w [G (f_n n + f_t (n0.n) + n0 (f_t.n)) - (n0.r) T f_t n],
/// which is 0 for an exact rule. f is measured as the density is.
Mat3 SingleLayer::identities(int target, const Vec3& at) const {
  const auto normal_of = [&](const std::vector<double>& bezier) -> Vec3 {
    const auto [a1, a2] = surface_.self_field.tangents(target, surface_.panels, bezier);
    return a1.cross(a2);
  };
  const Vec3 a = normal_of(surface_.bezier), n0 = a.normalized();
  const auto& node = surface_.node;
  const IdentitySums s = identity_sums(n_nodes(), node[0].data(), node[1].data(), node[2].data(), normal_[0].data(), normal_[1].data(),
                                       normal_[2].data(), at.data(), n0.data());
  const Mat3 tangential = Mat3::Identity() - n0 * n0.transpose();
  const Mat3 m = Vec3(s.pressure) * n0.transpose() + Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(s.shear) * tangential;
  return measure_ == Measure::current ? m : Mat3(m * (normal_of(bezier_unstressed_).norm() / a.norm()));
}

void SingleLayer::subtract_identities(std::span<const int> targets, Net& u) {
  const auto clock = phases_.time("self");
  for (std::size_t k = 0; k < targets.size(); ++k)
    u.row(targets[k]) -= (identities(targets[k], at_[k]) * surface_.self_field.value(targets[k], surface_.panels, bezier_f_)).transpose();
  evaluations_.self += static_cast<long long>(targets.size()) * n_nodes();
}

/// The single layer as dense_rows() wants it.
struct SingleLayer::Moments {
  SingleLayer& layer;
  std::vector<Pack> scratch;

  const std::vector<int>& near(int i, const Vec3& x0) { return layer.surface_.near(i, x0); }
  std::span<SelfPair> own(int i) { return layer.surface_.own(i); }

  void own_moments(const Vec3& x0, int e, const PointTable& table, SelfPair* pair, double* moments) {
    scratch.resize(static_cast<std::size_t>(6) * table.packs());
    const Pack* weights = layer.area_weights_of(e, table, pair);
    single_moments(table, &layer.surface_.bezier[layer.surface_.panels[e].first_bezier], weights, x0.data(), scratch.data(), moments);
  }

  template <class Real>
  void far_nodes(PanelNodes<Real>& nodes, int first) const {
    nodes.weight = (layer.measure_ == Measure::current ? layer.weight_present_ : layer.weight_unstressed_).data() + first;
  }

  template <class Real>
  void finish(int, const Vec3&, Real*) const {}

  template <class Real>
  void subtract_identities(std::span<const int> targets, Rows<Real>& a) const {
    for (std::size_t k = 0; k < targets.size(); ++k) {
      const Mat3 m = factor * layer.identities(targets[k], layer.at_[k]);
      const auto [panel, basis] = layer.surface_.self_field.basis(targets[k], layer.surface_.panels);
      for (int b = 0; b < basis.size(); ++b)
        a.template block<3, 3>(3 * static_cast<Eigen::Index>(k), 3 * layer.surface_.panels.points(panel)[b]) -=
            (basis[b] * m).template cast<Real>();
    }
  }

  void subtract_identities(std::span<const int> targets, const NearPoints& near, std::vector<double>& entries) const {
    constexpr int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
    for (std::size_t k = 0; k < targets.size(); ++k) {
      const Mat3 m = factor * layer.identities(targets[k], layer.at_[k]);
      const auto [panel, basis] = layer.surface_.self_field.basis(targets[k], layer.surface_.panels);
      const std::span<const int> points(layer.surface_.panels.points(panel), static_cast<std::size_t>(basis.size()));
      for (std::size_t j = near.first[k]; j < near.first[k + 1]; ++j) {
        const auto b = std::ranges::find(points, near.point[j]) - points.begin();
        if (b == basis.size()) continue;
        for (int c = 0; c < 6; ++c) entries[6 * j + static_cast<std::size_t>(c)] -= basis[b] * m(row[c], column[c]);
      }
    }
  }

  template <class Real>
  void assemble(const Net& x, Measure measure, std::span<const int> targets, Rows<Real>& a) {
    const auto clock = layer.phases_.time("assembly");
    layer.place(x, measure, targets);
    dense_rows(layer.surface_, targets, layer.at_, *this, layer.evaluations_, a);
    if (layer.surface_.options.rule == "desingularised") subtract_identities(targets, a);
  }

  void assemble(const Net& x, Measure measure, std::span<const int> targets, const NearPoints& near, std::vector<double>& entries) {
    const auto clock = layer.phases_.time("assembly");
    layer.place(x, measure, targets);
    near_rows(layer.surface_, targets, layer.at_, near, *this, layer.evaluations_, entries);
    if (layer.surface_.options.rule == "desingularised") subtract_identities(targets, near, entries);
  }
};

void SingleLayer::assemble(const Net& x, Measure measure, std::span<const int> targets, Rows<float>& a) {
  Moments{*this, {}}.assemble(x, measure, targets, a);
}

void SingleLayer::assemble(const Net& x, Measure measure, std::span<const int> targets, Rows<double>& a) {
  Moments{*this, {}}.assemble(x, measure, targets, a);
}

void SingleLayer::assemble(const Net& x, Measure measure, std::span<const int> targets, const NearPoints& near,
                           std::vector<double>& entries) {
  Moments{*this, {}}.assemble(x, measure, targets, near, entries);
}

}  // namespace tanktread::stokes
