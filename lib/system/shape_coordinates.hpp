#pragma once
// Representation of small changes of shape by a vector of coordinates.

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/symmetric_solver.hpp"
#include "spline/space.hpp"
#include "surface/symmetry.hpp"
#include "system/coupled_motion.hpp"
#include "system/dynamics.hpp"
#include "system/particle.hpp"
#include "system/targets/velocity_projection.hpp"

namespace tanktread::coupling {

/// Coordinates y of small displacements d of a control net x, and of rates of change of x. The definition of y depends on the kind of particle:
///
/// - Control points that move with the material: three coordinates per collocation site, the components of d.
/// - Control points that slide along the interface of a drop: one coordinate per site, the normal component of d, because tangential displacements do
///   not change the shape,
///
///     y_i = n_i.(R d)_i,   d = R^{-1} (n_i y_i)                                                                   (4.15)
///
///   Here n_i is the unit normal of x at site i and R the collocation matrix. If y contains a translation of the drop, d also contains the tangential
///   part of the translation, so that translations are represented exactly. If velocities are projected (VelocityProjection), y contains, instead of
///   y_i, the control values of the scalar field that fits n.d best. With y_i of (4.15), tangential motion of the mesh would change y by an amount of
///   fourth order in the element size.
/// - Rigid body: the coefficients of six orthonormal fields, which span its translations and rotations.
///
/// Relaxing meshes: after `follow` has been called, d contains in addition a tangential displacement R^{-1} t_i. The displacement t_i is chosen so
/// that the relaxation velocity w of the mesh does not change: a mesh at rest remains at rest on the displaced shape. With the derivative w'(d) of w
/// along d,
///
///   d = R^{-1} (n_i y_i + t_i),   (1 - n n).w'(d) = 0                                                              (4.26)
///
/// Symmetry: if the scene is symmetric, y has only coordinates at fundamental sites (one site per symmetry orbit), without the components that
/// symmetry forces to zero there. These coordinates represent only symmetric displacements or, if `parity` is given, only displacements of this
/// parity (surface/symmetry.hpp). If `parity` is not (1, 1, 1), all other parts of the system must be constructed without the symmetry.
///
/// Fields on the surfaces: y also contains coordinates y_q of the fields. y_q is the change dq of the field coefficients q, minus the change of q due
/// to the tangential part of d:
///
///   y_q = dq - q'(d - R^{-1} (n_i y_i)),   q'(t) the change of q if control points only slide along the surface by t      (4.34)
class ShapeCoordinates {
 public:
  /// Coordinates of changes of the state x of `motion`. `motion` and `symmetry` must outlive this object.
  ShapeCoordinates(CoupledMotion& motion, const State& x, const surface::Symmetry& symmetry, const Vec3& parity = Vec3::Ones());

  /// Determines how relaxing meshes follow displacements of x (4.26): they slide along the surface until the linearised mesh motion of `dynamics`
  /// vanishes. Collective.
  void follow(Dynamics& dynamics, const State& x);

  CoupledMotion& motion() const { return motion_; }
  Eigen::Index size() const { return shape_size() + static_cast<Eigen::Index>(fields_.size()); }
  State displacement(const Eigen::VectorXd& y) const;      ///< change of the state with the coordinates y
  Eigen::VectorXd coordinates(const State& change) const;  ///< coordinates y of a change of the state
  bool admits(const State& change) const;                  ///< true if the shape changes with the symmetry and parity that y represents, up to 1e-3

 private:
  struct Coordinate {
    int site;
    Vec3 direction;  // direction of the displacement; zero if the coordinate is a control value of n.d (projected velocities)
  };
  static bool projected(const Coordinate& one) { return one.direction.isZero(0); }
  struct Translation {
    Eigen::VectorXd coordinates;  // orthonormal
    Net field, tangential;        // field: control values of a rigid translation of a drop. tangential: field - normal_displacement(coordinates),
                                  // the tangential part of this translation, which normal_displacement() omits
  };
  Eigen::Index shape_size() const { return static_cast<Eigen::Index>(all_.size() + rigid_.size()); }
  Net of_shape(const Eigen::VectorXd& y) const;
  Eigen::VectorXd coordinates_of_shape(const Net& field) const;
  void carry_whole(const spline::Block& block);
  void add_rigid(const spline::Block& block, const Net& x);
  Net normal_displacement(const Eigen::VectorXd& y) const;
  Net along(const Eigen::VectorXd& t) const;
  Eigen::VectorXd coordinates_along(const Net& field) const;
  void add_along(int site, const Vec3& normal);

  CoupledMotion& motion_;
  State state_;                         // the coordinates of fields are changes relative to this state
  std::vector<Coordinate> all_;
  std::vector<Net> rigid_;         // orthonormal rigid motions of bodies; in y, their coordinates follow the coordinates `all_`
  std::vector<Coordinate> along_;  // tangential coordinates t of drops
  Eigen::MatrixXd following_;      // maps coordinates y to the tangential coordinates t of relaxing meshes (4.26); empty if no mesh relaxes
  std::vector<Translation> translations_;  // translations of drops
  surface::Parity parity_;
  Eigen::SparseMatrix<double> sites_;  // collocation matrix R
  membrane::SymmetricSolver collocation_;
  const VelocityProjection* projection_;
  Net normals_;  // unit normals of drops at the sites of `projection_`
  std::shared_ptr<const Layout> layout_;                // layout of states of this symmetry and parity
  std::vector<std::pair<Eigen::Index, double>> fields_;  // independent coefficients of the fields in a state, and the factors of their coordinates
};

}  // namespace tanktread::coupling
