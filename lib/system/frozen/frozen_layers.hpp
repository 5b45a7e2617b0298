#pragma once
// Single and double layer of all particles in the Jacobian, kept from an earlier shape (frozen).

#include <optional>
#include <span>
#include <vector>

#include "membrane/mass.hpp"
#include "system/targets/particle_layers.hpp"
#include "system/frozen/frozen_operator.hpp"
#include "system/frozen/nodal_operator.hpp"

namespace tanktread::coupling {

/// Approximates a layer operator A at a shape x, given A at an earlier shape x0, if x is x0 rotated and slightly deformed. With the rotation Q_p that
/// best maps the control points of particle p from x0 to x (least squares; Kabsch 1976),
///
///   (A f)_p ~ Q_p sum_q A_pq Q_q^T f_q                                                                                            (4.29)
///
/// This is exact if all particles rotate together. If a membrane tank-treads, its control points are convected while the shape is steady, and the
/// operator changes only by this rotation.
class Corotation {
 public:
  Corotation() = default;

  /// Computes, for each particle, the rotation that maps its rows of `from` best to its rows of `to`. Both are control nets of shape (N, 3).
  Corotation(std::span<const Particle> particles, const Net& from, const Net& to);

  Net back(const Net& f) const;    ///< returns Q^T f
  Net forth(const Net& f) const;  ///< returns Q f

  /// Returns the displacement `to` - `from` minus the best-fitting rigid motion of each particle.
  static Net deformation(std::span<const Particle> particles, const Net& from, const Net& to);

 private:
  Net rotated(Net f, bool back) const;

  std::vector<spline::Block> blocks_;
  std::vector<Mat3> rotations_;
};

/// The single layer A and the double layer D of (4.2) at the collocation sites, assembled at one shape and used at later shapes with the rotations
/// (4.29) of the particles. A is a NodalOperator or a FrozenOperator, as selected by the option `frozen_operator`; D is a FrozenOperator. Images on a
/// lattice are omitted, and NodalOperator also omits images in a plane wall. A tube has frozen operators of its own (Tube::freeze, called by
/// Capsule::freeze); further operators of this kind are added to Capsule::freeze and CapsuleJacobian::product. Calls are collective.
class FrozenLayers {
 public:
  /// `layers`: the layers at `targets`. If `targets` are the collocation sites, this object assembles `layers`. Otherwise it creates and assembles
  /// other layers, at the collocation sites. `mass`: mass matrix of all particles. References must outlive this object.
  FrozenLayers(const spline::Space& space, const Net& unstressed, const CapsuleParameters& parameters, const RowShare& layout, const Targets& targets,
               const membrane::MassMatrix& mass, ParticleLayers& layers);

  /// Assembles the layers at the shape `at`. `x`: equal to `at`; if there is a lattice, `at` with each particle moved by a lattice vector into the
  /// cell.
  void assemble(const Net& at, const Net& x);

  /// Computes the rotations of the particles from the assembled shape to x, if the layers are assembled.
  void turn_to(const Net& x);

  Net single_layer(const Net& f);        ///< returns A f
  Net double_layer(const Net& v) const;  ///< returns D v

  Eigen::Index n_points() const { return unstressed_.rows(); }
  bool has_double() const { return layers_.has_double(); }
  bool empty() const { return at_.size() == 0; }  ///< true until the first call of assemble()
  double bytes() const;                     ///< memory in bytes, over all ranks, of the layers whose size grows like N^2
  stokes::Evaluations evaluations() const;  ///< kernel evaluations of the layers that this object has created

 private:
  bool nodal() const;

  const Net& unstressed_;
  const CapsuleParameters& parameters_;
  const RowShare& layout_;
  const Targets& targets_;
  const membrane::MassMatrix& mass_;
  ParticleLayers& layers_;
  std::optional<LayerPair> at_sites_;  // layers at the collocation sites; not set if the targets are these sites
  NodalOperator nodal_;                // single layer A; the option `frozen_operator` selects either nodal_ or single_
  FrozenOperator single_, double_;
  Net at_;                 // shape at which the layers were assembled
  Corotation corotation_;  // rotations of the particles from `at_` to the shape passed to turn_to()
};

}  // namespace tanktread::coupling
