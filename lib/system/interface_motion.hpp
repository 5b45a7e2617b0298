#pragma once
// Tangential motion of control points along a fluid interface. Physics determines only the motion normal to the interface.

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/membrane.hpp"
#include "system/motion_of_shape.hpp"
#include "system/targets/targets.hpp"

namespace tanktread::coupling {

/// Returns the unit normal of the surface with net x at a point, given by its site on one element or by its sites on all elements that meet there.
Vec3 site_normal(const spline::Space& space, const Net& x, std::span<const spline::Site> sites);

/// Motion of the fluid relative to the mesh motion on all drops (4.6). Empty nets if unknown.
struct Slip {
  Net fluid;     ///< control values of the fluid velocity v
  Net residual;  ///< v - W - w, fluid velocity minus motions of shape and relaxation, at the sites where u is evaluated. With collocation, only the
                 ///< rank-owned rows of drops are set
  Net density;   ///< force density M0^{-1} dE1/dx at the collocation sites, with the mesh energy E1; no rows if no drop relaxes

  bool known() const { return fluid.rows() > 0; }
};

/// Computes the velocity u of the control points from the fluid velocity v. At the collocation sites of each drop
///
///   u = W + n n.(v - W) + (1 - n n).w,   w = 0 (`normal`)  or  w = -speed Q A0 Q^T (1 - n n).M0^{-1} dE1/dx (`relaxed`)    (4.6)
///
/// W (4.14) is the motion of the drop's shape, a rigid motion and for `relaxed` a uniform rate of stretch. The mesh moves with W. If a drop is
/// convected, or if an elongated drop rotates as a whole, its mesh moves rigidly. If a drop elongates, a relaxed mesh is stretched with it, so that
/// the elements at the tips stay as small as elements that move with the material. Without relaxation the stretch would be unstable: in an
/// oscillating shear flow, the mesh would not return to itself. If the shape is steady, the mesh does not move while the fluid tank-treads around it.
/// E1 is the energy of a neo-Hookean membrane of modulus 1 whose unstressed shape is the initial shape. A0 and M0 are the single layer and the mass
/// matrix of the drop's initial shape, and the rotation Q turns the initial shape with the mesh. Only the tangential part of the elastic force moves
/// the mesh: a relaxed mesh slides along the interface like an elastic membrane that is pulled through the fluid by its tension. Elements therefore
/// keep their shape, and the mesh comes to rest where E1 is smallest on the given interface. The equations of motion are no stiffer than for a
/// capsule with the capillary number Ca = mu rate R_C / (mu speed), where `rate` is the shear rate. On all other particles u = v.
class InterfaceMotion {
 public:
  /// `initial`: net that the meshes relax towards. `mass`: factored mass matrix M0 of `initial`. References, except `initial`, must outlive this
  /// object.
  InterfaceMotion(const spline::Space& space, const Net& initial, const CapsuleParameters& parameters, const RowShare& layout, const Targets& targets,
                  const membrane::SymmetricSolver& mass);

  /// Returns the control values of the velocity u (4.6) of the control points in the shape x. `v`: control values of the fluid velocity. `b`: dV/dx.
  /// Sets `slip`, which `linearise` needs. Collective.
  Net velocity(const Net& x, const Net& b, const Net& v, Slip& slip);

  /// Returns the control values of (1 - n n).(e_k x y) on each drop for each k of `axes`, where y is the position relative to the mean of the drop's
  /// control points. These fields rotate the mesh along an interface that does not move. Collective.
  std::vector<Net> rotations(const Net& x, std::span<const int> axes) const;

  /// Stores x, b = dV/dx, the normals, and the Hessian of the mesh energy E1 (4.6) at x, which `derivative` needs. `slip`: result of velocity() at
  /// this shape; empty if it is unknown. Collective.
  void linearise(const Net& x, const Net& b, const Slip& slip);

  /// Returns the change of the control points' velocity u (4.6) if the shape passed to `linearise` is displaced by delta. `dv`, `db`: changes of the
  /// fluid velocity v and of the volume gradient b due to delta. The changes of the normals and of the linear map from v to the motion W are included
  /// only if `linearise` received a slip. If db has no rows, the change of the map is omitted. Collective.
  Net derivative(const Net& dv, const Net& delta, const Net& db);

  /// Returns true if any drop has the mesh motion `relaxed`.
  bool relaxes() const { return relaxed_; }

 private:
  struct Drop {
    spline::Block block;
    bool relaxed;
    SharedMotion shared;  // motion W (4.14) that the mesh shares with the shape of the drop
    double speed;
    std::vector<int> points;      // rank-owned control points
    std::vector<int> targets;     // points on this drop at which u is evaluated (Targets). With collocation, only rank-owned points
    stokes::Rows<double> layer;   // rows of the initial single layer A0 (4.6) at `points`, in double precision so that units and axes do not matter
  };
  struct Displaced {  // shape, dV/dx and normals of a displaced shape
    Net x, b, normals;
  };
  void slide(const Net& x, const Net& f, Net& w) const;
  std::vector<MotionOfShape> motions(const Net& x, const Net& b, const Net& normals, const Net& v) const;
  Net change_of_motion(const Displaced& to, const Net& normals, double aside) const;
  Net combined(const Net& x, const Net& b, const Net& normals, const Net& v, const Net& f, Net& slip_residual) const;
  Net normals_at(const Net& x) const;  ///< normals at the collocation sites of all drops, zeros at other sites. Collective
  Net normals_at_targets(const Net& x, const Net& at_sites) const;
  Net control_values(const std::function<void(Net&)>& fill) const;

  const spline::Space& space_;
  std::vector<Drop> drops_;
  bool relaxed_ = false;           // true if any drop relaxes
  double radius_ = std::numeric_limits<double>::infinity();  // R_C of the smallest drop
  std::vector<int> own_elements_;  // rank-owned elements of relaxing drops
  const Targets& targets_;
  const Eigen::SparseMatrix<double>& sites_;  // collocation matrix R
  const VelocityProjection* projection_;      // null if u is collocated
  const membrane::SymmetricSolver &collocation_, &mass_;
  const Ranks& ranks_;
  membrane::Membrane mesh_;
  membrane::Tangent tangent_;
  Net x_, flux_, normals_;  // shape, b = dV/dx and normals at which the system was linearised
  Slip slip_;               // slip at this shape; empty if it is unknown
  std::vector<MotionOfShape> shapes_;  // W (4.14) of each drop at this shape; empty if slip_ is
};

}  // namespace tanktread::coupling
