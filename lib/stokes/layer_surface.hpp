#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/sums/near_field.hpp"
#include "stokes/sums/panels.hpp"
#include "stokes/sums/self_field.hpp"
#include "stokes/sums/tree_sum.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::stokes {

/// Whether `far sum` of the options means clusters for this space (TreeSum) or every target against every node; with so many images of the nodes.
bool sums_by_tree(const spline::Space& space, const quadrature::Options& options, int images = 1);
bool sums_by_tree(double nodes, const quadrature::Options& options);

/// The present surfaces as a layer integrates over them: panels, far nodes, and which rule each target needs on which panel.
class LayerSurface {
 public:
  /// `sites`: targets on the surfaces; none: all targets are off them. `steep`: the integrand grows like 1 / r^2 across gaps.
  LayerSurface(const spline::Space& space, const Sites& sites, const quadrature::Options& options, bool steep);

  /// States that targets see images of the surfaces too.
  void repeat();

  /// States that all shapes to come are of this symmetry.
  void set_symmetry(const surface::Symmetry& symmetry);

  /// Panels in a far sum over fundamental ones, and their weights there.
  const surface::FundamentalElements& fundamental() const { return fundamental_; }

  /// All images of the symmetry but the identity, about the middle of the shape placed.
  const std::vector<surface::Reflection>& reflections() const { return images_.reflections; }

  /// Takes a shape. Returns false, at no cost, for the one that it has already.
  bool place(const Net& x);

  /// Site i of the shape, and the value there of the field with these Bezier points.
  Vec3 site(int i) const { return value(i, bezier); }
  Vec3 value(int i, const std::vector<double>& of) const { return self_field.value(i, panels, of); }

  /// The panels that site i lies on and that have a rule of their own for it: all but under the rule `desingularised`.
  std::span<SelfPair> own(int i);

  /// Panels that need a near rule for a target; those of `own`, which it lies on, are not among them.
  const std::vector<int>& near(const Vec3& target, std::span<const SelfPair> own);

  /// Far nodes of the fundamental panels and all targets with their images into a tree. Clusters must not depend on who asks for which targets: all
  /// who share the sums give the same.
  void place(TreeSum& tree, std::span<const Vec3> targets) const;

  quadrature::Options options;
  int n_points, n_sites;  ///< control points, and targets on the surfaces
  Panels panels;
  NearField near_field;
  SelfField self_field;
  std::vector<double> bezier;   ///< Bezier points of the shape
  std::vector<double> node[3];  ///< far nodes

 private:
  Net placed_;
  surface::FundamentalElements fundamental_;
  PanelImages images_;
  std::vector<int> near_;
};

}  // namespace tanktread::stokes
