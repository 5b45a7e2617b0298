#pragma once
// Rigid bodies among capsules and drops.

#include <optional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "system/particle.hpp"
#include "system/rigid_motion.hpp"
#include "system/solids/bodies/body_density.hpp"

namespace tanktread::coupling {

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

  const BodyDensity& double_layer(std::size_t p) const { return body(p).dual(); }  ///< returns the body at rest

 private:
  struct Body {
    spline::Block block;
    RigidDrive rigid;
    Net pushed;  // rows of this body in the argument of push(); no rows if there are no such forces
    double radius = 0, viscosity = 0;
    Net rest;             // control net in the reference orientation, relative to the centre of volume
    std::optional<BodyDensity> double_layer;  // set if the unknown is the density w
    Vec3 rest_centre, centre;
    Vec3 cell_velocity = Vec3::Zero();  // velocity of the body minus the velocity of its image in the cell
    Mat3 turn = Mat3::Identity();
    Net density;
    RigidMotion motion;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();

    const BodyDensity& dual() const;  // throws std::logic_error if double_layer is not set
    RigidDrive given() const;
    RigidDrive drive(const Net* work) const;  // given(), or the resultants of `work` (see add_load)
    void add_forces(const Net& forces, RigidDrive& to) const;  // adds the resultants of forces on the control points
    RigidMotion turned(const RigidMotion& at_rest) const;  // from the axes of the body at rest to the axes of space
    RigidMotion mean(const Net& w) const { return turned(dual().mean(block.rows(w) * turn)); }  // <w> of (2.23). `w`: net of all particles
    RigidMotion load(const Net* work = nullptr) const;     // field a + b x r whose integrals are the force and torque of drive(), in axes at rest
    Net field(const RigidMotion& of) const;                // values of the rigid motion `of` at the control points of the body
  };
  const Body& body(std::size_t p) const { return bodies_[static_cast<std::size_t>(of_particle_[p])]; }

  std::vector<Body> bodies_;
  std::vector<int> of_particle_;  // for each particle, its index in bodies_; -1 if it is not a rigid body
};

}  // namespace tanktread::coupling
