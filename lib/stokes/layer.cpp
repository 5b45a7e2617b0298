#include "stokes/layer.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <utility>

#include "base/indices.hpp"
#include "stokes/closed_surface_identities.hpp"
#include "stokes/sums/layer_rule.hpp"

namespace tanktread::stokes {

Layer::Layer(Kernel kernel, const spline::Space& space, const Sites& sites, const quadrature::Options& options, std::vector<double> factor)
    : sources_(kernel, space, sites, options, std::move(factor)) {
  if (sums_by_tree(space, options)) use_clusters();
  fundamental_sites_ = indices(sites.size());
}

void Layer::set_symmetry(const surface::Symmetry& symmetry) {
  sources_.surface.set_symmetry(symmetry);
  if (sources_.surface.n_sites == sources_.surface.n_points) fundamental_sites_ = symmetry.fundamental();
  if (clusters_) clusters_->renew();
}

void Layer::set_reference(const Net& unstressed, std::vector<bool> per_current_area) {
  sources_.set_reference(unstressed, std::move(per_current_area));
}

void Layer::use_clusters() {
  clusters_.emplace(cluster_tolerance());
  clusters_->share(part_, parts_);
}

void Layer::use(std::unique_ptr<LayerMedium> medium) {
  medium_ = std::move(medium);
  sources_.surface.repeat();
  sources_.renew_shape();
}

void Layer::repeat(const PeriodicCell& cell, const Repetition& how) {
  const auto* lattice = dynamic_cast<const Lattice*>(medium_.get());
  if (lattice && lattice->is(cell, how)) return;
  if (!lattice) require_no_medium();
  if (!clusters_ && sums_by_tree(lattice_images * n_nodes(), sources_.surface.options)) use_clusters();
  use(std::make_unique<Lattice>(cell, how));
}

/// Throws std::logic_error if the layer has a medium or is on a lattice.
void Layer::require_no_medium() const {
  if (!dynamic_cast<const UnboundedFluid*>(medium_.get())) throw std::logic_error("a layer has one medium, or is on a lattice");
}

void Layer::set_medium(const Medium& medium) {
  require_no_medium();
  if (!properties(sources_.surface.options.rule).corrects_near)
    throw std::logic_error("a medium needs Quadrature/rule `adaptive`, because it integrates over its images by near-singular rules");
  if (shared()) throw std::logic_error("Layer::set_medium must be called before Layer::share, because the far sums of the medium are shared as well");
  use(medium.in_layer(sources_, by_clusters()));
}

void Layer::share(int part, int parts, std::vector<int> everybody) {
  part_ = part, parts_ = parts;
  everybody_ = std::move(everybody);
  if (!shared()) return;
  clusters_->share(part, parts);
  medium_->share(part, parts);
}

void Layer::set_shape(const Net& x, Measure measure) {
  const auto clock = sources_.phases.time("setup");
  if (!sources_.set_shape(x, measure)) return;
  medium_->set_sources(sources_);
  if (clusters_) clusters_->repeat(medium_->node_shifts());
}

void Layer::apply(const Net& f, std::span<const int> sites, Net& u) {
  const LayerSurface& surface = sources_.surface;
  assert(surface.n_sites > 0 && "a layer is for sites or for points off its surfaces");
  assert((!shared() || std::ranges::includes(everybody_, sites)) && "share() is called with the sites of all ranks");
  sources_.set_density(f);
  const std::span<const int> far_rows = shared() ? everybody_ : sites, in_tree = clusters_ ? std::span<const int>(fundamental_sites_) : sites;
  Net at(u.rows(), 3), f0 = Net::Zero(u.rows(), 3);
  for (const int i : in_tree) at.row(i) = surface.site(i).transpose();
  for (const int i : far_rows)
    if (properties(sources_.kernel()).subtracts_density) f0.row(i) = surface.value(i, sources_.bezier_f).transpose();
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
  set_far(targets, u);
  LayerTargets of_medium = targets;
  if (!medium_->shares_sums()) of_medium.far_rows = targets.rows;
  medium_->add(sources_, of_medium, u);
  kept ? add_kept(targets, *kept, u) : add_near(targets, u);
  if (targets.sites) add_self(targets, u);
  for (const int i : targets.far_rows) u.row(i) *= over_8_pi;
}

void Layer::add_near(const LayerTargets& targets, Net& u) {
  const auto clock = sources_.phases.time("near");
  LayerSurface& surface = sources_.surface;
  each_item(targets.rows.size(), [&](std::size_t k) {
    const int i = targets.rows[k];
    const Vec3 f0 = targets.f0.row(i);
    for (const Vec3& image : medium_->panel_shifts()) {
      if (i >= targets.first_image_row && image.isZero(0)) continue;
      const Vec3 at = targets.at.row(i).transpose() - image;
      const std::span<SelfPair> self_pairs = targets.sites && image.isZero(0) ? surface.self_pairs(i) : std::span<SelfPair>();
      for (const int e : surface.near(at, self_pairs))
        u.row(i) += sources_.beyond_far_sum(e, surface.near_field.rule(e, at, self_pairs), nullptr, at, f0, sources_.counts.mine().near).transpose();
    }
  });
}

void Layer::add_self(const LayerTargets& targets, Net& u) {
  const auto clock = sources_.phases.time("self");
  LayerSurface& surface = sources_.surface;
  surface.with_rules(targets.rows, 1, [&](std::span<const int> rows, std::size_t) {
    each_item(rows.size(), [&](std::size_t k) {
      const int i = rows[k];
      for (SelfPair& pair : surface.self_pairs(i))
        u.row(i) += sources_.beyond_far_sum(pair.panel, *pair.table, &pair, targets.at.row(i), targets.f0.row(i), sources_.counts.mine().self)
                        .transpose();
    });
  });
  if (sources_.desingularised()) subtract_identities(sources_, targets.rows, u);
}

/// Sets the far rows of u to the sums over all far nodes, without the factor 1/(8 pi).
void Layer::set_far(const LayerTargets& targets, Net& u) {
  const auto clock = sources_.phases.time("far");
  if (clusters_) return clusters_->set_sums(sources_, *medium_, targets, u);
  const std::vector<Vec3> at = wrapped(*medium_, targets, targets.far_rows), f0 = rows_of(targets.f0, targets.far_rows);
  Net all = Net::Zero(static_cast<Eigen::Index>(at.size()), 3);
  for (const Vec3& image : medium_->node_shifts()) {
    std::vector<Vec3> displaced = at;
    for (Vec3& x : displaced) x -= image;
    all += sources_.direct_sum(medium_->nodes(sources_), displaced, f0);
  }
  for (std::size_t k = 0; k < at.size(); ++k) u.row(targets.far_rows[k]) = all.row(static_cast<Eigen::Index>(k));
}

Layer::Near Layer::near(const Net& at, std::span<const int> targets, int first_image_row) {
  const auto clock = sources_.phases.time("near");
  LayerSurface& surface = sources_.surface;
  std::vector<Near> of_target(targets.size());
  each_item(targets.size(), [&](std::size_t k) {
    const int i = targets[k];
    auto& [first, first_moment, panels, moments] = of_target[k];
    for (const Vec3& image : medium_->panel_shifts()) {
      if (i >= first_image_row && image.isZero(0)) continue;
      const Vec3 y = at.row(i).transpose() - image;
      for (const int e : surface.near(y, {})) {
        const std::size_t begin = moments.size();
        panels.push_back(e);
        moments.resize(begin + static_cast<std::size_t>(kernel_entries) * surface.panels[e].table->n_bernstein);
        const PointTable& table = surface.near_field.rule(e, y, {});
        sources_.moments_beyond_far_sum(e, table, nullptr, y, &moments[begin]);
        sources_.counts.mine().near += table.points + surface.panels[e].table->n_nodes;
      }
    }
  });
  Near kept{{0}, {0}, {}, {}};
  for (Near& one : of_target) {
    kept.panels.insert(kept.panels.end(), one.panels.begin(), one.panels.end());
    kept.moments.insert(kept.moments.end(), one.moments.begin(), one.moments.end());
    kept.first.push_back(kept.panels.size());
    kept.first_moment.push_back(kept.moments.size());
    one = {};
  }
  return kept;
}

void Layer::add_kept(const LayerTargets& targets, const Near& kept, Net& u) const {
  each_block(targets.rows.size(), 16, [&](std::size_t begin, std::size_t end) {
    const double* m = kept.moments.data() + kept.first_moment[begin];
    for (std::size_t k = begin; k < end; ++k) {
      const int i = targets.rows[k];
      double sum[3] = {0, 0, 0};
      for (std::size_t pair = kept.first[k]; pair < kept.first[k + 1]; ++pair) {
        const Panel& panel = sources_.surface.panels[kept.panels[pair]];
        const int n_b = panel.table->n_bernstein;
        const double* f = &sources_.bezier_f[panel.first_bezier];
        for (int b = 0; b < n_b; ++b, m += kernel_entries) {
          const double f1 = f[b] - targets.f0(i, 0), f2 = f[n_b + b] - targets.f0(i, 1), f3 = f[2 * n_b + b] - targets.f0(i, 2);
          sum[0] += m[0] * f1 + m[1] * f2 + m[2] * f3;
          sum[1] += m[1] * f1 + m[3] * f2 + m[4] * f3;
          sum[2] += m[2] * f1 + m[4] * f2 + m[5] * f3;
        }
      }
      for (int c = 0; c < 3; ++c) u(i, c) += sum[c];
    }
  });
}

}  // namespace tanktread::stokes
