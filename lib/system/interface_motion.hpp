#pragma once
// How control points move along a fluid interface, where only the motion across it is physics.

#include <limits>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/membrane.hpp"
#include "membrane/symmetric_solver.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/layer.hpp"
#include "system/particle.hpp"
#include "system/ranks.hpp"
#include "system/velocity_projection.hpp"

namespace tanktread::coupling {

/// The unit normal of the surface with net x at a place, which is the site of one element or the meeting point of several.
Vec3 site_normal(const spline::Space& space, const Net& x, std::span<const spline::Site> sites);

/// Velocity of the control points from the fluid's velocity v: at the collocation sites of each drop
///
///   u = W + n n.(v - W) + (1 - n n).w,   w = 0 (`normal`)  or  w = -speed Q A0 Q^T M0^{-1} dE1/dx (`relaxed`)    (4.6)
///
/// W (4.14) is the rigid motion of the drop, which the mesh shares: a drop that is carried along or turned as a whole keeps its mesh as one at rest
/// does, and the mesh of a steady shape, around which the fluid treads, stays where it is. E1 is the energy of a
/// neo-Hookean membrane of modulus 1 whose unstressed shape is the initial one, and A0, M0 belong to that shape: the mesh slides along the
/// interface as an elastic bag would be dragged through the fluid by what pulls along it, so elements keep their shape, the mesh rests where E1 is
/// least on that interface, and the system is no stiffer than that of a capsule with Ca = mu rate R_C / (mu speed). A0 never changes, knows one
/// drop alone, and turns with the mesh, by Q. Elsewhere u = v.
class InterfaceMotion {
 public:
  /// `initial`: the net that the meshes relax towards; `mass`: the factored M0 of it. `projection`: of u; none: it is collocated.
  InterfaceMotion(const spline::Space& space, const Net& initial, std::span<const Particle> particles, const quadrature::Options& quadrature,
                  const std::vector<int>& own_points, const std::vector<int>& own_elements, const membrane::SymmetricSolver& collocation,
                  const membrane::SymmetricSolver& mass, const Ranks& ranks, const VelocityProjection* projection = nullptr);

  /// Control-point velocity u at x for the fluid's velocity v (control values), with b = dV/dx. Collective.
  Net velocity(const Net& x, const Net& b, const Net& v);

  /// Control values of (1 - n n).(e_k x y) on each drop, k of `axes`, y from the mean of its control points: the mesh turns on an interface that
  /// stays. Collective.
  std::vector<Net> rotations(const Net& x, std::span<const int> axes) const;

  /// Keeps x, b = dV/dx, normals and the tangent of E1 at x for `derivative`. Collective.
  void linearise(const Net& x, const Net& b);

  /// du for a change delta of x that changes the fluid's velocity by dv; b and W of v stay, and the normals too unless the latest velocity is
  /// that at x. Collective.
  Net derivative(const Net& dv, const Net& delta);

  /// Whether any mesh slides by itself.
  bool relaxes() const { return relaxed_; }

 private:
  struct Drop {
    spline::Block block;
    bool relaxed;
    double speed;
    std::vector<int> points;      // own ones
    std::vector<int> places;      // of the projection
    stokes::Rows<double> layer;   // their rows of A0, in full: what the mesh does must not depend on units or axes
  };
  Net sliding(const Net& x, const Net& f) const;
  Net combined(const Net& x, const Net& b, const Net& normals, const Net& v, const Net& f, Net& rest) const;
  Net normals_at(const Net& x) const;  ///< at the sites of all drops; zeros elsewhere. Collective

  const spline::Space& space_;
  std::vector<Drop> drops_;
  bool relaxed_ = false;           // any of them
  double radius_ = std::numeric_limits<double>::infinity();  // R_C of the smallest
  std::vector<int> own_elements_;  // of those
  Eigen::SparseMatrix<double> sites_;  // R
  const VelocityProjection* projection_;
  const membrane::SymmetricSolver &collocation_, &mass_;
  const Ranks& ranks_;
  membrane::Membrane mesh_;
  membrane::Tangent tangent_;
  struct Latest {
    Net x, rest, density;  // v - W - w at the places of u; M0^{-1} dE1/dx at the collocation sites
  };
  Latest latest_, known_;      // of the latest velocity; the same if it was linearised there
  Net x_, flux_, normals_;  // as linearised
};

}  // namespace tanktread::coupling
