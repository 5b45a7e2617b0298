#include "stokes/layer.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <stdexcept>
#include <typeinfo>
#include <utility>

#include "base/indices.hpp"

namespace tanktread::stokes {

Layer::Layer(Kernel kernel, const spline::Space& space, const Sites& sites, const quadrature::Options& options, std::vector<double> factor)
    : sources_(kernel, space, sites, options, std::move(factor)) {
  if (sums_by_tree(space, options)) make_tree();
  fundamental_sites_ = indices(sites.size());
}

void Layer::set_symmetry(const surface::Symmetry& symmetry) {
  sources_.surface.set_symmetry(symmetry);
  if (sources_.surface.n_sites == sources_.surface.n_points) fundamental_sites_ = symmetry.fundamental();
  tree_rows_.clear();
}

void Layer::set_reference(const Net& unstressed, std::vector<bool> per_current_area) {
  sources_.set_reference(unstressed, std::move(per_current_area));
}

void Layer::make_tree() {
  tree_.emplace(tree_tolerance());
  tree_->share(part_, parts_);
}

void Layer::use(std::unique_ptr<LayerMedium> medium) {
  medium_ = std::move(medium);
  sources_.surface.repeat();
  sources_.renew_shape();
}

void Layer::repeat(const PeriodicCell& cell, const Repetition& how) {
  const auto* lattice = dynamic_cast<const Lattice*>(medium_.get());
  if (lattice && lattice->is(cell, how)) return;
  if (!lattice && typeid(*medium_) != typeid(LayerMedium)) throw std::logic_error("a layer has one medium, or is on a lattice");
  if (!tree_ && sums_by_tree(lattice_images * n_nodes(), sources_.surface.options)) make_tree();
  use(std::make_unique<Lattice>(cell, how));
}

void Layer::set_medium(const Medium& medium) {
  if (shared()) throw std::logic_error("Layer::set_medium must be called before Layer::share, because the far sums of the medium are shared as well");
  use(medium.in_layer(sources_, by_clusters()));
}

void Layer::share(int part, int parts, std::vector<int> everybody) {
  part_ = part, parts_ = parts;
  everybody_ = std::move(everybody);
  if (!shared()) return;
  tree_->share(part, parts);
  medium_->share(part, parts);
  tree_rows_.clear();
}

void Layer::set_shape(const Net& x, Measure measure) {
  const auto clock = sources_.phases.time("setup");
  if (!sources_.set_shape(x, measure)) return;
  tree_rows_.clear();
  medium_->set_sources(sources_);
  if (tree_) tree_->repeat(medium_->node_shifts());
}

void Layer::apply(const Net& f, std::span<const int> sites, Net& u) {
  const LayerSurface& surface = sources_.surface;
  assert(surface.n_sites > 0 && "a layer is for sites or for points off its surfaces");
  sources_.set_density(f);
  const std::span<const int> far_rows = shared() ? everybody_ : sites, in_tree = tree_ ? std::span<const int>(fundamental_sites_) : sites;
  Net at(u.rows(), 3), f0 = Net::Zero(u.rows(), 3);
  for (const int i : in_tree) at.row(i) = surface.site(i).transpose();
  for (const int i : far_rows)
    if (!single()) f0.row(i) = surface.value(i, sources_.bezier_f).transpose();
  integrate({sites, far_rows, at, f0, in_tree, true, no_row}, nullptr, u);
}

void Layer::apply(const Net& f, const Net& at, std::span<const int> targets, Net& u, const Near* kept, int first_image_row) {
  apply(f, Net::Zero(at.rows(), 3), at, targets, u, kept, first_image_row);
}

void Layer::apply(const Net& f, const Net& f0, const Net& at, std::span<const int> targets, Net& u, const Near* kept, int first_image_row) {
  assert(sources_.surface.n_sites == 0 && !shared() && "a layer is for sites or for points off its surfaces");
  assert(!kept || kept->first.size() == targets.size() + 1);
  sources_.set_density(f);
  const std::vector<int> all = indices(at.rows());
  integrate({targets, targets, at, f0, all, false, first_image_row}, kept, u);
}

/// Evaluates the potential at the targets: the far-field sum over all panels and the terms of the medium, corrected by near-singular and singular
/// quadrature on panels that are close to a target or contain it.
void Layer::integrate(const LayerTargets& targets, const Near* kept, Net& u) {
  add_far(targets, u);
  medium_->add(sources_, targets, u);
  kept ? add_kept(targets, *kept, u) : add_near(targets, u);
  if (targets.sites) add_self(targets, u);
  for (const int i : targets.far_rows) u.row(i) *= over_8_pi;
}

void Layer::add_near(const LayerTargets& targets, Net& u) {
  const auto clock = sources_.phases.time("near");
  LayerSurface& surface = sources_.surface;
  for (const int i : targets.rows) {
    const Vec3 f0 = targets.f0.row(i);
    for (const Vec3& image : medium_->panel_shifts()) {
      if (i >= targets.first_image_row && image.isZero(0)) continue;
      const Vec3 at = targets.at.row(i).transpose() - image;
      const std::span<SelfPair> self_pairs = targets.sites && image.isZero(0) ? surface.self_pairs(i) : std::span<SelfPair>();
      for (const int e : surface.near(at, self_pairs))
        u.row(i) += sources_.beyond_far_sum(e, surface.near_field.rule(e, at, self_pairs), nullptr, at, f0, sources_.evaluations.near).transpose();
    }
  }
}

void Layer::add_self(const LayerTargets& targets, Net& u) {
  const auto clock = sources_.phases.time("self");
  LayerSurface& surface = sources_.surface;
  for (const int i : targets.rows)
    for (SelfPair& pair : surface.self_pairs(i)) {
      const PointTable& table = surface.self_field.rule(pair, surface.panels, surface.bezier);
      u.row(i) +=
          sources_.beyond_far_sum(pair.panel, table, &pair, targets.at.row(i), targets.f0.row(i), sources_.evaluations.self).transpose();
    }
  if (sources_.desingularised()) subtract_identities(targets.rows, u);
}

/// Returns the positions of the targets `rows` for the far sums.
std::vector<Vec3> Layer::far_targets(const LayerTargets& targets, std::span<const int> rows) const {
  std::vector<Vec3> at = rows_of(targets.at, rows);
  for (Vec3& x : at) x = medium_->wrapped(x);
  return at;
}

void Layer::add_far(const LayerTargets& targets, Net& u) {
  const auto clock = sources_.phases.time("far");
  if (tree_) {
    place_tree(targets);
    single() ? add_forces_by_clusters(targets, u) : add_stresslets_by_clusters(targets, u);
    sources_.evaluations.far += tree_->interactions();
    return;
  }
  const std::vector<Vec3> places = far_targets(targets, targets.far_rows), f0 = rows_of(targets.f0, targets.far_rows);
  Net all = Net::Zero(static_cast<Eigen::Index>(places.size()), 3);
  for (const Vec3& image : medium_->node_shifts()) {
    std::vector<Vec3> at = places;
    for (Vec3& x : at) x -= image;
    all += sources_.direct_sum(medium_->nodes(sources_), at, f0);
  }
  for (std::size_t k = 0; k < places.size(); ++k) u.row(targets.far_rows[k]) = all.row(static_cast<Eigen::Index>(k));
}

/// Sets the nodes and targets of the tree of clusters, and for a double layer computes the sum of T_ijk n_k over all far nodes at the targets. The
/// tree and these sums are reused if the shape and the targets have not changed, because a Krylov solver applies the layer of one shape many times.
/// Row k + g n of the tree's sums belongs to symmetry image g of target k (g = 0: the target itself), where n is the number of targets.
void Layer::place_tree(const LayerTargets& targets) {
  std::vector<Vec3> at = far_targets(targets, targets.in_tree);
  if (std::ranges::equal(targets.far_rows, tree_rows_) && at == tree_at_) return;
  tree_at_ = std::move(at);
  tree_rows_.assign(targets.far_rows.begin(), targets.far_rows.end());
  if (medium_->wraps())
    tree_->set_sources(medium_->nodes(sources_), indices(n_nodes() + 1), tree_at_);
  else
    sources_.surface.set_sources_of(*tree_, tree_at_);
  std::vector<int> wanted;
  const std::size_t reflections = medium_->wraps() ? 0 : sources_.surface.reflections().size();
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
  const auto& normal = sources_.normal;
  tree_->sum<NormalStressKernel>({normal[0].data(), normal[1].data(), normal[2].data()}, stress_.data());
  sources_.evaluations.far += tree_->interactions();
}

/// Adds the far sums of the single layer by clusters. In a symmetric scene the sources are the nodes of the fundamental panels, and the sums at the
/// reflections of the targets are added (2.19). If the medium is a lattice, which shifts each node and target into the unit cell, symmetry cannot be
/// used: the sources are the nodes of all panels, and targets have no reflections.
void Layer::add_forces_by_clusters(const LayerTargets& targets, Net& u) {
  const auto& [fundamental, weight] = sources_.surface.fundamental();
  const bool all = medium_->wraps();
  const std::span<const surface::Reflection> images = all ? std::span<const surface::Reflection>() : sources_.surface.reflections();
  std::vector<double> strength[3];
  for (int c = 0; c < 3 && all; ++c) strength[c] = sources_.density[c];
  for (std::size_t k = 0; k < fundamental.size() && !all; ++k) {
    const Panel& panel = sources_.surface.panels[fundamental[k]];
    for (int c = 0; c < 3; ++c)
      for (int q = 0; q < panel.table->n_nodes; ++q) strength[c].push_back(weight[k] * sources_.density[c][panel.first_node + q]);
  }
  const std::size_t n = tree_at_.size();
  Net there(n * (images.size() + 1), 3);
  tree_->sum<StokesletKernel>({strength[0].data(), strength[1].data(), strength[2].data()}, there.data());
  for (const int i : targets.far_rows) {
    const auto k = std::ranges::lower_bound(targets.in_tree, i) - targets.in_tree.begin();
    u.row(i) = there.row(k);
    for (std::size_t g = 0; g < images.size(); ++g)
      u.row(i) += there.row(k + static_cast<Eigen::Index>((g + 1) * n)).cwiseProduct(images[g].signs.transpose());
  }
}

/// Computes the far sum of the double layer by clusters, sum_q (f - m)_j T_ijk n_k - (f0 - m)_j sum_q T_ijk n_k. The sums are over the far nodes q. f
/// is the density, m its mean, and f0 the constant that is subtracted from f for the target. The sum is exactly 0 for a uniform density.
void Layer::add_stresslets_by_clusters(const LayerTargets& targets, Net& u) {
  const Vec3 mean = sources_.mean_density();
  sources_.set_moments(mean);
  std::array<const double*, 6> strength;
  for (std::size_t c = 0; c < 6; ++c) strength[c] = sources_.moment[c].data();
  Net there(tree_at_.size(), 3);
  tree_->sum<StressletKernel>(strength, there.data());
  for (const int i : targets.far_rows) {
    const auto k = std::ranges::lower_bound(targets.in_tree, i) - targets.in_tree.begin();
    const double* s = &stress_[static_cast<std::size_t>(6 * k)];
    Mat3 stress;
    stress << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
    u.row(i) = there.row(k) - (stress * (targets.f0.row(i).transpose() - mean)).transpose();
  }
}

Layer::Near Layer::near(const Net& at, std::span<const int> targets, int first_image_row) {
  const auto clock = sources_.phases.time("near");
  LayerSurface& surface = sources_.surface;
  Near kept{{0}, {}, {}};
  for (const int i : targets) {
    for (const Vec3& image : medium_->panel_shifts()) {
      if (i >= first_image_row && image.isZero(0)) continue;
      const Vec3 y = at.row(i).transpose() - image;
      for (const int e : surface.near(y, {})) {
        const std::size_t first = kept.moments.size();
        kept.panels.push_back(e);
        kept.moments.resize(first + static_cast<std::size_t>(6) * surface.panels[e].table->n_bernstein);
        const PointTable& table = surface.near_field.rule(e, y, {});
        sources_.moments_beyond_far_sum(e, table, nullptr, y, &kept.moments[first]);
        sources_.evaluations.near += table.points + surface.panels[e].table->n_nodes;
      }
    }
    kept.first.push_back(kept.panels.size());
  }
  return kept;
}

void Layer::add_kept(const LayerTargets& targets, const Near& kept, Net& u) const {
  const double* m = kept.moments.data();
  for (std::size_t k = 0; k < targets.rows.size(); ++k) {
    const int i = targets.rows[k];
    double sum[3] = {0, 0, 0};
    for (std::size_t pair = kept.first[k]; pair < kept.first[k + 1]; ++pair) {
      const Panel& panel = sources_.surface.panels[kept.panels[pair]];
      const int n_b = panel.table->n_bernstein;
      const double* f = &sources_.bezier_f[panel.first_bezier];
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

}  // namespace tanktread::stokes
