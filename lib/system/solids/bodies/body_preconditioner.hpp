#pragma once
// Preconditioner of the system of all particles: inverses for isolated rigid bodies, and for films between pairs of bodies.

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "base/dense_factors.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "stokes/layer.hpp"
#include "system/solids/bodies/rigid_particles.hpp"

namespace tanktread::coupling {

/// Inverse of the system (2.23) for each isolated rigid body. The inverse is stored in body-fixed axes, so that it remains valid when the body moves.
/// Equal bodies share an inverse. A body with more than `most_points` control points has no inverse. The inverse is stored in double precision,
/// because GMRES mistakes the rounding of single precision for a residual that does not decrease.
class OneBodyInverses {
 public:
  static constexpr int most_points = SelfCorrection::most_points;

  /// `rest`: control net of all particles, with the rigid bodies in their positions at rest.
  OneBodyInverses(std::span<const Particle> particles, const RigidParticles& bodies, const Net& rest, const quadrature::Options& quadrature);

  bool empty() const { return factors_.empty(); }
  bool has(std::size_t p) const { return of_particle(p) != nullptr; }  ///< returns whether the inverse of the system of particle p is stored

  /// Replaces control values by values at the collocation sites, in the rows of all bodies whose inverse is stored.
  void evaluate_at_sites(Net& y) const;

  /// Solves the system (2.23) of every isolated body whose inverse is stored. In the rows of the body, y has the right-hand sides at the collocation
  /// sites on entry, and the control values of the solution on return. `placed`: current positions of the bodies.
  void solve(const RigidParticles& placed, Net& y) const;

  /// Returns the columns of the inverse of the system (2.23) of particle p that belong to right-hand sides at `sites`; shape (3 points, 3 sites).
  Eigen::MatrixXd columns(const RigidParticles& placed, std::size_t p, std::span<const int> sites) const;

 private:
  struct Factors {
    bool prescribed;
    Eigen::SparseMatrix<double> sites;  // collocation matrix R
    Eigen::MatrixXd inverse;
  };
  struct Use {
    std::size_t particle;
    spline::Block block;
    std::shared_ptr<const Factors> factors;
  };
  const Use* of_particle(std::size_t p) const;
  static std::shared_ptr<const Factors> inverted(const Particle& particle, const RigidParticles& bodies, std::size_t p, const Net& own,
                                                 const quadrature::Options& quadrature);

  std::vector<Use> factors_;
};

/// Inverses for the films between pairs of bodies. A mode of the density w (2.23) with wave number k that is equal on both sides of a film of width h
/// has an eigenvalue of the order of k h, even after preconditioning by OneBodyInverses. Small eigenvalues slow GMRES. Let M_q be the operator of the
/// isolated body q, and D_pq the double layer of body q at the sites of body p times -1. The effect of q on p is C_pq = -D_pq M_q^-1. The matrix C
/// consists of C_pq and C_qp, restricted to the sites of the film between p and q. The matrix 1 + C is factored for each pair of bodies, and
///
///   (1 + C)^-1 - 1
///
/// is added to the preconditioner of the isolated bodies (additive Schwarz; Smith, Bjørstad & Gropp 1996, chapter 1). Two films of one body are
/// assumed to have no sites in common; if they do, the solver needs more iterations, but its result is the same.
class FilmInverses {
 public:
  /// Returns the rows of the double layer times -1 for the sites `targets`, three rows per site, in the order of `targets`; shape (3 targets, 3 N).
  using RowsOf = std::function<stokes::Rows<double>(std::span<const int> targets)>;

  /// `x`: net of all particles. Films (thin layers of fluid between two bodies) are set up only for pairs of bodies that both have an inverse in
  /// `alone`, the inverses for isolated bodies.
  FilmInverses(std::span<const Particle> particles, const OneBodyInverses& alone, const RigidParticles& placed, const Net& x, const RowsOf& rows_of);

  /// Adds ((1 + C)^-1 - 1) y to the values y at the sites of each film, where C is the coupling of the two bodies by their double layers (see above).
  void add(Net& y) const;

 private:
  struct Film {
    std::vector<int> sites;         // indices of the collocation sites next to the film: sites of the first body, then sites of the second body
    DenseFactors one_and_coupling;  // LU factors of 1 + C
  };
  std::vector<Film> films_;
};

}  // namespace tanktread::coupling
