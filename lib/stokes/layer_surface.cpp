#include "stokes/layer_surface.hpp"

namespace tanktread::stokes {
namespace {

/// Gauss points a direction of the far rule. Measured on deformed capsules at n = 3, 6 and 12 (tests/verify/layers.cpp).
int far_order(const quadrature::Options& options) {
  if (options.rule != "adaptive") return options.points;
  if (options.tolerance >= 1e-4) return 3;
  if (options.tolerance >= 1e-6) return 4;
  if (options.tolerance >= 1e-8) return 6;
  if (options.tolerance >= 1e-9) return 7;
  return options.tolerance >= 1e-10 ? 9 : 11;
}

}  // namespace

LayerSurface::LayerSurface(const spline::Space& space, const quadrature::Options& how, bool steep)
    : options(how),
      n_points(space.n_points),
      panels(space, std::vector<int>(space.elements.size(), far_order(how))),
      near_field(panels, how.tolerance, far_order(how), steep),
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
