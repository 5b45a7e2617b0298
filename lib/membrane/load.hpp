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

/// Surface of a particle, for which loads and fields are made. It outlives them.
struct ParticleSurface {
  const spline::Space& space;
  const Net& unstressed;  ///< control net, shape (N, 3), length
  const Net& rest;        ///< of the resting shape
  double radius;          ///< R_C, length
  double modulus;         ///< G_s, or sigma of an interface, force/length
};

/// A field of the snapshots, as control values of shape (N, 1) or (N, 3).
struct SurfaceValues {
  std::string name;
  Eigen::MatrixXd values;
};

/// Linear conditions c.(U, W) = 0 on a rigid motion, one per row.
using RigidConditions = Eigen::Matrix<double, Eigen::Dynamic, 6>;

/// A load with the energy E(x) of the control net x, shape (N, 3), or a force with the virtual work -dE/dx, of no energy that the membrane stores.
/// It is added to the virtual work (3.5) of the membrane. Work and products have the shape (N, 3); work is a force.
///
/// Each is evaluated in two phases: a local one, in which a rank adds what some elements contribute to their control points, and a global one, in
/// which every rank adds the same to all points. Between the phases the caller sums over ranks and over images of a symmetric scene. Nets that the
/// global phase needs complete, such as the gradient of the whole area, are summed too. Uses no MPI.
class Load {
 public:
  virtual ~Load() = default;

  virtual std::size_t n_sums() const { return 0; }  ///< number of nets that are summed in addition to the work

  /// Adds to `work` and `sums`, shape (N, 3) each, what these elements contribute to dE/dx.
  virtual void add_work(const Net& /*x*/, std::span<const int> /*elements*/, Net& /*work*/, std::span<Net> /*sums*/) const {}
  /// Adds to dE/dx what follows from the complete sums.
  virtual void add_global_work(const Net& /*x*/, std::span<const Net> /*sums*/, Net& /*work*/) const {}

  /// Returns whether the membrane stores the energy. A force from outside stores none.
  virtual bool stores() const { return false; }
  /// Returns the energy that the membrane stores at x; `sums` are complete. Force x length.
  virtual double energy(const Net& /*x*/, std::span<const Net> /*sums*/) const { return 0; }

  /// Keeps what the products below need at x. Implicit schemes call it once per tangent.
  virtual void linearise(const Net& /*x*/, std::span<const int> /*elements*/, std::span<const Net> /*sums*/) {}
  /// Adds to `change` what the elements of linearise() contribute to (d2E/dx2) dx. A part that is not stiff may be left out.
  virtual void add_tangent(const Net& /*dx*/, Net& /*change*/) const {}
  virtual void add_global_tangent(const Net& /*dx*/, Net& /*change*/) const {}

  /// Returns whether the load of an image is the image of the load. If not, a scene is not reduced by this image.
  virtual bool admits(const surface::Image&) const { return false; }

  /// Returns the conditions, without unit, under which the load moves with a particle that moves rigidly by U + W x r: none for a load that depends
  /// on the shape only, W x f = 0 for a force of fixed direction f. Searches for steady shapes need them.
  virtual RigidConditions rigid_conditions() const { return RigidConditions::Identity(6, 6); }

  /// Returns whether the load depends on which material points are where on the surface.
  virtual bool depends_on_labels() const { return true; }

  /// Returns the values of the columns with which the load is registered, and what snapshots show of it, at x.
  virtual std::vector<double> values(const Net& /*x*/) const { return {}; }
  virtual std::vector<SurfaceValues> snapshot(const Net& /*x*/) const { return {}; }
};

using LoadParts = deck::Parts<std::unique_ptr<Load>(const ParticleSurface&)>;

/// Returns the conditions W x f = 0; none if f is 0.
inline RigidConditions fixed_direction(const Vec3& f) {
  if (f.norm() == 0) return RigidConditions(0, 6);
  const Vec3 d = f.normalized();
  RigidConditions rows = RigidConditions::Zero(3, 6);
  rows.rightCols<3>() << 0, d[2], -d[1], -d[2], 0, d[0], d[1], -d[0], 0;
  return rows;
}

}  // namespace tanktread::membrane
