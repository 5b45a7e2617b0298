#include "stokes/single_layer.hpp"

#include <algorithm>
#include <cassert>
#include <numbers>

#include "stokes/pair_kernel.hpp"

namespace tanktread::stokes {
namespace {

constexpr double factor = 1 / (8 * std::numbers::pi);

/// Nodes that all targets meet before the next ones are loaded: 48 bytes each.
constexpr int nodes_in_cache = 4096;

/// Gauss points a direction of the far rule. Measured on capsules in shear at n = 6 and 12 (space.md, section 3; tests/verify/layers.cpp).
int far_order(const quadrature::Options& options) {
  if (options.rule == "fixed") return options.points;
  if (options.tolerance >= 1e-4) return 3;
  if (options.tolerance >= 1e-6) return 4;
  if (options.tolerance >= 1e-8) return 6;
  if (options.tolerance >= 1e-9) return 7;
  return options.tolerance >= 1e-10 ? 9 : 11;
}

}  // namespace

SingleLayer::SingleLayer(const spline::Space& space, const quadrature::Options& options)
    : options_(options),
      n_points_(space.n_points),
      panels_(space, std::vector<int>(space.elements.size(), far_order(options))),
      near_field_(panels_, options.tolerance, far_order(options)),
      self_field_(space, options) {}

void SingleLayer::set_reference(const Net& unstressed) {
  panels_.bezier(unstressed, bezier_unstressed_);
  node_weights(panels_, bezier_unstressed_, weight_unstressed_);
  for (int i = 0; i < n_points_; ++i)
    for (SelfPair& pair : self_field_[i]) pair.table = nullptr;
}

void SingleLayer::place(const Net& x, Measure measure, std::span<const int> targets) {
  panels_.bezier(x, bezier_);
  node_values(panels_, bezier_, node_);
  if (measure == Measure::current) {
    node_weights(panels_, bezier_, weight_present_);
    weight_ = &weight_present_, area_ = &bezier_;
  } else {
    assert(!weight_unstressed_.empty() && "set_reference() comes first");
    weight_ = &weight_unstressed_, area_ = &bezier_unstressed_;
  }
  if (options_.rule != "fixed") near_field_.update(bezier_);
  at_.clear();
  for (const int i : targets) at_.push_back(self_field_.point(i, panels_, bezier_));
}

PointForces SingleLayer::forces() const {
  return {panels_.n_nodes(), node_[0].data(), node_[1].data(), node_[2].data(), force_[0].data(), force_[1].data(), force_[2].data()};
}

void SingleLayer::apply(const Net& x, const Net& f, Measure measure, std::span<const int> targets, Net& u) {
  {
    const auto clock = phases_.time("setup");
    place(x, measure, targets);
    panels_.bezier(f, bezier_f_);
    node_values(panels_, bezier_f_, force_);
    for (auto& component : force_)
      for (int k = 0; k < panels_.n_nodes(); ++k) component[k] *= (*weight_)[k];
  }
  add_far(targets, u);
  add_near(targets, u);
  add_self(targets, measure, u);
  for (const int i : targets) u.row(i) *= factor;
}

void SingleLayer::add_far(std::span<const int> targets, Net& u) {
  const auto clock = phases_.time("far");
  const PointForces all = forces();
  const int n = static_cast<int>(targets.size());
  double block[3 * far_block], sums[3 * far_block];
  for (const int i : targets) u.row(i).setZero();
  for (int node = 0; node < all.n; node += nodes_in_cache) {
    const PointForces part = all.part(node, std::min(nodes_in_cache, all.n - node));
    for (int first = 0; first < n; first += far_block) {
      for (int l = 0; l < far_block; ++l)  // idle lanes repeat the last target
        for (int c = 0; c < 3; ++c) block[far_block * c + l] = at_[std::min(first + l, n - 1)][c];
      far_sum(part, block, sums);
      for (int l = 0; l < std::min(far_block, n - first); ++l)
        for (int c = 0; c < 3; ++c) u(targets[first + l], c) += sums[far_block * c + l];
    }
  }
  evaluations_.far += static_cast<long long>(n) * all.n;
}

void SingleLayer::list_near(int target, const Vec3& at) {
  near_.clear();
  if (options_.rule == "fixed") return;
  near_field_.list(at, self_field_[target], near_);
}

void SingleLayer::add_near(std::span<const int> targets, Net& u) {
  const auto clock = phases_.time("near");
  const PointForces all = forces();
  double far[3], own[3];
  for (std::size_t k = 0; k < targets.size(); ++k) {
    list_near(targets[k], at_[k]);
    for (const int e : near_) {
      const Panel& panel = panels_[e];
      const PointTable& table = near_field_.rule(e, at_[k]);
      point_weights_.resize(table.packs());
      area_weights(table, &(*area_)[panel.first_bezier], point_weights_.data());
      single_sum(table, &bezier_[panel.first_bezier], &bezier_f_[panel.first_bezier], point_weights_.data(), at_[k].data(), own);
      node_sum(all.part(panel.first_node, panel.table->n_nodes), at_[k].data(), far);
      for (int c = 0; c < 3; ++c) u(targets[k], c) += own[c] - far[c];
      evaluations_.near += table.points + panel.table->n_nodes;
    }
  }
}

const Pack* SingleLayer::self_weights(SelfPair& pair, Measure measure) {
  const Panel& panel = panels_[pair.panel];
  const bool is_new = self_field_.choose(pair, panel.table->degree, &bezier_[panel.first_bezier]);
  if (measure == Measure::current) {
    if (is_new) pair.weights.clear();
    point_weights_.resize(pair.table->packs());
    area_weights(*pair.table, &bezier_[panel.first_bezier], point_weights_.data());
    return point_weights_.data();
  }
  if (is_new || pair.weights.empty()) {
    pair.weights.resize(pair.table->packs());
    area_weights(*pair.table, &bezier_unstressed_[panel.first_bezier], pair.weights.data());
  }
  return pair.weights.data();
}

void SingleLayer::add_self(std::span<const int> targets, Measure measure, Net& u) {
  const auto clock = phases_.time("self");
  const PointForces all = forces();
  double far[3], own[3];
  for (std::size_t k = 0; k < targets.size(); ++k) {
    for (SelfPair& pair : self_field_[targets[k]]) {
      const Panel& panel = panels_[pair.panel];
      const Pack* weights = self_weights(pair, measure);
      single_sum(*pair.table, &bezier_[panel.first_bezier], &bezier_f_[panel.first_bezier], weights, at_[k].data(), own);
      node_sum(all.part(panel.first_node, panel.table->n_nodes), at_[k].data(), far);
      for (int c = 0; c < 3; ++c) u(targets[k], c) += own[c] - far[c];
      evaluations_.self += pair.table->points + panel.table->n_nodes;
    }
  }
}

}  // namespace tanktread::stokes
