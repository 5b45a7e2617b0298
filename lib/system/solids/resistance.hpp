#pragma once
// Rigid surface in a fluid: computes the force density that produces a given velocity on the surface.

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
/// A is the single layer; its null vector is the normal n. f is therefore determined only up to a multiple of n (a constant pressure inside), and u
/// must have zero flux. With the collocation matrix R, the mass matrix M, the basis functions N_A, b_A = int N_A n dG, c = M^-1 b and a scale s, the
/// operator that is solved is R^-1 A + s c b^T / (b.c)   (2.10). It is regular, and gives the f with int f.n dG = 0. A flux of the interpolated u
/// changes only the multiple of c.
///
/// Near a plane wall the contribution of the images to A is assembled at each position (Layer::assemble_images), and the operator is factored there,
/// because GMRES alone does not converge for thin films.
///
/// In a tube A f - mu u(f) replaces A f, where u is the response of the wall and the pressure drop (2.5). The operator then depends on the position,
/// so that GMRES is used, preconditioned by the factors of the isolated body. Fields are always given in the axes of `surface`, wherever the body has
/// moved.
class Resistance {
 public:
  /// `surface`: control net. The constructor assembles the rank-owned rows of A in double precision; they are valid for any position and orientation.
  /// `tube`: tube around the body, or null; it and `space` must outlive this object. `wall`: plane wall near the body, optional.
  Resistance(const spline::Space& space, const Net& surface, double viscosity, const quadrature::Options& quadrature,
             const SolverOptions& solvers, Ranks& ranks, Phases& phases, Tube* tube = nullptr,
             const std::optional<stokes::PlaneWall>& wall = {});

  /// Sets the position of the body: its control net x in the laboratory frame, and the rotation `turn` from `surface` to x.
  void place(const Net& x, const Mat3& turn);

  /// Returns the control values, in body-fixed axes, of the ambient flow at the current position, interpolated at the collocation points.
  Net ambient(const stokes::AmbientFlow& flow) const;

  /// Returns the control values of a field on `surface`, interpolated at the collocation points. `values`: field at points, one row each.
  Net interpolated(const std::function<Net(const Net& x)>& values) const { return collocation_.solve(values(sites_ * surface_)); }

  /// Returns the control values of f for the control values u of a velocity. Throws RunFailure, with the residuals, if the solver stops early.
  Net force_density(const Net& u);

  /// Returns the velocity (1/mu) A f of a force density f, including the regularising term of (2.10).
  Net velocity(const Net& f) { return apply(f) / viscosity_; }

  /// Returns true if the surface in its current position is inside the tube (if there is a tube) and in front of the plane wall (if there is a wall).
  bool inside() const { return (!tube_ || tube_->gap() > 0) && in_front_; }

  const std::optional<stokes::PlaneWall>& wall() const { return wall_; }

  /// Returns the pressure drop of the tube for the force density f (2.7).
  double pressure_drop(const Net& f);

  /// Returns the correction (2.41) of pressure_drop(f) for collocation errors, if the flow is a duct flow. It is the sum of the interpolation error
  /// of v_inf and of `work`, the integral residual_work() for the velocity v_inf on the surface with z = f.
  double lacking_pressure(const stokes::AmbientFlow& flow, const Net& f, double work = 0);

  /// Returns the integral (2.11) of the collocation residual, int z.(u - (1/mu) A f) dG, for each density z, by Gauss points between the sites. f is
  /// the density collocated for the velocity u. By the reciprocal theorem, int z_exact.f is smaller than its exact value by this integral, up to the
  /// product of the errors of f and z. Example: if z is the density of a unit translation (rotation), the integral is the error of the force (torque)
  /// of f. The error of the fitted surface is not corrected. In a channel the residual on the wall is included (2.42). `u`: the exact velocity at
  /// points of `surface`, one row each, not its interpolation.
  Eigen::VectorXd residual_work(const std::function<Net(const Net& x)>& u, const Net& f, std::span<const Net> z);

  Vec3 force(const Net& f) const;                          ///< int f dG
  Vec3 torque(const Net& f, const Vec3& centre) const;     ///< int (x - centre) x f dG
  Mat3 stresslet(const Net& f, const Vec3& centre) const;  ///< symmetric, traceless part of int f (x - centre) dG

  /// Returns the control values of the normal n, fitted by projection. This density is the null vector of A: it produces no velocity.
  const Net& normal() const { return normal_; }

  stokes::Evaluations kernel_evaluations() const;  ///< total since construction
  int last_iterations() const { return last_iterations_; }
  long solver_iterations() const { return iterations_; }
  void forget_recycled() const;  ///< discards the data of earlier solves that the solvers for the body and for the tube's wall keep
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
  Eigen::SparseMatrix<double> sites_;  // collocation matrix R
  membrane::DirectSolver collocation_;
  Eigen::SparseMatrix<double> mass_;
  Net flux_, normal_;  // b and c
  double weight_ = 0;  // factor s / (b.c) of the regularising term c b^T in (2.10)
  stokes::Rows<double> rows_;
  Tube* tube_;
  std::optional<stokes::PlaneWall> wall_;
  std::optional<stokes::Layer> images_;  // layer of the body's images in the plane wall, in the laboratory frame
  stokes::Rows<double> image_rows_;      // rows of the images
  bool in_front_ = true;
  std::optional<DenseFactors> factors_;  // LU factors of R times the operator of (2.10), without the response of a tube; set only if there are few
                                         // control points
  Net place_;                     // net in the laboratory frame
  Mat3 turn_ = Mat3::Identity();  // rotation from surface_ to place_
  Krylov krylov_;
  double tolerance_;
  long iterations_ = 0;
  int last_iterations_ = 0;
  stokes::Evaluations residual_evaluations_;
  std::optional<BetweenSites> between_;  // constructed at first use
};

}  // namespace tanktread::coupling
