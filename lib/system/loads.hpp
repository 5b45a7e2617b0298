#pragma once
// The loads of all particles of a run.

#include <memory>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "membrane/load.hpp"
#include "system/particle.hpp"

namespace tanktread::coupling {

/// The loads of all particles, in addition to elasticity and bending, as one of the stacked nets: shape (N, 3), N control points of all. The caller
/// sums what the local functions give over ranks and images. The nets that several loads of one particle sum follow each other; loads of different
/// particles share them. Uses no MPI.
class Loads {
 public:
  Loads() = default;
  /// `elements`: those that this rank's sums run over, ascending.
  Loads(std::span<const Particle> particles, std::span<const int> elements);

  bool empty() const { return all_.empty(); }
  std::size_t n_sums() const { return n_sums_; }

  /// Adds the local part of dE/dx, and returns the sums that are to be completed.
  std::vector<Net> add_work(const Net& x, Net& work) const;
  void add_global_work(const Net& x, const std::vector<Net>& sums, Net& work) const;

  /// Returns the energy that the membrane of particle p stores by its loads.
  double energy(const Net& x, const std::vector<Net>& sums, std::size_t p) const;
  /// Adds dE/dx of loads that the membrane stores, from all elements.
  void add_stored_work(const Net& x, Net& work) const;

  void linearise(const Net& x, const std::vector<Net>& sums);
  void add_tangent(const Net& dx, Net& change) const;
  void add_global_tangent(const Net& dx, Net& change) const;

 private:
  struct One {
    std::size_t particle;
    spline::Block block;
    std::vector<int> elements;  // of this rank, from 0 at the particle's first
    std::shared_ptr<membrane::Load> load;
    std::size_t first_sum;

    std::vector<Net> own(const std::vector<Net>& sums) const;
  };
  std::vector<One> all_;
  std::size_t n_sums_ = 0;
};

}  // namespace tanktread::coupling
