#pragma once
// Which panels a target is too close to for their far rule, and what rule they need.

#include <map>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "quadrature/ellipse.hpp"
#include "quadrature/graded.hpp"
#include "stokes/kernels/point_table.hpp"
#include "stokes/sums/panels.hpp"
#include "stokes/sums/self_field.hpp"
#include "stokes/sums/vicinity.hpp"

namespace tanktread::stokes {

/// Near rules by tolerance. A pure function of the present shape: no memory of earlier ones.
class NearField {
 public:
  /// `tolerance`: accuracy relative to int dG / r over the closed surface that a panel belongs to, about sqrt(4 pi area), however many others there
  /// are. `steep`: the integrand grows like 1 / r^2 rather than 1 / r at targets that are not on the closed surface of the panel; on it the density
  /// less its value at the target takes one order away (double layer). `off_surface`: there are targets on no surface.
  NearField(const Panels& panels, double tolerance, int smooth_order, bool steep, bool off_surface);

  /// Takes the shape from the Bezier points of panels that are no images. They must outlive the calls below, which ask for those of `panel`, too.
  void update(const std::vector<double>& bezier, const PanelImages& images);

  /// States that targets see images of the panels too, as if they were on other surfaces. Before update().
  void repeat() { across_gaps_ = true; }

  /// Which of the surfaces a panel belongs to, and how many there are.
  int surface(int panel) const { return surface_[static_cast<std::size_t>(panel)]; }
  int n_surfaces() const { return n_surfaces_; }

  /// Panels whose far rule misses the tolerance at the target, ascending, but for those of `own`, which the target lies on.
  void list(const Vec3& target, std::span<const SelfPair> own, std::vector<int>& near);

  /// The rule for one of them, with the same `own`, as a table that stays valid until the next call.
  const PointTable& rule(int panel, const Vec3& target, std::span<const SelfPair> own);

 private:
  struct View {
    quadrature::Patch flat;
    Vec3 normal;  ///< of the flat picture
    double area = 0, bulge = 0, radius = 0;
    quadrature::Demand demand, across;  ///< of targets on the surface of the panel, and of those off it
  };
  void view(int e);
  bool on_same_surface(int e, std::span<const SelfPair> own) const;
  static quadrature::Sight sight(const View& view, const Vec3& target, bool across);
  bool far_enough(int e, const Vec3& target, std::span<const SelfPair> own) const;

  const Panels& panels_;
  quadrature::Demand demand_;  ///< but for what goes with the area
  std::vector<int> surface_;   ///< of each panel: which of the surfaces it belongs to
  int n_surfaces_ = 1;
  bool steep_, across_gaps_;
  int largest_order_;
  const std::vector<double>* bezier_ = nullptr;
  std::vector<View> views_;
  std::vector<double> centre_[3], reach_;  ///< squared distance from the centre beyond which the far rule is enough
  Vicinity vicinity_;
  std::vector<int> suspects_;
  std::map<std::pair<int, int>, PointTable> whole_;  ///< (degree, order) -> tensor Gauss on the whole panel
  PointTable parts_;
  quadrature::Rule points_;
};

}  // namespace tanktread::stokes
