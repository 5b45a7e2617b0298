#pragma once
// Single layer of the rigid bodies among all particles, and the LU factors of its matrix.

#include <optional>
#include <span>
#include <vector>

#include "base/dense_factors.hpp"
#include "base/types.hpp"
#include "spline/space.hpp"
#include "stokes/layer.hpp"
#include "system/capsule_parameters.hpp"
#include "system/parallel/ranks.hpp"
#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {

/// The single layer (1/mu) A of (2.40) of the rigid bodies only, made regular by one flux condition per body as in (2.10). Nets have one row per
/// control point of all particles; only the rows of bodies contain force densities f. Calls are collective.
class BodyLayer {
 public:
  /// `bodies`: the rigid bodies; their blocks are rows of nets of all particles. `own`: indices, in these nets, of the collocation points at which
  /// this rank computes velocities. `ranks` must outlive this object.
  BodyLayer(std::span<const Particle> bodies, const CapsuleParameters& parameters, std::span<const int> own, const Ranks& ranks);

  /// Sets the shape x with the collocation sites `at`. Assembles and factors the single layer A at the sites of the bodies, without images on a
  /// lattice. `keep_rows`: true to store the matrix for many calls of velocity(); false to save memory, and velocity() is then zero in the rows of
  /// bodies.
  void set_shape(const Net& x, const Net& at, bool keep_rows);

  /// Returns (1/mu) A f at the collocation sites of all particles. The rows of bodies are zero if set_shape() was called without `keep_rows`.
  Net velocity(const Net& f);

  /// Returns the regularising term (2.10), a part of the operator (1/mu) A, applied to the density f.
  Net regular(const Net& f) const;

  /// Solves for the force densities that produce the velocities in `columns`. Returns `columns` with the rows of bodies (velocities at the sites)
  /// replaced by these densities. Not collective.
  Eigen::MatrixXd solved(Eigen::MatrixXd columns) const;

  /// Returns solved() as a preconditioner for one column. It refers to this object.
  Apply preconditioner() const;

  stokes::Evaluations evaluations() const { return beyond_ ? layer_.evaluations() + beyond_->evaluations() : layer_.evaluations(); }

 private:
  void make_regular(const Net& x);

  std::vector<Particle> bodies_;   // the rigid bodies. Their blocks number the rows of nets that hold rigid bodies only
  std::vector<spline::Block> in_;  // rows of each body in nets of all particles
  spline::Space space_;            // common space of the bodies
  std::vector<int> points_, rows_, others_;  // points_: control points of the bodies; rows_: indices of their components; others_: points of `own`
                                             // (see the constructor) on other particles
  double viscosity_;
  const Ranks& ranks_;
  stokes::Layer layer_;                  // single layer at the sites of the bodies
  std::optional<stokes::Layer> beyond_;  // single layer at the points `others_`; empty if there are none
  Net at_, flux_, outward_;  // at_: collocation sites. flux_: flux vector b of each body. outward_: vector s R c/(b.c) of (2.10), which makes the
                             // single layer of a closed surface invertible. s: scale; R: collocation matrix; c: vectors from the body's centre
  Eigen::MatrixXd matrix_;                // matrix of A at the sites of the bodies; empty if `keep_rows` is false
  stokes::Rows<double> rows_of_others_;  // rows of the single layer A at the points `others_`; empty if `keep_rows` is false
  std::optional<DenseFactors> factors_;
};

}  // namespace tanktread::coupling
