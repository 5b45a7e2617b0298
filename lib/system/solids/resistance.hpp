#pragma once
// A rigid surface in a fluid: the force density that gives a velocity on it.

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/dense_factors.hpp"
#include "base/timing.hpp"
#include "base/types.hpp"
#include "membrane/direct_solver.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "stokes/layer.hpp"
#include "system/collocation.hpp"
#include "system/ranks.hpp"
#include "system/solids/tube.hpp"
#include "system/solvers/krylov.hpp"
#include "system/solvers/options.hpp"

namespace tanktread::coupling {

/// The first-kind equation of a fixed rigid surface, collocated:  (1/mu) A f = u on the surface, f the force per area on the fluid   (2.4)
///
/// A n = 0, so f is only known up to a multiple of n (a constant pressure inside); and u must carry no flux. Both are said openly:
/// with b_A = int N_A n dG and c = M^-1 b the operator that is solved is R^-1 A + s c b^T / (b.c), which is regular and gives the f with
/// no net normal force, int f.n dG = 0, and takes up whatever flux the discrete u has.                                  (2.10)
///
/// Beside a plane wall what images add to A is assembled at each place (Layer::assemble_images), and the operator factored there: through the film
/// GMRES alone would not get.
///
/// In a tube A f - mu u(f) takes the place of A f, u the answer of the wall and the pressure drop (2.5); then the place counts, and GMRES goes
/// around the factors of the body alone. Fields stay in the axes that the body has in `surface`, wherever it has gone.
class Resistance {
 public:
  /// `surface`: control net. The rows of A are assembled here, in double precision, each rank its own, and serve for any place and orientation.
  /// `tube`: around the body, or nothing; it and `space` must outlive this. `wall`: that the body is in front of, or nothing.
  Resistance(const spline::Space& space, const Net& surface, double viscosity, const quadrature::Options& quadrature,
             const SolverOptions& solvers, Ranks& ranks, Phases& phases, Tube* tube = nullptr,
             const std::optional<stokes::PlaneWall>& wall = {});

  /// Where the body is now: control net in space, and the rotation from `surface` to it.
  void place(const Net& x, const Mat3& turn);

  /// Control values, in the body's axes, of the flow at the present place, interpolated at the collocation points.
  Net ambient(const stokes::AmbientFlow& flow) const;

  /// Control values of a field on `surface`, interpolated at the collocation points: `values` at points, a row each.
  Net interpolated(const std::function<Net(const Net& x)>& values) const { return collocation_.solve(values(sites_ * surface_)); }

  /// Control values of f for velocities at control values u. Throws RunFailure, with the residuals, when the solver stops short.
  Net force_density(const Net& u);

  /// The other way round, up to the multiple of n of (2.10): (1/mu) A f.
  Net velocity(const Net& f) { return apply(f) / viscosity_; }

  /// Whether the surface, where it is placed, is inside of the tube or in front of the wall, if there is one.
  bool inside() const { return (!tube_ || tube_->gap() > 0) && in_front_; }

  const std::optional<stokes::PlaneWall>& wall() const { return wall_; }

  /// The pressure drop of the tube for the force density f (2.7).
  double pressure_drop(const Net& f);

  /// What it lacks where the flow is the duct's: what is left of v_inf where it is interpolated, and `work`, the residual work of the density that
  /// has v_inf on the surface (2.41).
  double lacking_pressure(const stokes::AmbientFlow& flow, const Net& f, double work = 0);

  /// int z.(u - (1/mu) A f) dG for each density z: the velocity that a discrete f leaves over, at Gauss points away from the collocation sites,
  /// weighted (2.11). By the reciprocal theorem it is what int z_exact.f lacks, to the product of the errors of f and z: with z the density of a
  /// translation (a rotation) of unit size it is what the force (the torque) of f lacks. The remaining error is the fitted surface's own.
  /// In a channel what is left on the wall counts as well (2.42).
  /// `u`: the velocity itself at points of `surface`, a row each, not its interpolation.
  Eigen::VectorXd residual_work(const std::function<Net(const Net& x)>& u, const Net& f, std::span<const Net> z);

  Vec3 force(const Net& f) const;                          ///< int f dG
  Vec3 torque(const Net& f, const Vec3& centre) const;     ///< int (x - centre) x f dG
  Mat3 stresslet(const Net& f, const Vec3& centre) const;  ///< symmetric, traceless part of int f (x - centre) dG

  /// Control values c of n, by projection: the density that no velocity tells of.
  const Net& normal() const { return normal_; }

  stokes::Evaluations kernel_evaluations() const;  ///< of everything so far
  int last_iterations() const { return last_iterations_; }
  long solver_iterations() const { return iterations_; }
  void forget_recycled() const;  ///< discards what preconditioners `recycled`, that of the wall too, keep from earlier solves
  const Net& surface() const { return surface_; }

 private:
  void place_images();
  void factor();
  Net apply(const Net& f) const;
  const BetweenSites& between();

  const spline::Space& space_;
  Net surface_;
  double viscosity_;
  quadrature::Options quadrature_;
  Ranks& ranks_;
  Phases& phases_;
  std::vector<int> own_points_;
  stokes::Layer layer_;
  Eigen::SparseMatrix<double> sites_;  // R
  membrane::DirectSolver collocation_;
  Eigen::SparseMatrix<double> mass_;
  Net flux_, normal_;  // b and c
  double weight_ = 0;  // s / (b.c)
  stokes::Rows<double> rows_;
  Tube* tube_;
  std::optional<stokes::PlaneWall> wall_;
  std::optional<stokes::Layer> images_;  // in space
  stokes::Rows<double> image_rows_;      // the same
  bool in_front_ = true;
  std::optional<DenseFactors> factors_;  // of R times the operator that is solved, in a tube of the body alone; of a body of few points
  Net place_;                     // in space
  Mat3 turn_ = Mat3::Identity();  // from surface_ to place_
  Krylov krylov_;
  double tolerance_;
  long iterations_ = 0;
  int last_iterations_ = 0;
  stokes::Evaluations residual_evaluations_;
  std::optional<BetweenSites> between_;  // made when first asked for
};

}  // namespace tanktread::coupling
