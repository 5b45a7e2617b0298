#pragma once
// What two rigid bodies do to each other across the film between them, as a preconditioner of the system of all.

#include <functional>
#include <span>
#include <vector>

#include "base/dense_factors.hpp"
#include "base/types.hpp"
#include "stokes/layer.hpp"
#include "system/solids/one_body.hpp"

namespace tanktread::coupling {

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
