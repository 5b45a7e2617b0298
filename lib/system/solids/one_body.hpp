#pragma once
// What a rigid body would do alone, as a preconditioner of the system of all.

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
#include "system/solids/rigid_particles.hpp"

namespace tanktread::coupling {

/// Inverses of (2.23) for each rigid body alone, in its own axes: they serve wherever it goes, and equal bodies have them in common. A body of
/// more than `most_points` control points goes without. Not in single precision, whose rounding GMRES takes for a residual that does not fall.
class OneBodyInverses {
 public:
  static constexpr int most_points = 2000;

  /// `rest`: net of all particles, where `bodies` were at rest.
  OneBodyInverses(std::span<const Particle> particles, const RigidParticles& bodies, const Net& rest, const quadrature::Options& quadrature);

  bool empty() const { return factors_.empty(); }

  bool serves(std::size_t p) const { return of_particle(p) != nullptr; }

  /// Rows of bodies become the values at their sites of what they are control values of.
  void take_to_sites(Net& y) const;

  /// Rows of bodies, right-hand sides at sites, become what each alone would have for them. `placed`: where the bodies are.
  void solve(const RigidParticles& placed, Net& y) const;

  /// Columns of the inverse of particle p, those of a right-hand side at `sites`; shape (3 points, 3 sites).
  Eigen::MatrixXd columns(const RigidParticles& placed, std::size_t p, std::span<const int> sites) const;

 private:
  struct Factors {
    bool prescribed;
    Eigen::SparseMatrix<double> sites;  // R
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

/// Waves of w with wave number k that are alike on both sides of a film of width h have eigenvalues of the order of k h, whatever each body alone has
/// been inverted for. With M_p of body p alone, and C_pq = -H_pq M_q^-1 what q does to p, both taken at the sites of a film alone,
///
///   1 + C on those sites
///
/// is factored for each pair of bodies, and its inverse less 1 is added to what is done for the bodies alone (additive Schwarz; Smith, Bjørstad &
/// Gropp 1996, chapter 1). Films of a body are taken to have no sites in common, which is right or costs iterations.
class FilmInverses {
 public:
  /// Rows `targets` of H, three a target, in their order; shape (3 targets, 3 N).
  using RowsOf = std::function<stokes::Rows<double>(std::span<const int> targets)>;

  /// `x`: net of all particles; of the pairs of those that `alone` serves.
  FilmInverses(std::span<const Particle> particles, const OneBodyInverses& alone, const RigidParticles& placed, const Net& x, const RowsOf& rows_of);

  /// Adds ((1 + C)^-1 - 1) y to y at sites.
  void add(Net& y) const;

 private:
  struct Film {
    std::vector<int> sites;         // of the one body, then of the other
    DenseFactors one_and_coupling;  // 1 + C
  };
  std::vector<Film> films_;
};

}  // namespace tanktread::coupling
