#pragma once
// The single and double layers of all particles at the targets.

#include <span>

#include "system/capsule_parameters.hpp"
#include "system/parallel/row_share.hpp"
#include "system/targets/layer_pair.hpp"
#include "system/targets/targets.hpp"

namespace tanktread::coupling {

/// The single layer A and the double layer D of (4.2) of all particles at the targets. D includes the factor of each particle: 1 - lambda, or -1 or 0
/// for a rigid body (see viscosity_contrast). The layers include the periodic images of the particles and their images in a plane wall. Results are
/// equal on all ranks; calls are collective.
class ParticleLayers {
 public:
  /// References, except `unstressed`, must outlive this object.
  ParticleLayers(const spline::Space& space, const Net& unstressed, const CapsuleParameters& parameters, const RowShare& layout,
                 const Targets& targets, Phases& phases);

  void repeat(const stokes::PeriodicCell& cell);  ///< sets the cell whose periodic images the layers include
  bool repeats() const { return repeats_; }

  stokes::Layer& single_layer() { return pair_.single_layer; }
  stokes::Layer* double_layer() { return pair_.double_layer ? &*pair_.double_layer : nullptr; }  ///< double layer; null if all its factors vanish
  const stokes::Layer& single_layer() const { return pair_.single_layer; }
  bool has_double() const { return pair_.double_layer.has_value(); }

  /// Assembles the rows of the layers on the surface x for apply() if the options ask for it. `single`: whether apply() will need A. `few`: whether
  /// only a few products are needed, for which assembly does not pay off.
  void assemble(const Net& x, bool single, bool few);

  void discard_rows() { single_rows_.resize(0, 0), double_rows_.resize(0, 0); }  ///< required before another surface than that of assemble()

  /// Returns D v - (1/mu) A f, with the double layer D and the single layer A on the surface x, by the rows that assemble() has made, if any. An
  /// empty v or f is treated as zero.
  Net apply(const Net& x, const Net& v, const Net& f);

  /// Returns the rows of D at these collocation sites on every rank, for the surface that assemble() set. The owner of a site computes its rows.
  stokes::Rows<double> double_rows(std::span<const int> sites);

  stokes::Evaluations evaluations() const { return pair_.evaluations(); }  ///< kernel evaluations of this rank

 private:
  Net apply_single(const Net& x, const Net& f);
  Net apply_double(const Net& x, const Net& v);
  Net product(const stokes::Rows<double>& rows, const Net& field) const;

  const CapsuleParameters& parameters_;
  const RowShare& layout_;
  const Targets& targets_;
  Phases& phases_;
  bool repeats_ = false;
  LayerPair pair_;
  stokes::Rows<double> single_rows_, double_rows_;  // rank-owned rows of the layers; empty if they are not assembled
};

}  // namespace tanktread::coupling
