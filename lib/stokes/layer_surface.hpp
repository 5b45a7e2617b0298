#pragma once

#include <span>
#include <vector>

#include "base/threads.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/sums/near_field.hpp"
#include "stokes/sums/panels.hpp"
#include "stokes/sums/self_field.hpp"
#include "stokes/sums/tree_sum.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::stokes {

/// Number of lattice images of a node, including the node itself, that a layer on a lattice sums directly or by clusters.
constexpr int lattice_images = 27;

/// Returns whether option `far sum` selects clusters (TreeSum) for this space rather than direct summation. `images`: number of lattice images of
/// each node, including the node itself.
bool sums_by_tree(const spline::Space& space, const quadrature::Options& options, int images = 1);
bool sums_by_tree(double nodes, const quadrature::Options& options);

/// Current surfaces, prepared for the integration of a layer: panels, far nodes, and the quadrature rule for each pair of a target and a panel.
class LayerSurface {
 public:
  /// `sites`: targets on the surfaces; if empty, all targets are off the surfaces. `steep`: true for a double layer, whose integrand grows like 1/r^2
  /// with the distance r from targets on other surfaces; false for a single layer (1/r).
  LayerSurface(const spline::Space& space, const Sites& sites, const quadrature::Options& options, bool steep);

  /// Includes images of the surfaces, on a lattice or in a wall, in the choice of near-singular rules.
  void repeat();

  /// Sets the symmetry that all later shapes have.
  void set_symmetry(const surface::Symmetry& symmetry);

  /// Returns the fundamental panels (one panel of each orbit under the symmetry), and their weights in a far sum over the fundamental panels only.
  const surface::FundamentalElements& fundamental() const { return fundamental_; }

  /// Returns the reflections of all symmetry images except the identity. The reflections are about the centre of the current shape.
  const std::vector<surface::Reflection>& reflections() const { return images_.reflections; }

  /// Sets the control net x of the surface. If it is the current net, does nothing and returns false; otherwise returns true.
  bool set_shape(const Net& x);

  Vec3 site(int i) const { return value(i, bezier); }  ///< returns the position of site i
  /// Returns the value at site i of the field with the Bezier points `of`.
  Vec3 value(int i, const std::vector<double>& of) const { return self_field.value(i, panels, of); }

  /// Returns the pairs of site i and a panel that contains it, one pair per panel. These pairs need singular rules. The list is empty if
  /// has_singular_rules is false.
  std::span<SelfPair> self_pairs(int i);

  /// Calls use(some, first) for parts of `sites` while their pairs have singular rules, see SelfField::with_rules().
  template <class Use>
  void with_rules(std::span<const int> sites, std::size_t multiple, const Use& use) {
    self_field.with_rules(sites, multiple, panels, bezier, use);
  }

  /// Returns the panels that need near-singular quadrature for a target, without the panels of `self_pairs`, which contain the target. The list is
  /// empty if corrects_near is false; then `near_field` has no shape, and NearField::rule must not be called.
  /// Several threads may call it; the result is valid until the next call by the same thread.
  const std::vector<int>& near(const Vec3& target, std::span<const SelfPair> self_pairs) const;

  /// Sets the sources of `tree` to the far nodes of the fundamental panels, and its targets to all targets and their symmetry images. All ranks that
  /// share the sums must pass equal targets, so that clusters do not depend on which rank computes which rows.
  void set_sources_of(TreeSum& tree, std::span<const Vec3> targets) const;

  quadrature::Options options;
  int n_points, n_sites;  ///< numbers of control points (n_points) and of targets on the surfaces (n_sites)
  Panels panels;
  NearField near_field;
  SelfField self_field;
  std::vector<double> bezier;   ///< Bezier points of the shape
  std::vector<double> node[3];  ///< far nodes

 private:
  Net placed_;
  surface::FundamentalElements fundamental_;
  PanelImages images_;
  mutable PerThread<std::vector<int>> near_;
};

}  // namespace tanktread::stokes
