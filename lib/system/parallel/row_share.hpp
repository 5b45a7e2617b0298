#pragma once
// Division of control points and elements among the ranks, and exchange of nets.

#include <span>
#include <string>
#include <vector>

#include "membrane/symmetric_solver.hpp"
#include "surface/partition.hpp"
#include "system/parallel/ranks.hpp"

namespace tanktread::coupling {

/// Division of the control points of all particles among the ranks. Each fundamental control point has one owner, which computes its row of a net.
/// The functions that exchange nets (one row per control point) return equal nets on all ranks; they are collective.
class RowShare {
 public:
  /// `space`, `symmetry` and `phases` must outlive this object. The time of all exchanges between ranks is recorded in `phases`. Collective.
  RowShare(const spline::Space& space, const surface::Symmetry& symmetry, Phases& phases);

  const Ranks& ranks() const { return ranks_; }
  const std::vector<int>& points() const { return share_.points; }      ///< rank-owned control points, ascending
  const std::vector<int>& touching() const { return share_.elements; }  ///< elements that touch the rank-owned points, ascending

  /// Returns the elements, ascending, over which this rank integrates before it calls replicate_sums(). These are the elements that touch points()
  /// or their symmetry images, but only one element of each symmetry orbit. If a symmetry other than the identity maps such an element onto itself,
  /// touching() is returned instead.
  const std::vector<int>& elements() const { return elements_; }

  /// Copies the rows that other ranks own from these ranks, and sets the rows of symmetry images.
  void replicate(Net& net) const { ranks_.replicate(net); }

  /// Completes integrals over elements() on all ranks. If only one element of each symmetry orbit contributes, first adds the integrals at image
  /// points to the fundamental points.
  void replicate_sums(Net& net) const;

  /// Gathers the result of an operator. If every rank computed a part of each far-field sum (`shared`), adds up the results of all ranks. Otherwise
  /// copies each row from the rank that owns it.
  void gather(bool shared, Net& net) const;

  void add(std::span<double> numbers) const { ranks_.add(numbers); }  ///< sums numbers over all ranks in place
  /// Returns the text of one of the ranks whose text is not empty; empty if there is none.
  std::string text_of_any(const std::string& mine) const { return error_of_any(mine); }

  /// Applies the inverse of the factored matrix a to each field in place. The columns of the fields are divided among the ranks.
  void solve(const membrane::SymmetricSolver& a, std::span<Net* const> fields) const;
  Net solved(const membrane::SymmetricSolver& a, Net field) const;

 private:
  const surface::Symmetry& symmetry_;
  Ranks ranks_;
  surface::Share share_;
  std::vector<int> elements_;
  bool folded_ = false;  // true if elements_ contains one element of each symmetry orbit
};

}  // namespace tanktread::coupling
