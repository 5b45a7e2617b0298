#pragma once
// Double-layer density on one rigid body: mean motion, integrals of loads, and correction of the collocation error.

#include <array>
#include <memory>

#include <Eigen/Core>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "system/rigid_motion.hpp"

namespace tanktread::coupling {

/// Correction of the collocation error of the velocity u that a single or double layer on a body induces on the body itself, for unit viscosity. It
/// is the control net of u by least-squares projection minus the control net of u by collocation, M^-1 int N_A u dGamma - R^-1 u (M: mass matrix, R:
/// collocation matrix). At its collocation sites, a spline surface of n elements per side lies farther out than between them, by about 1/n^4 radii.
/// The velocity of a double layer and the velocity gradient of a single layer jump across a surface. Therefore the velocity at the sites has a
/// systematic error. Without this correction, the angular velocity of a sphere with a prescribed torque is too small by the fraction 0.035/n^4, and
/// its stresslet in a straining flow has a similar error.
struct SelfCorrection {
  std::array<Net, 6> loads;  ///< corrections of A f for the loads f = e_k and f = e_k x r, k = 0, 1, 2 (r: from the centre of volume)
  Eigen::MatrixXd density;   ///< matrix, shape (3 N, 3 N): maps the density w to the correction of the double layer of w; empty if N > `most_points`

  /// Largest number of control points for which the matrix `density` is stored, which takes 72 bytes per pair of control points. The matrix is stored
  /// in double precision, because GMRES mistakes single-precision rounding for a residual that does not decrease.
  static constexpr int most_points = 2000;

  SelfCorrection(const spline::Space& space, const Net& surface, const quadrature::Options& quadrature);
};

/// A rigid body whose unknown is the density w of (2.23), at rest. Its fields are rigid motions a + b x r, with the position r from the centre of
/// volume, and nets with one row per control point of the body. All vectors are in the axes of the body at rest.
class BodyDensity {
 public:
  /// `x`: net of the body at rest. `rest`: x minus the centre of volume. `like`: an equal body, whose correction is shared; or null.
  BodyDensity(const spline::Space& space, const Net& x, const Net& rest, const quadrature::Options& quadrature, const BodyDensity* like);

  /// Returns whether the bodies have equal shapes and orientations at rest.
  bool alike(const BodyDensity& other) const { return correction_ == other.correction_; }

  RigidMotion mean(const Net& w) const;  ///< returns the rigid motion <w> nearest to w (least squares over the body)
  /// Component k of <w> (velocity, then angular velocity) is a linear function of w. Returns its coefficients, three per row of w.
  Eigen::VectorXd mean_functional(int k) const;

  /// Returns the field whose integrals over the body are this force and torque.
  RigidMotion with_integrals(const Vec3& force, const Vec3& torque) const;
  RigidMotion integrals(const RigidMotion& field) const;  ///< returns the integrals of a field: its force, then its torque
  Mat3 moment(const RigidMotion& field) const;            ///< returns the integral of the field times r

  Net of_load(const RigidMotion& load) const;  ///< returns the correction (SelfCorrection) of the single layer R^-1 A f of the load f = a + b x r
  Net of_density(const Net& w) const;          ///< returns the correction (SelfCorrection) of the double layer R^-1 H w

 private:
  std::shared_ptr<const SelfCorrection> correction_;  // shared by equal bodies
  Eigen::VectorXd weight_;                            // int N_A dGamma
  Net moment_;                                        // int N_A r dGamma
  Eigen::Matrix<double, 6, 6> inertia_;  // entry (j, k): integral of u_j.u_k over the surface, with the velocity field u_k of unit motion k
  Mat3 second_;                          // int r r dGamma
  Vec3 first_;                           // int r dGamma
};

}  // namespace tanktread::coupling
