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

namespace tanktread::stokes {

/// Whether `far sum` of the options means clusters for this space (TreeSum) or every target against every node.
bool sums_by_tree(const spline::Space& space, const quadrature::Options& options);

/// The present surface as a layer operator integrates over it: panels, far nodes, and which rule each target needs on which panel.
class LayerSurface {
 public:
  /// `steep`: near rules for a kernel like 1 / r^2. `order`: Gauss points a direction of the far rule; 0: what targets on the surface need.
  LayerSurface(const spline::Space& space, const quadrature::Options& options, bool steep = false, int order = 0);

  /// Takes a shape; the one that it has already, at no cost.
  void place(const Net& x);

  /// The same without far nodes: those of panel e are there after locate(e).
  void place_lazily(const Net& x);
  void locate(int e);

  /// Collocation points of the shape.
  void collocation_points(std::span<const int> targets, std::vector<Vec3>& at) const;

  /// Far nodes of some panels, panel by panel, and all collocation points into a tree: clusters must not depend on who asks for which targets.
  void place(TreeSum& tree, std::span<const int> some) const;

  /// Those of all panels.
  void place(TreeSum& tree) const;

  /// The panels that collocation point i lies on and that have a rule of their own for it: all but under the rule `desingularised`.
  std::span<SelfPair> own(int i) { return options.rule == "desingularised" ? std::span<SelfPair>() : self_field[i]; }

  /// Panels that need a near rule for the collocation point i at x0; those that it lies on are not among them.
  const std::vector<int>& near(int i, const Vec3& x0);
  /// The same for a point off the surface.
  const std::vector<int>& near(const Vec3& x0);

  quadrature::Options options;
  int n_points;
  Panels panels;
  NearField near_field;
  SelfField self_field;
  std::vector<double> bezier;   ///< Bezier points of the shape
  std::vector<double> node[3];  ///< far nodes

 private:
  Net placed_;
  std::vector<char> located_;  // panels whose far nodes are there
  std::vector<int> near_;
};

}  // namespace tanktread::stokes
