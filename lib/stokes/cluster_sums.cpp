#include "stokes/cluster_sums.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "base/indices.hpp"

namespace tanktread::stokes {

std::vector<Vec3> wrapped(const LayerMedium& medium, const LayerTargets& targets, std::span<const int> rows) {
  std::vector<Vec3> at = rows_of(targets.at, rows);
  for (Vec3& x : at) x = medium.wrapped(x);
  return at;
}

void ClusterSums::share(int part, int parts) {
  tree_.share(part, parts);
  renew();
}

void ClusterSums::repeat(std::vector<Vec3> images) {
  tree_.repeat(std::move(images));
  renew();
}

void ClusterSums::set_sums(LayerSources& sources, const LayerMedium& medium, const LayerTargets& targets, Net& u) {
  place(sources, medium, targets);
  switch (sources.kernel()) {
    case LayerKernel::single_layer: set_sums_of_forces(sources, medium, targets, u); break;
    case LayerKernel::double_layer: set_sums_of_stresslets(sources, targets, u); break;
  }
  sources.counts.mine().far += tree_.interactions();
}

/// Sets the nodes and targets of the tree of clusters, and for a double layer computes the sum of T_ijk n_k over all far nodes at the targets. The
/// tree and these sums are reused if the shape and the targets have not changed, because a Krylov solver applies the layer of one shape many times.
/// Row k + g n of the tree's sums belongs to symmetry image g of target k (g = 0: the target itself), where n is the number of targets.
void ClusterSums::place(LayerSources& sources, const LayerMedium& medium, const LayerTargets& targets) {
  std::vector<Vec3> at = wrapped(medium, targets, targets.in_tree);
  if (std::ranges::equal(targets.far_rows, rows_) && at == at_) return;
  at_ = std::move(at);
  rows_.assign(targets.far_rows.begin(), targets.far_rows.end());
  if (medium.wraps())
    tree_.set_sources(medium.nodes(sources), indices(sources.n_nodes() + 1), at_);
  else
    sources.surface.set_sources_of(tree_, at_);
  std::vector<int> wanted;
  const std::size_t reflections = medium.wraps() ? 0 : sources.surface.reflections().size();
  for (std::size_t g = 0; g <= reflections; ++g)
    for (const int i : rows_) {
      const auto k = std::ranges::lower_bound(targets.in_tree, i) - targets.in_tree.begin();
      assert(targets.in_tree[k] == i && "rows are of fundamental sites");
      wanted.push_back(static_cast<int>(k + static_cast<std::ptrdiff_t>(g * at_.size())));
    }
  tree_.want(wanted);
  switch (sources.kernel()) {
    case LayerKernel::single_layer: return;
    case LayerKernel::double_layer: break;  // the constants f0 are multiplied by the sum of T_ijk n_k
  }
  assert(reflections == 0);
  stress_.resize(6 * at_.size());
  const auto& normal = sources.normal;
  tree_.sum<NormalStressKernel>({normal[0].data(), normal[1].data(), normal[2].data()}, stress_.data());
  sources.counts.mine().far += tree_.interactions();
}

/// Computes the far sums of the single layer by clusters. In a symmetric scene the sources are the nodes of the fundamental panels, and the sums at
/// the reflections of the targets are added (2.19). If the medium is a lattice, which shifts each node and target into the unit cell, symmetry cannot
/// be used: the sources are the nodes of all panels, and targets have no reflections.
void ClusterSums::set_sums_of_forces(LayerSources& sources, const LayerMedium& medium, const LayerTargets& targets, Net& u) {
  const auto& [fundamental, weight] = sources.surface.fundamental();
  const bool all = medium.wraps();
  const std::span<const surface::Reflection> images = all ? std::span<const surface::Reflection>() : sources.surface.reflections();
  std::vector<double> strength[3];
  for (int c = 0; c < 3 && all; ++c) strength[c] = sources.density[c];
  for (std::size_t k = 0; k < fundamental.size() && !all; ++k) {
    const Panel& panel = sources.surface.panels[fundamental[k]];
    for (int c = 0; c < 3; ++c)
      for (int q = 0; q < panel.table->n_nodes; ++q) strength[c].push_back(weight[k] * sources.density[c][panel.first_node + q]);
  }
  const std::size_t n = at_.size();
  Net there(n * (images.size() + 1), 3);
  tree_.sum<StokesletKernel>({strength[0].data(), strength[1].data(), strength[2].data()}, there.data());
  for (const int i : targets.far_rows) {
    const auto k = std::ranges::lower_bound(targets.in_tree, i) - targets.in_tree.begin();
    u.row(i) = there.row(k);
    for (std::size_t g = 0; g < images.size(); ++g)
      u.row(i) += there.row(k + static_cast<Eigen::Index>((g + 1) * n)).cwiseProduct(images[g].signs.transpose());
  }
}

/// Computes the far sum of the double layer by clusters, sum_q (f - m)_j T_ijk n_k - (f0 - m)_j sum_q T_ijk n_k. The sums are over the far nodes q. f
/// is the density, m its mean, and f0 the constant that is subtracted from f for the target. The sum is exactly 0 for a uniform density.
void ClusterSums::set_sums_of_stresslets(LayerSources& sources, const LayerTargets& targets, Net& u) {
  const Vec3 mean = sources.mean_density();
  const LayerSources::StressletMoments& moments = sources.stresslet_moments(mean);
  std::array<const double*, 6> strength;
  for (std::size_t c = 0; c < 6; ++c) strength[c] = moments[c].data();
  Net there(at_.size(), 3);
  tree_.sum<StressletKernel>(strength, there.data());
  for (const int i : targets.far_rows) {
    const auto k = std::ranges::lower_bound(targets.in_tree, i) - targets.in_tree.begin();
    const double* s = &stress_[static_cast<std::size_t>(6 * k)];
    Mat3 stress;
    stress << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
    u.row(i) = there.row(k) - (stress * (targets.f0.row(i).transpose() - mean)).transpose();
  }
}

}  // namespace tanktread::stokes
