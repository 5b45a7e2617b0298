#include "stokes/sums/near_field.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "base/groups.hpp"
#include "quadrature/gauss.hpp"

namespace tanktread::stokes {
namespace {

/// Returns the error permitted for one panel, relative to the integral over the whole surface. The permitted error is smaller than `tolerance`,
/// because the errors of several panels add up, and because the error estimate rho^(-2 n) (2.9) omits factors that grow with the order. Factor and
/// exponent were chosen from errors measured on deformed surfaces (tests/verify/layers.cpp).
double share(double tolerance) { return 0.3 * std::pow(tolerance, 1.125); }

Vec3 point(const double* bezier, int n_b, int b) { return {bezier[b], bezier[n_b + b], bezier[2 * n_b + b]}; }

quadrature::Patch flat_patch(const double* bezier, int degree) {
  const int n = degree + 1, n_b = n * n;
  const Vec3 a = point(bezier, n_b, 0), b = point(bezier, n_b, degree), c = point(bezier, n_b, n_b - 1), d = point(bezier, n_b, n_b - n);
  return {(a + b + c + d) / 4, (b - a + c - d) / 4, (c - b + d - a) / 4};
}

/// Finds the connected surfaces: panels that share control points are on the same surface. Sets the index of the surface of each panel and returns
/// the number of surfaces.
int connected(const Panels& panels, std::vector<int>& surface) {
  std::vector<int> first;  // for each control point, the first panel that depends on it; -1 if not found yet
  Groups joined(panels.size());
  for (int e = 0; e < panels.size(); ++e)
    for (int a = 0; a < panels[e].functions; ++a) {
      const auto point = static_cast<std::size_t>(panels.points(e)[a]);
      if (point >= first.size()) first.resize(point + 1, -1);
      if (first[point] < 0) first[point] = e;
      joined.join(e, first[point]);
    }
  std::vector<int> number(panels.size(), -1);
  int n = 0;
  surface.resize(panels.size());
  for (int e = 0; e < panels.size(); ++e) {
    int& mine = number[joined.of(e)];
    if (mine < 0) mine = n++;
    surface[e] = mine;
  }
  return n;
}

/// Returns a conservative estimate of the distance from a panel beyond which `order` points per direction reach the accuracy `demand` for any target.
double clearance(double area, double longest, const quadrature::Demand& demand, int order) {
  double d = longest;
  for (int k = 0; k < 2; ++k) {
    const double rho = std::pow(std::min(1., demand.error(area, d)), -0.5 / order);
    d = std::max((rho - 1 / rho) / 2, 1e-3) * longest;
  }
  return d;
}

}  // namespace

NearField::NearField(const Panels& panels, double tolerance, int smooth_order, bool steep, bool off_surface)
    : panels_(panels),
      demand_{0, 0, tolerance, smooth_order},
      steep_(steep),
      largest_order_(1 + quadrature::order_for(tolerance, quadrature::ellipse(0, 1))),
      views_(panels.size()),
      reach_(panels.size()) {
  n_surfaces_ = connected(panels, surface_);
  across_gaps_ = off_surface || n_surfaces_ > 1;
  for (auto& c : centre_) c.resize(panels.size());
  for (int e = 0; e < panels.size(); ++e) {
    if (e > 0 && panels[e].table == panels[e - 1].table) continue;
    for (int degree = panels[e].table->degree, order = panels[e].table->order + 1; order <= largest_order_; ++order)
      if (const auto [at, is_new] = whole_.try_emplace({degree, order}); is_new)
        tabulate(quadrature::Rule(quadrature::tensor_gauss(order)), degree, at->second);
  }
}

void NearField::view(int e) {
  const NodeTable& t = *panels_[e].table;
  const double* points = &(*bezier_)[panels_[e].first_bezier];
  View& view = views_[e];
  view.flat = flat_patch(points, t.degree);
  view.area = view.flat.area();
  const auto& [centre, u, v] = view.flat;
  double square = 0;
  for (int b = 0; b < t.n_bernstein; ++b) square = std::max(square, (point(points, t.n_bernstein, b) - centre).squaredNorm());
  view.radius = std::sqrt(square);
  view.normal = u.cross(v).normalized();
  view.bulge = (point(points, t.n_bernstein, 0) - centre + u + v).norm();  // distance of each corner from the corner of the planar approximation
  for (int j = 1; j < t.degree; ++j)  // all inner Bezier points, so that the result does not depend on the directions of s and t
    for (int i = 1; i < t.degree; ++i)
      view.bulge = std::max(view.bulge, std::abs((point(points, t.n_bernstein, j * (t.degree + 1) + i) - centre).dot(view.normal)));
}

void NearField::update(const std::vector<double>& bezier, const PanelImages& images) {
  bezier_ = &bezier;
  each_block(panels_.size(), panel_block, [&](int first, int last) {
    for (int e = first; e < last; ++e)
      if (!images.is_image(e)) view(e);
  });
  std::vector<double> total(static_cast<std::size_t>(n_surfaces_), 0.);
  for (int e = 0; e < panels_.size(); ++e) total[static_cast<std::size_t>(surface_[e])] += views_[images.source[e]].area;
  const auto demand = [&](int e) {
    View& view = views_[e];
    const double area = total[static_cast<std::size_t>(surface_[e])];
    view.demand = demand_;
    view.demand.allowed = share(demand_.tolerance) * std::sqrt(4 * std::numbers::pi * area);
    view.across = view.demand;
    if (steep_) view.across.steep = std::sqrt(area / (4 * std::numbers::pi));
    const double longest = std::max(view.flat.u.norm(), view.flat.v.norm());
    const auto& strictest = across_gaps_ ? view.across : view.demand;
    const double reach = view.radius + view.bulge + clearance(view.area, longest, strictest, panels_[e].table->order);
    reach_[e] = reach * reach;
  };
  each_block(panels_.size(), panel_block, [&](int first, int last) {
    for (int e = first; e < last; ++e)
      if (!images.is_image(e)) demand(e);
  });
  for (int e = 0; e < panels_.size(); ++e) {
    if (images.is_image(e)) {
      const surface::Reflection& image = images.reflections[images.image[e]];
      const int source = images.source[e];
      views_[e] = views_[source];
      quadrature::Patch& flat = views_[e].flat;
      flat = {image(flat.centre), image.of_vector(flat.u), image.of_vector(flat.v)};
      views_[e].normal = flat.u.cross(flat.v).normalized();
      reach_[e] = reach_[source];
    }
    for (int c = 0; c < 3; ++c) centre_[c][e] = views_[e].flat.centre[c];
  }
  vicinity_.set_points(panels_.size(), centre_[0].data(), centre_[1].data(), centre_[2].data(), reach_.data());
}

bool NearField::on_same_surface(int e, std::span<const SelfPair> self_pairs) const {
  return !self_pairs.empty() && surface_[self_pairs.front().panel] == surface_[e];
}

/// Returns the distance of a target from the planar approximation of a panel, and the parameters of the Bernstein ellipses. If `across` is true
/// (target not on the panel's surface), the distance is reduced by the height of the panel's bulge, because the panel may bulge towards the target.
/// This costs one to three Gauss points per direction (tests/verify/layer_shapes.cpp). A target on the same surface needs no such reduction.
quadrature::Sight NearField::sight(const View& view, const Vec3& target, bool across) {
  if (!across) return quadrature::sight(view.flat, target);
  const double height = (target - view.flat.centre).dot(view.normal);
  return quadrature::sight(view.flat, target - std::clamp(height, -view.bulge, view.bulge) * view.normal);
}

bool NearField::far_enough(int e, const Vec3& target, std::span<const SelfPair> self_pairs) const {
  const View& view = views_[e];
  const bool across = !on_same_surface(e, self_pairs);
  const quadrature::Sight seen = sight(view, target, across);
  const double rho = std::min(seen.rho_u, seen.rho_v);
  double power = (across ? view.across : view.demand).error(view.area, seen.distance);
  for (int k = 0; k < panels_[e].table->order && power < 1; ++k) power *= rho * rho;
  return power >= 1;
}

void NearField::list(const Vec3& target, std::span<const SelfPair> self_pairs, std::vector<int>& near) const {
  std::vector<int>& suspects = scratch_.mine().suspects;
  near.clear();
  suspects.clear();
  vicinity_.list(target.data(), suspects);
  for (const int e : suspects) {
    const bool on_it = std::any_of(self_pairs.begin(), self_pairs.end(), [&](const SelfPair& pair) { return pair.panel == e; });
    if (!on_it && !far_enough(e, target, self_pairs)) near.push_back(e);
  }
  std::sort(near.begin(), near.end());
}

const PointTable& NearField::rule(int panel, const Vec3& target, std::span<const SelfPair> self_pairs) const {
  assert(bezier_ && "update() comes first");
  const NodeTable& t = *panels_[panel].table;
  const View& view = views_[panel];
  const bool across = !on_same_surface(panel, self_pairs);
  const quadrature::Demand& demand = across ? view.across : view.demand;
  const quadrature::Sight seen = sight(view, target, across);
  const int needed = quadrature::order_for(demand.error(view.area, seen.distance), std::min(seen.rho_u, seen.rho_v));
  const int order = std::max(needed, t.order + 1);
  if (order <= largest_order_ && view.bulge <= 0.5 * seen.distance) return whole_.at({t.degree, order});
  auto& [suspects, points, parts] = scratch_.mine();
  points.clear();
  const std::span<const double> bezier(bezier_->data() + panels_[panel].first_bezier, static_cast<std::size_t>(3) * t.n_bernstein);
  quadrature::graded(bezier, t.degree, target, demand, points);
  tabulate(points, t.degree, parts);
  return parts;
}

}  // namespace tanktread::stokes
