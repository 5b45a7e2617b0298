#pragma once
// Rigid bodies among capsules and drops.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "system/particle.hpp"
#include "system/solids/own_lacking.hpp"
#include "system/solids/rigid_motion.hpp"

namespace tanktread::coupling {

/// The limit lambda -> infinity of (2.22). There v = V + w/(lambda - 1) on the body, V = U + Omega x r, and
///
///   V(x0) = v_inf(x0) - sum_p G df_p - (1 / 8 pi) int (w - w(x0)) T n dG + what the others' v and w do                            (2.23)
///
/// w takes the place of v in the unknowns. A rigid motion in it does nothing, so the nearest one, <w>, is free to say the rest: of a body on which
/// force and torque are given, V = <w> and df = -(a + b x r), which has that force and torque on the fluid; of one whose V is given,
/// df = (mu/R_C) <w>, and its force follows. Completed double layer: Power & Miranda 1987; Kim & Karrila 1991, chapter 15.
///
/// Nets are those of all particles. A body's rows of a net x are read as the rigid image of it at rest that is nearest to them.
class RigidParticles {
 public:
  /// `rest`: net of all particles; of others than rigid ones nothing is kept. `viscosity`: mu of the outer fluid. `solved_here`: by (2.23), not by
  /// their tractions.
  RigidParticles(std::span<const Particle> particles, const Net& rest, double viscosity, const quadrature::Options& quadrature, bool solved_here);

  bool empty() const { return bodies_.empty(); }
  bool prescribed() const;  ///< whether any moves as prescribed

  /// Puts every body where its rows of x are nearest to it, and its rows there.
  void place(Net& x);

  /// Virtual work of forces on the bodies beside those that are given, a row a control point of all particles, on material points, whose directions
  /// stay; of no rows: none.
  void push(const Net& work);

  void add_load(Net& load) const;            ///< the load of given forces and torques
  void add_lacking(Net& v) const;            ///< of -R^-1 A f/mu, f their load, on the bodies themselves (own_lacking.hpp)
  void subtract_prescribed(Net& v) const;          ///< V of the bodies that move as prescribed
  void complete(const Net& w, Net& v) const; ///< rows of v: w out, <w> in where force and torque are given, and what R^-1 D w lacks
  Net completing_load(const Net& w) const;   ///< (mu/R_C) <w> of the bodies that move as prescribed, 0 elsewhere
  void move(Net& v);                         ///< w in the rows of v becomes V; w is kept
  void move(std::size_t p, const RigidMotion& motion, const Vec3& force, const Vec3& torque, Net& v);  ///< as another equation says; rows of v
  /// On a lattice a velocity is that of images in the cell. `enter`: bodies are images from now on, from which particles p are `shifts[p]` away in a
  /// flow of this gradient. `carry` moves the image of body p, if it is one, to the body's own centre, and makes its velocity the body's own.
  void enter(std::span<const Vec3> shifts, const Mat3& gradient);
  void carry(std::size_t p, const Vec3& along, const Vec3& faster);
  void clear(Net& net) const;                ///< 0 in all rows of bodies

  /// Whether particle p is one, and what it does and feels where velocities were asked for last.
  bool holds(std::size_t p) const { return of_particle_[p] >= 0; }
  const RigidMotion& motion(std::size_t p) const { return body(p).motion; }
  const Net& density(std::size_t p) const { return body(p).density; }  ///< w, its own rows
  Vec3 force(std::size_t p) const { return body(p).force; }            ///< on the fluid
  Vec3 torque(std::size_t p) const { return body(p).torque; }          ///< on the fluid, about the centre
  const Vec3& centre(std::size_t p) const { return body(p).centre; }   ///< of its volume
  const Vec3& rest_centre(std::size_t p) const { return body(p).rest_centre; }
  Mat3 turn(std::size_t p) const { return body(p).turn; }              ///< from where it was at rest
  Rigid given(std::size_t p) const { return body(p).given(); }         ///< what drives it, with what pushes it
  Mat3 load_moment(std::size_t p) const;                               ///< int df r dG

  /// Whether two bodies are equal where they were at rest, but for where that was.
  bool alike(std::size_t p, std::size_t q) const { return body(p).lacking == body(q).lacking; }

  /// What collocation lacks of the velocity of a unit load on its own body, where it was at rest (own_lacking.hpp).
  const Net& lacking(std::size_t p, int k) const { return body(p).lacking->loads[static_cast<std::size_t>(k)]; }

  /// Component k of <w>, the velocity's and then the angular velocity's, as a linear functional of its rows of w, row after row, where it was at
  /// rest.
  Eigen::VectorXd mean_functional(std::size_t p, int k) const;

 private:
  using Motions = Eigen::Matrix<double, 6, 1>;
  struct Body {
    spline::Block block;
    Rigid rigid;
    Net pushed;  // of no rows: by nothing
    double radius = 0, viscosity = 0;
    Net rest;             // about the centre
    std::shared_ptr<const OwnLacking> lacking;  // equal bodies have it in common
    Eigen::VectorXd weight;              // int N_A dG
    Net moment;                          // int N_A r dG
    Eigen::Matrix<double, 6, 6> inertia;  // of the surface: int and int r x of the six rigid motions
    Mat3 second;                          // int r r dG
    Vec3 first;                           // int r dG
    Vec3 rest_centre, centre;
    Vec3 faster = Vec3::Zero();  // velocity of the body less that of its image in the cell
    Mat3 turn = Mat3::Identity();
    Net density;
    RigidMotion motion;
    Vec3 force, torque;

    Rigid given() const;
    RigidMotion mean(const Net& w) const;      // <w>, w of all particles
    RigidMotion carrying(const Vec3& force, const Vec3& torque) const;  // the rigid field with these integrals
    Net field(const RigidMotion& of) const;                             // its rows of it
    RigidMotion load() const;                                           // a and b of the force on the fluid
    Net lacking_of(const RigidMotion& load) const;                      // of R^-1 A f
    Net lacking_of(const Net& w) const;                                 // of R^-1 H w
  };
  const Body& body(std::size_t p) const { return bodies_[static_cast<std::size_t>(of_particle_[p])]; }

  std::vector<Body> bodies_;
  std::vector<int> of_particle_;  // its number among the bodies, or -1
};

}  // namespace tanktread::coupling
