#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/near_field.hpp"
#include "stokes/panels.hpp"
#include "stokes/self_field.hpp"
#include "stokes/tree_sum.hpp"
#include "surface/fundamental.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::stokes {

/// Whether `far sum` of the options means clusters for this space (TreeSum) or every target against every node.
bool sums_by_tree(const spline::Space& space, const quadrature::Options& options);

/// The present surface as a layer operator integrates over it: panels, far nodes, and which rule each target needs on which panel.
class LayerSurface {
 public:
  /// `steep`: where near rules are for an integrand like 1 / r^2. `order`: Gauss points a direction of the far rule; 0: what targets on the
  /// surface need.
  LayerSurface(const spline::Space& space, const quadrature::Options& options, Steep steep = Steep::nowhere, int order = 0);

  /// States that all shapes to come are of this symmetry.
  void set_symmetry(const surface::Symmetry& symmetry);

  /// Panels in a far sum over fundamental ones, and their weights there.
  const surface::FundamentalElements& fundamental() const { return fundamental_; }

  /// All images of the symmetry but the identity, about the middle of the shape placed.
  const std::vector<surface::Reflection>& reflections() const { return images_.reflections; }

  /// Takes a shape; the one that it has already, at no cost.
  void place(const Net& x);

  /// The same without Bezier points and far nodes: those of panel e are there after locate(e). Functions that name panels see to their Bezier points.
  void place_lazily(const Net& x);
  void locate(int e);

  /// Collocation points of the shape.
  void collocation_points(std::span<const int> targets, std::vector<Vec3>& at);

  /// Far nodes of some panels, panel by panel, and some collocation points with all their images into a tree. Clusters must not depend on who asks
  /// for which targets: all who share the sums give the same.
  void place(TreeSum& tree, std::span<const int> some, std::span<const int> points);

  /// Those of all panels, and all collocation points (and images, where there is a symmetry).
  void place(TreeSum& tree);

  /// The panels that collocation point i lies on and that have a rule of their own for it: all but under the rule `desingularised`.
  std::span<SelfPair> own(int i);

  /// Panels that need a near rule for the collocation point i at x0; those that it lies on are not among them.
  const std::vector<int>& near(int i, const Vec3& x0);
  /// The same for a point off the surface.
  const std::vector<int>& near(const Vec3& x0);

  quadrature::Options options;
  int n_points;
  Panels panels;
  NearField near_field;
  SelfField self_field;
  std::vector<double> bezier;   ///< Bezier points of the shape, where they are there
  std::vector<double> node[3];  ///< far nodes

 private:
  void shape(int e);

  Net placed_;
  surface::FundamentalElements fundamental_;
  PanelImages images_;
  std::vector<char> shaped_, located_;  // panels whose Bezier points, and far nodes, are there
  std::vector<int> near_;
};

}  // namespace tanktread::stokes
