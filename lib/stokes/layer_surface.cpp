#include "stokes/layer_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "quadrature/ellipse.hpp"

namespace tanktread::stokes {
namespace {

/// Below this share of the median size an element counts as tiny.
constexpr double tiny = 0.3;

/// Gauss points a direction of the far rule. Measured on deformed capsules at n = 3, 6 and 12 (tests/verify/layers.cpp).
int far_order(const quadrature::Options& options) {
  if (options.rule != "adaptive") return options.points;
  if (options.tolerance >= 1e-4) return 3;
  if (options.tolerance >= 1e-6) return 4;
  if (options.tolerance >= 1e-8) return 6;
  if (options.tolerance >= 1e-9) return 7;
  return options.tolerance >= 1e-10 ? 9 : 11;
}

/// The same for each element. Pieces that are tiny beside the others (those at the extraordinary points of Catmull-Clark surfaces) get
/// by with less: the smooth part of the integrand converges faster on them, and their share of the area is small.
std::vector<int> far_orders(const spline::Space& space, const quadrature::Options& options, int order) {
  std::vector<int> orders(space.elements.size(), order);
  if (options.rule != "adaptive") return orders;
  std::vector<double> sizes;
  for (const spline::Element& e : space.elements) sizes.push_back(std::sqrt(e.size[0] * e.size[1]));
  std::vector<double> sorted = sizes;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double median = sorted[sorted.size() / 2], rho = std::pow(options.tolerance, -0.5 / order);
  for (std::size_t e = 0; e < sizes.size(); ++e) {
    const double share = sizes[e] / median;
    if (share < tiny)
      orders[e] = std::clamp(quadrature::order_for(options.tolerance / (share * share), rho / share),
                             std::min(order, std::max(3, order - 2)), order);
  }
  return orders;
}

/// Far nodes from which clusters are faster: about twice as many nodes as a target of a large surface meets by clusters, which grows with
/// the square of the digits. Measured (tests/benchmark/growth.cpp).
double nodes_worth_a_tree(double tolerance) { return 1000 * std::pow(std::log10(tolerance), 2); }

}  // namespace

bool sums_by_tree(const spline::Space& space, const quadrature::Options& options) {
  if (options.far_sum != "auto") return options.far_sum == "tree";
  if (options.rule == "desingularised") return false;  // its identities meet every node anyway
  double nodes = 0;
  for (const int order : far_orders(space, options, far_order(options))) nodes += order * order;
  return nodes > nodes_worth_a_tree(options.tolerance);
}

LayerSurface::LayerSurface(const spline::Space& space, const quadrature::Options& how, bool steep, int order)
    : options(how),
      n_points(space.n_points),
      panels(space, far_orders(space, how, order ? order : far_order(how))),
      near_field(panels, how.tolerance, order ? order : far_order(how), steep),
      self_field(space, how) {}

void LayerSurface::place(const Net& x) {
  panels.bezier(x, bezier);
  node_values(panels, bezier, node);
  if (options.rule == "adaptive") near_field.update(bezier);
}

void LayerSurface::collocation_points(std::span<const int> targets, std::vector<Vec3>& at) const {
  at.clear();
  for (const int i : targets) at.push_back(self_field.value(i, panels, bezier));
}

void LayerSurface::place(TreeSum& tree) const {
  std::vector<int> everybody(n_points), first_nodes;
  std::iota(everybody.begin(), everybody.end(), 0);
  std::vector<Vec3> at;
  collocation_points(everybody, at);
  for (int e = 0; e < panels.size(); ++e) first_nodes.push_back(panels[e].first_node);
  first_nodes.push_back(panels.n_nodes());
  tree.place(node[0].data(), node[1].data(), node[2].data(), first_nodes, at);
}

const std::vector<int>& LayerSurface::near(int i, const Vec3& x0) {
  near_.clear();
  if (options.rule == "adaptive") near_field.list(x0, self_field[i], near_);
  return near_;
}

const std::vector<int>& LayerSurface::near(const Vec3& x0) {
  near_field.list(x0, {}, near_);
  return near_;
}

}  // namespace tanktread::stokes
