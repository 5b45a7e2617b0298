#pragma once
// Rigid bodies among capsules and drops.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "system/particle.hpp"
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

/// The limit lambda -> infinity (rigid bodies) of equation (2.22) for particles of viscosity ratio lambda. In this limit v = V + w/(lambda - 1) on
/// the body, V = U + Omega x r, and
///
///   V(x0) = v_inf(x0) - sum_p G df_p - (1 / 8 pi) int (w - w(x0)) T n dGamma + contributions of v and w of the other particles    (2.23)
///
/// The density w replaces v in the unknowns. The integral does not change if a rigid motion is added to w. The rigid motion <w> nearest to w (least
/// squares) is therefore not determined by the integral, and represents another unknown of the body. If the force and torque are given, this unknown
/// is the motion, V = <w>. The vectors a and b in the load df = -(a + b x r) are then chosen such that the resultants of a + b x r are the given
/// force and torque of the body on the fluid. If the motion V is given, df = (mu/R_C) <w>, and the force follows. This is the completed double layer:
/// Power & Miranda 1987; Kim & Karrila 1991, chapter 15.
///
/// Nets stack the control points of all particles. The rows of a body in a net x represent the position of the rigid body that fits them best.
///
/// Order of calls at a shape: move_into_cell() on a lattice, fit_to(), push(); then add_load() and the others that the solve for the velocities
/// needs; store_density() or, for bodies by tractions, set_motion(); move_out_of_cell().
class RigidParticles {
 public:
  /// `rest`: net of all particles at rest; only rows of rigid bodies are stored. `viscosity`: mu of the outer fluid.
  RigidParticles(std::span<const Particle> particles, const Net& rest, double viscosity, const quadrature::Options& quadrature);

  bool empty() const { return bodies_.empty(); }
  bool prescribed() const;  ///< returns whether the motion of at least one body is prescribed

  /// Moves every body to the position that fits the rows of the body in x best. Replaces these rows by the control points of the moved body.
  void fit_to(Net& x);

  /// Sets forces on the bodies in addition to the prescribed forces. `work`: virtual work of these forces per unit displacement of each control
  /// point, one row per control point of all particles; no rows if there are no such forces. The forces act on material points and have fixed
  /// directions in space.
  void push(const Net& work);

  // The next six functions skip bodies whose unknown is the traction instead of the double-layer density w (2.23).
  // `work`: if set, the virtual work of loads (Sources::work), whose force and torque replace those given.
  /// Adds the load df (2.23) of the bodies whose force and torque are given, in the rows of these bodies.
  void add_load(Net& load, const Net* work = nullptr) const;
  /// Adds the correction (SelfCorrection) of the velocity -(1/mu) R^-1 A df of each body on itself.
  void add_load_correction(Net& v, const Net* work = nullptr) const;
  /// Adds the velocity V of the bodies with the density w. If `with_given` is false, omits prescribed motions.
  void add_velocity(const Net& w, bool with_given, Net& v) const;
  void complete(const Net& w, Net& v) const;  ///< completes the left-hand side v of (2.23), in the rows of bodies. First subtracts the density w and
                                              ///< adds the correction (SelfCorrection) of its double layer. If force and torque of the body are
                                              ///< given, then adds the rigid motion <w>; otherwise adds the correction of the single layer of the
                                              ///< load completing_load()
  Net completing_load(const Net& w) const;   ///< returns the load (mu/R_C) <w> of bodies with prescribed motion, with <w> the rigid motion nearest to
                                             ///< w (2.23); 0 in the rows of other particles
  void store_density(Net& v);                ///< in the rows of bodies: stores the unknown w (2.23) and replaces it by the velocity V
  /// Sets the motion, force and torque of body p to values that were not computed from (2.23). Sets the rows of the body in v to the control values
  /// of this motion.
  void set_motion(std::size_t p, const RigidMotion& motion, const Vec3& force, const Vec3& torque, Net& v);
  /// On a lattice, the solve for the velocities uses the image of each body in the cell. move_into_cell() must be called before the solve, so that
  /// prescribed velocities become the velocities of the images. move_out_of_cell() must be called after the solve. It moves the centres and
  /// velocities of the images back to the centres and velocities of the bodies. `shifts`: one per particle.
  void move_into_cell(std::span<const CellShift> shifts);
  void move_out_of_cell(std::span<const CellShift> shifts);

  /// Returns whether particle p is a rigid body. The members below refer to the latest evaluated velocities.
  bool is_rigid(std::size_t p) const { return of_particle_[p] >= 0; }
  const RigidMotion& motion(std::size_t p) const { return body(p).motion; }
  const Net& density(std::size_t p) const { return body(p).density; }  ///< w, rows of this body
  Vec3 force(std::size_t p) const { return body(p).force; }            ///< force on the fluid
  Vec3 torque(std::size_t p) const { return body(p).torque; }          ///< torque on the fluid about the centre of volume
  const Vec3& centre(std::size_t p) const { return body(p).centre; }   ///< centre of its volume
  const Vec3& rest_centre(std::size_t p) const { return body(p).rest_centre; }
  Mat3 turn(std::size_t p) const { return body(p).turn; }              ///< rotation from rest
  RigidDrive given(std::size_t p) const { return body(p).given(); }    ///< prescribed motion, or prescribed force and torque plus forces of push()

  // The members below throw std::logic_error if the unknown of the body is the traction.
  Mat3 load_moment(std::size_t p) const;  ///< int df r dGamma

  /// Returns whether the bodies p and q have equal shapes and orientations at rest.
  bool alike(std::size_t p, std::size_t q) const { return body(p).dual().self_correction == body(q).dual().self_correction; }

  /// Returns the correction (SelfCorrection) of the velocity that the unit load k of body p induces on the body itself, in the axes of the body at
  /// rest.
  const Net& self_correction(std::size_t p, int k) const { return body(p).dual().self_correction->loads[static_cast<std::size_t>(k)]; }

  /// Component k of the mean rigid motion <w> (velocity, then angular velocity) is a linear function of the body's rows of w. Returns its
  /// coefficients, three per row, for the body in its position at rest.
  Eigen::VectorXd mean_functional(std::size_t p, int k) const;

 private:
  using Motions = Eigen::Matrix<double, 6, 1>;
  /// Integrals over a body at rest whose unknown is the double-layer density w (2.23), and the correction of its layers.
  struct DoubleLayer {
    std::shared_ptr<const SelfCorrection> self_correction;  // shared by equal bodies
    Eigen::VectorXd weight;                                 // int N_A dGamma
    Net moment;                                             // int N_A r dGamma
    Eigen::Matrix<double, 6, 6> inertia;  // entry (j, k): integral of u_j.u_k over the surface, with the velocity field u_k of unit motion k
    Mat3 second;                          // int r r dGamma
    Vec3 first;                           // int r dGamma
  };
  struct Body {
    spline::Block block;
    RigidDrive rigid;
    Net pushed;  // rows of this body in the argument of push(); no rows if there are no such forces
    double radius = 0, viscosity = 0;
    Net rest;             // control net in the reference orientation, relative to the centre of volume
    std::optional<DoubleLayer> double_layer;  // set if the unknown is the density w
    Vec3 rest_centre, centre;
    Vec3 cell_velocity = Vec3::Zero();  // velocity of the body minus the velocity of its image in the cell
    Mat3 turn = Mat3::Identity();
    Net density;
    RigidMotion motion;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();

    const DoubleLayer& dual() const;  // throws std::logic_error if double_layer is not set
    RigidDrive given() const;
    RigidDrive drive(const Net* work) const;  // given(), or the resultants of `work` (see add_load)
    void add_forces(const Net& forces, RigidDrive& to) const;  // adds the resultants of forces on the control points
    RigidMotion mean(const Net& w) const;      // rigid motion <w> of (2.23): least-squares fit over the body. `w`: net of all particles
    RigidMotion with_integrals(const Vec3& force, const Vec3& torque) const;  // field a + b x r with this force and torque as its integrals
    Net field(const RigidMotion& of) const;                             // values of the rigid motion `of` at the control points of the body
    Net single_layer_correction(const RigidMotion& load) const;         // SelfCorrection of the single layer R^-1 A f of the load f = a + b x r
    Net double_layer_correction(const Net& w) const;                    // SelfCorrection of the double layer R^-1 H w with density w; `w`: net of
                                                                        // all particles
  };
  const Body& body(std::size_t p) const { return bodies_[static_cast<std::size_t>(of_particle_[p])]; }

  std::vector<Body> bodies_;
  std::vector<int> of_particle_;  // for each particle, its index in bodies_; -1 if it is not a rigid body
};

}  // namespace tanktread::coupling
