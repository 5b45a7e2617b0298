#pragma once
// Medium of a layer in front of a plane wall.

#include <vector>

#include "stokes/medium/image_sum.hpp"
#include "stokes/medium/layer_medium.hpp"

namespace tanktread::stokes {

/// Images of the surfaces in a plane wall, so that the kernels become (2.35) and (2.36), which vanish on the wall. The image of a panel acts at a
/// target like the panel with another kernel at the mirrored target: far sums by ImageSum, and near-singular quadrature on panels that are close to
/// the mirrored target. All surfaces must be in front of the wall.
class WallImages : public LayerMedium {
 public:
  /// `by_clusters`: whether the far sum is evaluated by clusters.
  WallImages(const PlaneWall& wall, const LayerSources& sources, bool by_clusters);

  void set_sources(const LayerSources& sources) override { sum_.set_sources(sources.surface.node); }
  void share(int part, int parts) override { sum_.share(part, parts); }
  bool shares_sums() const override { return true; }
  void add(LayerSources& sources, const LayerTargets& targets, Net& u) override;
  bool add_row(LayerSources& sources, const Vec3& x0, std::vector<Mat3>& block) override;
  bool any_thread() const override { return true; }

 private:
  void add_far(LayerSources& sources, const LayerTargets& targets, Net& u);
  void compute_image_stress(LayerSources& sources);
  Vec3 beyond_far_sum(LayerSources& sources, int e, const PointTable& table, const Vec3& mirrored, const Vec3& at, const Vec3& f0) const;
  void panel_moments(LayerSources& sources, int e, const Vec3& at, std::vector<Mat3>& moments);

  ImageSum sum_;
  std::vector<Mat3> image_stress_;  // for each target, far sum of the double layer of the images; column c for the constant density e_c
  PerThread<std::vector<Pack>> scratch_;
};

}  // namespace tanktread::stokes
