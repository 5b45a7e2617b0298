#include "stokes/layer.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <utility>

#include "base/indices.hpp"
#include "stokes/kernels/pair_kernel.hpp"

namespace tanktread::stokes {
namespace {

/// Returns the options, with an eighth of the tolerance for the double layer. Quadrature rules are chosen for the kernel of the single layer. The
/// kernel of the double layer is singular by one order more, so that its error with the same rule is up to five times as large
/// (tests/verify/layers.cpp). The precision of the far sum is chosen from the unchanged tolerance of the deck.
quadrature::Options for_kernel(quadrature::Options options, Layer::Kernel kernel) {
  options.far_precision = options.far_in_single() ? "single" : "double";
  if (kernel == Layer::Kernel::double_layer) options.tolerance /= 8;
  return options;
}

}  // namespace

Layer::Layer(Kernel kernel, const spline::Space& space, const Sites& sites, const quadrature::Options& options, std::vector<double> factor)
    : kernel_(kernel), surface_(space, sites, for_kernel(options, kernel), kernel == Kernel::double_layer), factor_(std::move(factor)) {
  if (sums_by_tree(space, options)) tree_.emplace(tree_tolerance(), precision());
  fundamental_sites_ = indices(sites.size());
}

void Layer::set_symmetry(const surface::Symmetry& symmetry) {
  surface_.set_symmetry(symmetry);
  if (surface_.n_sites == surface_.n_points) fundamental_sites_ = symmetry.fundamental();
  tree_rows_.clear();
}

void Layer::set_reference(const Net& unstressed, std::vector<bool> present) {
  surface_.panels.bezier(unstressed, reference_.bezier);
  node_weights(surface_.panels, reference_.bezier, reference_.weight);
  reference_.present = std::move(present);
  surface_.self_field.forget_weights(), measure_.reset();
}

void Layer::share(int part, int parts, std::vector<int> everybody) {
  if (!tree_ || parts == 1) return;
  everybody_ = std::move(everybody);
  tree_->share(part, parts);
  if (images_) images_->share(part, parts);
  tree_rows_.clear();
}

void Layer::place(const Net& x, Measure measure) {
  assert((measure == Measure::current || !reference_.weight.empty()) && "set_reference() comes first");
  const auto clock = phases_.time("setup");
  if (!surface_.place(x) && measure == measure_) return;
  measure_ = measure;
  tree_rows_.clear();
  if (!single() || surface_.options.rule == "desingularised") node_normals(surface_.panels, surface_.bezier, normal_);
  if (single()) weight_ = reference_.weight, weight_.resize(static_cast<std::size_t>(n_nodes()));
  for (int e = 0; single() && e < surface_.panels.size(); ++e)
    if (!on_reference(e)) node_weights(surface_.panels, e, surface_.bezier, weight_);
  for (std::vector<double>& values : single() ? std::span(&weight_, 1) : std::span(normal_))
    for (int e = 0; !factor_.empty() && e < surface_.panels.size(); ++e)
      for (int k = 0; k < surface_.panels[e].table->n_nodes; ++k) values[surface_.panels[e].first_node + k] *= factor_[e];
  if (lattice_.cell) place_in_cell();
  if (images_) images_->place(surface_.node);
}

void Layer::values(const Net& field, std::vector<double> (&value)[3]) {
  surface_.panels.bezier(field, bezier_f_);
  node_values(surface_.panels, bezier_f_, value);
}

/// Evaluates the density f at the far nodes. In a single layer, the values are multiplied by the quadrature weights.
void Layer::set_density(const Net& f) {
  const auto clock = phases_.time("setup");
  values(f, density_);
  if (!single()) return;
  for (auto& component : density_)
    for (int k = 0; k < n_nodes(); ++k) component[k] *= weight_[k];
}

void Layer::apply(const Net& f, std::span<const int> sites, Net& u) {
  assert(surface_.n_sites > 0 && "a layer is for sites or for points off its surfaces");
  set_density(f);
  const std::span<const int> far_rows = shared() ? everybody_ : sites, in_tree = tree_ ? std::span<const int>(fundamental_sites_) : sites;
  Net at(u.rows(), 3), f0 = Net::Zero(u.rows(), 3);
  for (const int i : in_tree) at.row(i) = surface_.site(i).transpose();
  for (const int i : far_rows)
    if (!single()) f0.row(i) = surface_.value(i, bezier_f_).transpose();
  integrate({sites, far_rows, at, f0, in_tree, true}, u);
}

void Layer::apply(const Net& f, const Net& at, std::span<const int> targets, Net& u, const Near* kept) {
  apply(f, Net::Zero(at.rows(), 3), at, targets, u, kept);
}

void Layer::apply(const Net& f, const Net& f0, const Net& at, std::span<const int> targets, Net& u, const Near* kept) {
  assert(surface_.n_sites == 0 && !shared() && "a layer is for sites or for points off its surfaces");
  assert(!kept || kept->first.size() == targets.size() + 1);
  set_density(f);
  const std::vector<int> all = indices(at.rows());
  integrate({targets, targets, at, f0, all, false, kept}, u);
}

/// Evaluates the potential at the targets: the far-field sum over all panels, corrected by near-singular and singular quadrature on panels that are
/// close to a target or contain it.
void Layer::integrate(const Targets& targets, Net& u) {
  add_far(targets, u);
  if (lattice_.cell) subtract_itself(targets, u);
  if (lattice_.cell) add_rest(targets, u);
  if (images_) add_images(targets, u);
  {
    const auto clock = phases_.time("near");
    if (targets.kept) add_kept(targets, u);
    for (const int i : targets.rows) {
      if (targets.kept) break;
      const Vec3 f0 = targets.f0.row(i);
      for (const Vec3& image : lattice_.near) {
        if (i >= lattice_.images_only && image.isZero(0)) continue;
        const Vec3 at = targets.at.row(i).transpose() - image;
        const std::span<SelfPair> own = targets.sites && image.isZero(0) ? surface_.own(i) : std::span<SelfPair>();
        for (const int e : surface_.near(at, own))
          u.row(i) += beyond_far_sum(e, surface_.near_field.rule(e, at, own), nullptr, at, f0, evaluations_.near).transpose();
      }
    }
  }
  if (targets.sites) {
    const auto clock = phases_.time("self");
    for (const int i : targets.rows)
      for (SelfPair& pair : surface_.own(i)) {
        const PointTable& table = surface_.self_field.rule(pair, surface_.panels, surface_.bezier);
        u.row(i) += beyond_far_sum(pair.panel, table, &pair, targets.at.row(i), targets.f0.row(i), evaluations_.self).transpose();
      }
    if (single() && surface_.options.rule == "desingularised") subtract_identities(targets.rows, u);
  }
  for (const int i : targets.far_rows) u.row(i) *= over_8_pi;
}

/// Returns the integral over panel e by the near-singular or singular rule `table` minus the contribution of the panel to the far sum.
Vec3 Layer::beyond_far_sum(int e, const PointTable& table, SelfPair* pair, const Vec3& at, const Vec3& f0, long long& count) {
  const Panel& panel = surface_.panels[e];
  const double *x = &surface_.bezier[panel.first_bezier], *f = &bezier_f_[panel.first_bezier];
  Vec3 better, far;
  if (single()) {
    single_sum(table, x, f, area_weights_of(e, table, pair), at.data(), better.data());
    node_sum(charges(surface_.node, density_).part(panel.first_node, panel.table->n_nodes), at.data(), far.data());
  } else {
    double_sum(table, x, f, at.data(), f0.data(), better.data());
    node_sum(stresslets(surface_.node, density_, normal_).part(panel.first_node, panel.table->n_nodes), at.data(), f0.data(), far.data());
  }
  count += table.points + panel.table->n_nodes;
  return factor(e) * better - far;
}

void Layer::add_far(const Targets& targets, Net& u) {
  const auto clock = phases_.time("far");
  if (tree_) return add_by_clusters(targets, u);
  const std::vector<Vec3> places = far_targets(targets, targets.far_rows), f0 = rows_of(targets.f0, targets.far_rows);
  const std::vector<Vec3> images = lattice_.cell ? lattice_.sum->images() : std::vector<Vec3>{Vec3::Zero()};
  Net sums(targets.far_rows.size(), 3), all = Net::Zero(sums.rows(), 3);
  for (const Vec3& image : images) {
    std::vector<Vec3> at = places;
    for (Vec3& x : at) x -= image;
    single() ? far_sums(charges(far_places(), density_), at, sums.data(), precision())
             : far_sums(stresslets(far_places(), density_, normal_), at, f0, sums.data(), precision());
    all += sums;
  }
  for (std::size_t k = 0; k < places.size(); ++k) u.row(targets.far_rows[k]) = all.row(static_cast<Eigen::Index>(k));
  evaluations_.far += static_cast<long long>(images.size() * places.size()) * n_nodes();
}

/// Sets the nodes and targets of the tree of clusters, and for a double layer computes the sum of T_ijk n_k over all far nodes at the targets. The
/// tree and these sums are reused if the shape and the targets have not changed, because a Krylov solver applies the layer of one shape many times.
/// Row k + g n of the tree's sums belongs to symmetry image g of target k (g = 0: the target itself), where n is the number of targets.
void Layer::place_tree(const Targets& targets) {
  std::vector<Vec3> at = far_targets(targets, targets.in_tree);
  if (std::ranges::equal(targets.far_rows, tree_rows_) && at == tree_at_) return;
  tree_at_ = std::move(at);
  tree_rows_.assign(targets.far_rows.begin(), targets.far_rows.end());
  lattice_.cell ? tree_->place(lattice_.node, indices(n_nodes() + 1), tree_at_) : surface_.place(*tree_, tree_at_);
  std::vector<int> wanted;
  const std::size_t reflections = lattice_.cell ? 0 : surface_.reflections().size();
  for (std::size_t g = 0; g <= reflections; ++g)
    for (const int i : tree_rows_) {
      const auto k = std::ranges::lower_bound(targets.in_tree, i) - targets.in_tree.begin();
      assert(targets.in_tree[k] == i && "rows are of fundamental sites");
      wanted.push_back(static_cast<int>(k + static_cast<std::ptrdiff_t>(g * tree_at_.size())));
    }
  tree_->want(wanted);
  if (single()) return;
  assert(reflections == 0);
  stress_.resize(6 * tree_at_.size());
  tree_->sum<NormalStressKernel>({normal_[0].data(), normal_[1].data(), normal_[2].data()}, stress_.data());
  evaluations_.far += tree_->interactions();
}

void Layer::add_by_clusters(const Targets& targets, Net& u) {
  place_tree(targets);
  single() ? add_forces_by_clusters(targets, u) : add_stresslets_by_clusters(targets, u);
  evaluations_.far += tree_->interactions();
}

/// Adds the far sums of the single layer by clusters. In a symmetric scene the sources are the nodes of the fundamental panels, and the sums at the
/// reflections of the targets are added (2.19). On a lattice the sources are the nodes of all panels, and targets have no reflections.
void Layer::add_forces_by_clusters(const Targets& targets, Net& u) {
  const auto& [fundamental, weight] = surface_.fundamental();
  const std::span<const surface::Reflection> images = lattice_.cell ? std::span<const surface::Reflection>() : surface_.reflections();
  std::vector<double> carried[3];
  for (int c = 0; c < 3 && lattice_.cell; ++c) carried[c] = density_[c];
  for (std::size_t k = 0; k < fundamental.size() && !lattice_.cell; ++k) {
    const Panel& panel = surface_.panels[fundamental[k]];
    for (int c = 0; c < 3; ++c)
      for (int q = 0; q < panel.table->n_nodes; ++q) carried[c].push_back(weight[k] * density_[c][panel.first_node + q]);
  }
  const std::size_t n = tree_at_.size();
  Net there(n * (images.size() + 1), 3);
  tree_->sum<StokesletKernel>({carried[0].data(), carried[1].data(), carried[2].data()}, there.data());
  for (const int i : targets.far_rows) {
    const auto k = std::ranges::lower_bound(targets.in_tree, i) - targets.in_tree.begin();
    u.row(i) = there.row(k);
    for (std::size_t g = 0; g < images.size(); ++g)
      u.row(i) += there.row(k + static_cast<Eigen::Index>((g + 1) * n)).cwiseProduct(images[g].signs.transpose());
  }
}

Vec3 Layer::mean_density() const {
  Vec3 mean;
  for (int c = 0; c < 3; ++c) mean[c] = std::accumulate(density_[c].begin(), density_[c].end(), 0.) / n_nodes();  // independent of memory alignment
  return mean;
}

/// Computes the stresslet moments moment_ = (f n + n f)/2 at the far nodes from the density f(node, component) and the weighted normals n = normal_.
template <class Values>
void Layer::take_moments_of(const Values& f) {
  for (int c = 0; c < 6; ++c) {
    const auto [i, j] = stresses[c];
    moment_[c].resize(n_nodes());
    for (int k = 0; k < n_nodes(); ++k) moment_[c][k] = (f(k, i) * normal_[j][k] + f(k, j) * normal_[i][k]) / 2;
  }
}

/// Computes the stresslet moments moment_ for the density minus its mean.
void Layer::take_moments(const Vec3& mean) {
  take_moments_of([&](int k, int i) { return density_[i][k] - mean[i]; });
}

/// Computes the stresslet moments moment_ for a constant unit density along one axis.
void Layer::take_constant_moments(int component) {
  take_moments_of([&](int, int i) { return i == component ? 1. : 0.; });
}

/// Computes the far sum of the double layer by clusters, sum_q (f - m)_j T_ijk n_k - (f0 - m)_j sum_q T_ijk n_k. The sums are over the far nodes q. f
/// is the density, m its mean, and f0 the constant that is subtracted from f for the target. The sum is exactly 0 for a uniform density.
void Layer::add_stresslets_by_clusters(const Targets& targets, Net& u) {
  const Vec3 mean = mean_density();
  take_moments(mean);
  std::array<const double*, 6> carried;
  for (std::size_t c = 0; c < 6; ++c) carried[c] = moment_[c].data();
  Net there(tree_at_.size(), 3);
  tree_->sum<StressletKernel>(carried, there.data());
  for (const int i : targets.far_rows) {
    const auto k = std::ranges::lower_bound(targets.in_tree, i) - targets.in_tree.begin();
    const double* s = &stress_[static_cast<std::size_t>(6 * k)];
    Mat3 stress;
    stress << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
    u.row(i) = there.row(k) - (stress * (targets.f0.row(i).transpose() - mean)).transpose();
  }
}

/// Returns the weights of a quadrature rule on panel e, multiplied by the area element. If the panel contains the target and the areas are unstressed
/// areas, the weights are cached.
const Pack* Layer::area_weights_of(int e, const PointTable& table, SelfPair* pair) {
  const bool unstressed = on_reference(e), kept = pair && unstressed;
  std::vector<Pack>& weights = kept ? pair->weights : point_weights_;
  if (kept && !weights.empty()) return weights.data();
  weights.resize(table.packs());
  area_weights(table, &(unstressed ? reference_.bezier : surface_.bezier)[surface_.panels[e].first_bezier], weights.data());
  return weights.data();
}

/// Computes the integrals of the kernel times each Bernstein polynomial (moments) over panel e by the rule `table`, including the factor of the panel
/// (1 - lambda in a double layer).
void Layer::panel_moments(int e, const PointTable& table, SelfPair* pair, const Vec3& at, double* moments) {
  const double* bezier = &surface_.bezier[surface_.panels[e].first_bezier];
  scratch_.resize(static_cast<std::size_t>(6) * table.packs());
  if (single())
    single_moments(table, bezier, area_weights_of(e, table, pair), at.data(), scratch_.data(), moments);
  else
    double_moments(table, bezier, at.data(), scratch_.data(), moments);
  if (factor_.empty()) return;
  for (int k = 0; k < 6 * surface_.panels[e].table->n_bernstein; ++k) moments[k] *= factor_[e];
}

Layer::Near Layer::near(const Net& at, std::span<const int> targets) {
  const auto clock = phases_.time("near");
  Near kept{{0}, {}, {}};
  for (const int i : targets) {
    for (const Vec3& image : lattice_.near) {
      if (i >= lattice_.images_only && image.isZero(0)) continue;
      const Vec3 y = at.row(i).transpose() - image;
      for (const int e : surface_.near(y, {})) {
        const std::size_t first = kept.moments.size();
        kept.panels.push_back(e);
        kept.moments.resize(first + static_cast<std::size_t>(6) * surface_.panels[e].table->n_bernstein);
        const PointTable& table = surface_.near_field.rule(e, y, {});
        moments_beyond_far_sum(e, table, nullptr, y, &kept.moments[first]);
        evaluations_.near += table.points + surface_.panels[e].table->n_nodes;
      }
    }
    kept.first.push_back(kept.panels.size());
  }
  return kept;
}

/// Computes the integrals of the kernel times each Bernstein polynomial over panel e by the rule `table`, minus the contribution of the far nodes of
/// the panel, which the far sum contains.
void Layer::moments_beyond_far_sum(int e, const PointTable& table, SelfPair* pair, const Vec3& at, double* moments) {
  const Panel& panel = surface_.panels[e];
  const NodeTable& t = *panel.table;
  panel_moments(e, table, pair, at, moments);
  for (int k = 0; k < t.n_nodes; ++k) {
    const int node = panel.first_node + k;
    const Vec3 r = Vec3(surface_.node[0][node], surface_.node[1][node], surface_.node[2][node]) - at;
    if (r.squaredNorm() <= coincident(at[0], at[1], at[2])) continue;
    const Mat3 g = single() ? Mat3(weight_[node] * stokeslet(r)) : stresslet(r, Vec3(normal_[0][node], normal_[1][node], normal_[2][node]));
    const double entries[6] = {g(0, 0), g(0, 1), g(0, 2), g(1, 1), g(1, 2), g(2, 2)};
    for (int b = 0; b < t.n_bernstein; ++b)
      for (int c = 0; c < 6; ++c) moments[6 * b + c] -= entries[c] * t.value[static_cast<std::size_t>(t.n_nodes * b + k)];
  }
}

void Layer::add_kept(const Targets& targets, Net& u) const {
  const Near& kept = *targets.kept;
  const double* m = kept.moments.data();
  for (std::size_t k = 0; k < targets.rows.size(); ++k) {
    const int i = targets.rows[k];
    double sum[3] = {0, 0, 0};
    for (std::size_t pair = kept.first[k]; pair < kept.first[k + 1]; ++pair) {
      const Panel& panel = surface_.panels[kept.panels[pair]];
      const int n_b = panel.table->n_bernstein;
      const double* f = &bezier_f_[panel.first_bezier];
      for (int b = 0; b < n_b; ++b, m += 6) {
        const double f1 = f[b] - targets.f0(i, 0), f2 = f[n_b + b] - targets.f0(i, 1), f3 = f[2 * n_b + b] - targets.f0(i, 2);
        sum[0] += m[0] * f1 + m[1] * f2 + m[2] * f3;
        sum[1] += m[1] * f1 + m[3] * f2 + m[4] * f3;
        sum[2] += m[2] * f1 + m[4] * f2 + m[5] * f3;
      }
    }
    for (int c = 0; c < 3; ++c) u(i, c) += sum[c];
  }
}

Eigen::VectorXd Layer::moments(const std::vector<double>& g) const {
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

}  // namespace tanktread::stokes
