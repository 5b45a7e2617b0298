#pragma once
// Selects the panels on which a target needs a near-singular quadrature rule, and selects this rule.

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "base/threads.hpp"
#include "base/types.hpp"
#include "quadrature/ellipse.hpp"
#include "quadrature/graded.hpp"
#include "stokes/kernels/point_table.hpp"
#include "stokes/sums/panels.hpp"
#include "stokes/sums/self_field.hpp"
#include "stokes/sums/vicinity.hpp"

namespace tanktread::stokes {

/// Selects near-singular quadrature rules that reach a tolerance. The rules depend on the current shape only, not on earlier shapes. Several threads
/// may call list() and rule().
class NearField {
 public:
  /// `tolerance`: permitted error divided by the integral of 1/r over the closed surface that contains the panel, with r the distance from the
  /// target. This integral is estimated as sqrt(4 pi A), where A is the area of the surface. `smooth_order`: see quadrature::Demand. `steep`: true
  /// for the double layer. The integrand of the double layer grows like 1 / r^2 at targets that are not on the closed surface of the panel. At
  /// targets on this surface it grows like 1 / r, because the density at the target is subtracted. `off_surface`: true if there are targets that are
  /// not on any surface.
  NearField(const Panels& panels, double tolerance, int smooth_order, bool steep, bool off_surface);

  /// Sets the shape from the Bezier points of the panels that are not symmetry images. The array must remain valid during later calls of list() and
  /// rule(). If a panel is an image, rule() also needs the Bezier points of this panel.
  void update(const std::vector<double>& bezier, const PanelImages& images);

  /// Includes images of the panels, on a lattice or in a wall. An image of a panel is treated as part of a different surface. Must be called before
  /// update().
  bool repeat() { return !std::exchange(across_gaps_, true); }

  /// Returns the index of the closed surface that contains a panel.
  int surface(int panel) const { return surface_[static_cast<std::size_t>(panel)]; }
  int n_surfaces() const { return n_surfaces_; }  ///< number of closed surfaces

  /// Lists the panels whose far rule does not reach the tolerance at the target, in ascending order, except the panels of `self_pairs`, which contain
  /// the target.
  void list(const Vec3& target, std::span<const SelfPair> self_pairs, std::vector<int>& near) const;

  /// Returns the rule for a panel that list() found for this target with the same `self_pairs`. The table is valid until the next call
  /// by the same thread.
  const PointTable& rule(int panel, const Vec3& target, std::span<const SelfPair> self_pairs) const;

 private:
  struct View {
    quadrature::Patch flat;
    Vec3 normal;  ///< normal of the planar approximation
    double area = 0, bulge = 0, radius = 0;
    quadrature::Demand demand, across;  ///< demand: accuracy required for targets on the closed surface of the panel. across: accuracy required for
                                        ///< all other targets
  };
  void view(int e);
  bool on_same_surface(int e, std::span<const SelfPair> self_pairs) const;
  static quadrature::Sight sight(const View& view, const Vec3& target, bool across);
  bool far_enough(int e, const Vec3& target, std::span<const SelfPair> self_pairs) const;

  const Panels& panels_;
  quadrature::Demand demand_;  ///< required accuracy. Its members that depend on the surface area are 0; update() sets them in the copies in `views_`
  std::vector<int> surface_;   ///< for each panel, the index of the surface that contains it
  int n_surfaces_ = 1;
  bool steep_, across_gaps_;
  int largest_order_;
  const std::vector<double>* bezier_ = nullptr;
  std::vector<View> views_;
  std::vector<double> centre_[3], reach_;  ///< centre_: centre of each panel. reach_: squared distance from the centre beyond which the far rule
                                           ///< reaches the tolerance
  Vicinity vicinity_;
  std::map<std::pair<int, int>, PointTable> whole_;  ///< tensor Gauss rules on the whole panel, by (degree, order)
  struct Scratch {
    std::vector<int> suspects;
    quadrature::Rule points;
    PointTable parts;
  };
  mutable PerThread<Scratch> scratch_;
};

}  // namespace tanktread::stokes
