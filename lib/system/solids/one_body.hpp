#pragma once
// What a rigid body would do alone, as a preconditioner of the system of all.

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "quadrature/options.hpp"
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

}  // namespace tanktread::coupling
