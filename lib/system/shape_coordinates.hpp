#pragma once
// Small changes of shape as a column of numbers.

#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/symmetric_solver.hpp"
#include "spline/space.hpp"
#include "surface/symmetry.hpp"
#include "system/coupled_motion.hpp"
#include "system/dynamics.hpp"
#include "system/particle.hpp"
#include "system/velocity_projection.hpp"

namespace tanktread::coupling {

/// Coordinates of small displacements of a net x, and of rates of change: at each collocation site three components, or, of a drop whose mesh slides
/// along its interface, the one along the normal of x, for the others change no shape,
///
///   y_i = n_i.(R d)_i,   d = R^{-1} (n_i y_i)                                                                     (4.15)
///
/// and of that part of such a y that a translation has, the translation itself, which moves the mesh along the interface as well.
/// Where velocities are projected, y are the control values of a scalar field there, that of the best fit to n.d; what moves the mesh along would
/// otherwise show in them by the fourth power of the element.
///
/// A mesh that slides by itself goes along with such a displacement, once `follow` is called, by what leaves it at rest on the shape: with w the rate
/// at which it slides, and t' the derivative of t along d,
///
///   d = R^{-1} (n_i y_i + t_i),   (1 - n n).w'(d) = 0                                                              (4.26)
///
/// Of a symmetric scene those of fundamental sites, and what its images turn around at a site is left out: they tell the symmetric fields alone, or
/// those of another parity (surface/symmetry.hpp), for whom nothing else may know of the symmetry.
///
/// Of a rigid body those of six orthonormal fields, its translations and rotations.
///
/// Of a state with fields on the surfaces (CoupledMotion), once `add_fields` is called, there follow those of the fields' coefficients as they are
/// without the part of the displacement that moves control points along the surface:
///
///   y_q = dq - q'(d - R^{-1} (n_i y_i)),   q'(t) the change of q where control points slide by t alone                   (4.34)
class ShapeCoordinates {
 public:
  ShapeCoordinates(const spline::Space& space, std::span<const Particle> particles, const surface::Symmetry& symmetry, const Net& x,
                   const VelocityProjection* projection = nullptr, const Vec3& parity = Vec3::Ones());

  /// Lets meshes go along, as `dynamics` has them at x. Collective.
  void follow(Dynamics& dynamics, const Net& x);

  /// Adds those of the fields at the state y, which changes of states are about. The motion must outlive this.
  void add_fields(CoupledMotion& motion, const Net& y);

  Eigen::Index size() const { return shape_size() + fields_.cols(); }
  Eigen::Index n_points() const { return sites_.rows(); }
  Net displacement(const Eigen::VectorXd& y) const;     ///< control values of the field with these coordinates, or the change of a state
  Eigen::VectorXd coordinates(const Net& field) const;  ///< of a field of these control values, or of the change of a state
  bool admits(const Net& field) const;                  ///< whether it is nearly one of those that symmetry leaves
  Net admitted(Net field) const;                        ///< the one of those with its values at fundamental points

 private:
  struct Coordinate {
    int site;
    Vec3 direction;  // 0: of the projected field
  };
  static bool projected(const Coordinate& one) { return one.direction.isZero(0); }
  struct Translation {
    Eigen::VectorXd coordinates;  // orthonormal
    Net field, rest;              // with these coordinates; less the one across the interface
  };
  Eigen::Index shape_size() const { return static_cast<Eigen::Index>(all_.size() + rigid_.size()); }
  Net of_shape(const Eigen::VectorXd& y) const;
  Eigen::VectorXd coordinates_of_shape(const Net& field) const;
  void carry_whole(const spline::Block& block);
  void add_rigid(const spline::Block& block, const Net& x);
  Net across(const Eigen::VectorXd& y) const;
  Net along(const Eigen::VectorXd& t) const;
  Eigen::VectorXd coordinates_along(const Net& field) const;
  void add_along(int site, const Vec3& normal);

  std::vector<Coordinate> all_;
  std::vector<Net> rigid_;         // orthonormal motions of bodies, whose coordinates come last
  std::vector<Coordinate> along_;  // of drops, tangential
  Eigen::MatrixXd following_;      // those of the mesh that follows, of coordinates y; empty: it does not
  std::vector<Translation> translations_;  // of drops
  const surface::Symmetry& symmetry_;
  Vec3 of_planes_;
  surface::Parity parity_;
  Eigen::SparseMatrix<double> sites_;  // R
  membrane::SymmetricSolver collocation_;
  const VelocityProjection* projection_;
  Net normals_;  // at its sites, of drops
  CoupledMotion* motion_ = nullptr;     // of a state with fields
  Net state_;                           // that changes are about
  Eigen::SparseMatrix<double> fields_;  // orthonormal changes of the numbers of a state behind its control net, a column each
};

}  // namespace tanktread::coupling
