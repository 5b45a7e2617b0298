#pragma once
// Velocity that plates and posts add to the flow around the particles between them. The force of these solids on the fluid is eliminated.

#include <memory>
#include <optional>
#include <vector>

#include "base/types.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "stokes/medium/plane_wall.hpp"
#include "system/solids/plates/plates_and_posts.hpp"
#include "system/targets/layer_pair.hpp"

namespace tanktread::coupling {

/// Surroundings of the particles in a lattice with solids.
struct SolidScene {
  std::shared_ptr<PlatesAndPosts> solids;
  std::vector<stokes::PlaneWall> planes;  ///< the plates among the solids, with normals into the fluid
  Vec3 driving_gradient = Vec3::Zero();   ///< gradient of the mean pressure that drives the fluid, at the amplitude 1 of the flow, force/length^3.
                                          ///< Between plates, the ambient velocity v_inf already includes its effect
  quadrature::Options quadrature;
};

/// Returns the solution of (2.46) without particles, in the ambient flow v_inf. Collective.
PlatesAndPosts::Flow without_particles(const SolidScene& scene, const stokes::AmbientFlow& flow);

/// Returns the integral over the cell (2.49) of the velocity due to the solids only. `flow`: solution of (2.46).
Vec3 solids_flow_integral(const SolidScene& scene, const PlatesAndPosts::Flow& flow);

/// Velocity u that solids (with the surface S) add to the ambient flow v_inf and to the layers of the particles (with the surface C):
///
///   u = (1/mu) G_S f + U,   u = V - v_inf + (1/mu) G_C df - (1/8 pi) int_C (1 - lambda) T v n dGamma on the solids        (2.47)
///
/// V is the prescribed velocity of the solids, which changes in time like the flow; df and v are load and velocity of the particles. f and U are the
/// solution of (2.46) for the force F = V_c g + int df dGamma, where V_c is the volume of the cell and g the mean pressure gradient. With this F, the
/// total force on the fluid in one cell balances the pressure gradient g. The layers of the particles include all images. `empty` returns the
/// solution without particles, and `respond` the part of the solution that is linear in df and v. Nets of particles are replicated on all ranks. All
/// calls except queries are collective.
class SolidResponse {
 public:
  /// `space`: common space of all particles. `unstressed`: their unstressed net. `flow`: ambient flow. `space` and `flow` must outlive this object.
  SolidResponse(const SolidScene& scene, const spline::Space& space, const Net& unstressed, std::span<const Particle> particles,
                const stokes::AmbientFlow& flow);

  /// Sets the particles' control net; later calls use this shape. `at`: points on the particles at which `velocities` are needed. `own`: the rows
  /// that this rank computes.
  void set_shape(const Net& x, const Net& at, std::span<const int> own);
  void forget() { shape_ = {}; }  ///< requires set_shape() before the next response, also if the shape does not change

  /// Returns the solution without particles.
  const PlatesAndPosts::Flow& empty();

  /// Returns the part of the solution of (2.46) due to the load f and the velocity v of the particles. An empty net counts as zero.
  PlatesAndPosts::Flow respond(const Net& f, const Net& v);

  /// Computes the rows `own` of the velocity u at the points `at` that were passed to `set_shape`. Not collective.
  void velocities(const PlatesAndPosts::Flow& flow, Net& u);

  /// Returns the integral over the cell of the velocity u due to the flow `flow` of the solids, the load f and the velocity v of the particles. With
  /// three periods the integral is the volume times U (2.46). In front of a single plate it is not defined, and zero is returned. Between two plates
  /// at the distance D it has components along the plates only, and follows from the reciprocal theorem:
  ///
  ///   int u_i dV = (1/mu) (int_S f_i phi dGamma - int_C df_i phi dGamma) + int_C (1 - lambda) v.sigma_i n dGamma             (2.49)
  ///
  /// In this formula, f_i is the force density of the solids (`flow`) and df_i the load of the particles (the argument f). S are the surfaces of the
  /// solids, and C the surfaces of the particles. With z the distance from one plate and phi = z (D - z)/2, a pressure that decreases along e_i with
  /// unit gradient drives the flow phi e_i/mu, which has the stress sigma_i.
  Vec3 flow_integral(const PlatesAndPosts::Flow& flow, const Net& f, const Net& v);

  const SolidScene& scene() const { return scene_; }
  stokes::Evaluations evaluations() const { return particles_.evaluations(); }

 private:
  SolidScene scene_;
  const stokes::AmbientFlow& flow_;
  LayerPair particles_;
  Net shape_;
  PointsOff on_solids_;     // collocation points of the solids
  PointsOff on_particles_;  // points on the particles that were passed to set_shape()
  Eigen::VectorXd areas_;  // integral of each basis function N_A over the area to which loads refer (current or unstressed)
  std::optional<PlatesAndPosts::Flow> empty_;
  Mat3 change_;  // value of AmbientFlow::change() for which empty_, the flow without particles, was computed
};

}  // namespace tanktread::coupling
