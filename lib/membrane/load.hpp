#pragma once
// Interface of loads: terms of the virtual work on the surface of one particle, in addition to elasticity and bending.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/types.hpp"
#include "deck/parts.hpp"
#include "spline/space.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::membrane {

/// Surface of a particle, from which loads and fields are created. The surface must outlive the loads and fields.
struct ParticleSurface {
  const spline::Space& space;
  const Net& unstressed;  ///< control net of the unstressed surface, shape (N, 3), length
  const Net& rest;        ///< control net of the resting shape
  double radius;          ///< R_C, length
  double modulus;         ///< shear modulus G_s, or tension sigma of an interface, force/length
};

/// A quantity on the surface that is written to snapshots, as control values of shape (N, 1) or (N, 3).
struct SurfaceValues {
  std::string name;
  Eigen::MatrixXd values;
};

/// Linear conditions c.(U, W) = 0 on a rigid motion with velocity U and angular velocity W, one condition c per row.
using RigidConditions = Eigen::Matrix<double, Eigen::Dynamic, 6>;

/// Load on the membrane, added to the virtual work (3.5) of the membrane. A load is given by dE/dx, where x is the control net. Either E(x) is an
/// energy that the membrane stores, or -dE/dx is the virtual work of an external force. x, dE/dx (a force) and the product (d2E/dx2) dx have the
/// shape (N, 3).
///
/// dE/dx and the product (d2E/dx2) dx are evaluated in two phases. In the local phase, each rank adds the contributions of its elements to their
/// control points (add_work(), add_tangent()). Elements of different ranks overlap: row A of the result is complete on the rank that owns control
/// point A, which evaluates all elements that touch A, and the caller copies complete rows to all ranks and to symmetric images. Row A must therefore
/// come from elements that touch A only. In the global phase, every rank adds the same terms to all points (add_global_work(), add_global_tangent()).
/// A number of the whole surface is formed there, from further nets that the local phase fills under the same rule, for example the gradient of the
/// total area (WholeMembrane). Uses no MPI.
class Load {
 public:
  virtual ~Load() = default;

  /// Returns the number of further nets that the caller completes, in addition to `work`. In symmetric scenes, the caller completes each row as a
  /// vector, by reflection. A scalar per control point, such as int N_A dGamma, must instead be computed from all elements in the global phase.
  virtual std::size_t n_sums() const { return 0; }

  /// Adds the contributions of these elements to dE/dx (`work`), and to the nets `sums`, which add_global_work() receives summed over all elements.
  /// Each net has the shape (N, 3).
  virtual void add_work(const Net& /*x*/, std::span<const int> /*elements*/, Net& /*work*/, std::span<Net> /*sums*/) const {}
  /// Adds to `work` the terms of dE/dx that depend on `sums`, the nets of add_work() summed over all elements. Every rank adds the same terms.
  virtual void add_global_work(const Net& /*x*/, std::span<const Net> /*sums*/, Net& /*work*/) const {}

  /// Returns whether the membrane stores the energy. An external force stores none.
  virtual bool stores() const { return false; }
  /// Returns the energy that the membrane stores at x, force x length. `sums`: the nets of add_work(), summed over all elements.
  virtual double energy(const Net& /*x*/, std::span<const Net> /*sums*/) const { return 0; }

  /// Stores the data at the shape x that add_tangent() and add_global_tangent() need. Implicit schemes call it once per tangent.
  virtual void linearise(const Net& /*x*/, std::span<const int> /*elements*/, std::span<const Net> /*sums*/) {}
  /// Adds the product (d2E/dx2) dx to `change`, for the elements given to linearise(). Terms that are not stiff may be left out.
  /// The matrix of an external force need not be symmetric.
  virtual void add_tangent(const Net& /*dx*/, Net& /*change*/) const {}
  virtual void add_global_tangent(const Net& /*dx*/, Net& /*change*/) const {}

  /// Returns whether the load is symmetric under this image. If not, this symmetry is not used to reduce the number of unknowns. The image of a force
  /// is Reflection::of_vector, the image of a torque Reflection::of_axial.
  virtual bool admits(const surface::Image&) const { return false; }

  /// Returns the dimensionless conditions that a rigid motion U + W x r must satisfy so that the load moves with the particle. The search for steady
  /// shapes permits all motions that satisfy them. A load that depends only on the shape has no condition. If the load is a force of fixed direction
  /// f, the condition is W x f = 0. A load with a condition on a translation U depends on the position of the particle: it is refused on a lattice
  /// whose periods do not meet the condition, and with `Particle/drift` `held`.
  virtual RigidConditions rigid_conditions() const { return RigidConditions::Identity(6, 6); }

  /// Returns whether the load changes if material points slide along the surface at constant shape.
  virtual bool depends_on_labels() const { return true; }

  /// Returns, at the shape x, the values of the columns of the time series that are registered with the load. snapshot() returns the quantities that
  /// the load writes to snapshots.
  virtual std::vector<double> values(const Net& /*x*/) const { return {}; }
  virtual std::vector<SurfaceValues> snapshot(const Net& /*x*/) const { return {}; }
};

using LoadParts = deck::Parts<std::unique_ptr<Load>(const ParticleSurface&)>;

/// Returns all conditions of `parts`.
inline RigidConditions stacked(std::span<const RigidConditions> parts) {
  RigidConditions all(0, 6);
  for (const RigidConditions& part : parts) {
    all.conservativeResize(all.rows() + part.rows(), 6);
    all.bottomRows(part.rows()) = part;
  }
  return all;
}

/// Returns the conditions W x f = 0 on the angular velocity W of a rigid motion, for a force or torque with the fixed direction f. If f = 0, there
/// are no conditions.
inline RigidConditions fixed_direction(const Vec3& f) {
  if (f.norm() == 0) return RigidConditions(0, 6);
  const Vec3 d = f.normalized();
  RigidConditions rows = RigidConditions::Zero(3, 6);
  rows.rightCols<3>() << 0, d[2], -d[1], -d[2], 0, d[0], d[1], -d[0], 0;
  return rows;
}

}  // namespace tanktread::membrane
