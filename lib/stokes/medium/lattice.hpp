#pragma once
// Medium of a layer whose surfaces repeat on a lattice.

#include <array>
#include <optional>
#include <vector>

#include "stokes/medium/layer_medium.hpp"
#include "stokes/medium/periodic_sum.hpp"

namespace tanktread::stokes {

/// Options for the periodic images of the surfaces on a lattice.
struct Repetition {
  bool assembled = false;  ///< whether assembled rows include images, see Layer::assemble()
  std::array<Vec3, 2> target_range{Vec3::Constant(1e300), Vec3::Constant(-1e300)};  ///< lowest and highest lattice coordinates of targets off
                                                                                    ///< the surfaces

  bool operator==(const Repetition& other) const = default;
};

/// Images of the surfaces on a lattice of one, two or three periods, with the kernels of PeriodicKernel. The near images are displaced images; the
/// sum over all others is interpolated (PeriodicSum).
class Lattice : public LayerMedium {
 public:
  Lattice(const PeriodicCell& cell, const Repetition& how) : cell_(cell), how_(how), near_(cell.around({2, 2, 2})) {}

  /// Returns whether Lattice(cell, how) would be equal to this lattice.
  bool is(const PeriodicCell& cell, const Repetition& how) const { return cell_ == cell && how_ == how; }

  void set_sources(const LayerSources& sources) override;
  const std::vector<Vec3>& node_shifts() const override { return sum_->images(); }
  const std::vector<Vec3>& panel_shifts() const override { return near_; }
  bool wraps() const override { return true; }
  Vec3 wrapped(const Vec3& x) const override { return sum_->wrapped(x); }
  const NodeVectors& nodes(const LayerSources& /*sources*/) const override { return node_; }
  bool rows_include_images() const override { return how_.assembled; }
  void add(LayerSources& sources, const LayerTargets& targets, Net& u) override;
  /// Returns false: rows contain displaced images, and the remainder is added to all rows together by add_remainder().
  bool add_row(LayerSources& /*sources*/, const Vec3& /*x0*/, std::vector<Mat3>& /*block*/) override { return false; }
  void add_remainder(const LayerSources& sources, std::span<const int> sites, Rows<double>& a) const override;

 private:
  void subtract_surfaces(LayerSources& sources, const LayerTargets& targets, Net& u) const;
  void add_remainder(LayerSources& sources, const LayerTargets& targets, Net& u);
  void add_remainder_site_by_site(const LayerSources& sources, const std::vector<Vec3>& at, const std::vector<Vec3>& nodes, Rows<double>& a) const;
  void set_remainder_targets(LayerSources& sources, const std::vector<Vec3>& at);
  void add_regularised_stresslets(LayerSources& sources, const LayerTargets& targets, const std::vector<Vec3>& at, Net& sums);
  using Moments = LayerSources::StressletMoments;
  void add_stresslets(const LayerSources& sources, const Moments& moments, const std::vector<Vec3>& at, Net& sums);
  Vec3 pressure_along(const LayerSources& sources, const Moments& moments) const;

  PeriodicCell cell_;
  Repetition how_;
  std::optional<PeriodicSum> sum_;
  NodeVectors node_;                    // far nodes, wrapped into the cell
  std::vector<Vec3> near_;              // lattice vectors of images whose panels may be close to a target
  std::vector<Vec3> remainder_at_;      // targets at which remainder_stress_ was computed, wrapped into the cell
  std::vector<Mat3> remainder_stress_;  // at the targets remainder_at_: double layer of all images except the near ones; column c for the constant
                                        // density e_c
};

}  // namespace tanktread::stokes
