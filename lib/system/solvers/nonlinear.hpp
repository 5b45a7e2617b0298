#pragma once
// Nonlinear systems by NOX, on short replicated vectors.

#include <algorithm>
#include <functional>
#include <memory>
#include <string>

#include "base/types.hpp"
#include "system/solvers/options.hpp"

namespace Teuchos {
class ParameterList;
}

namespace tanktread::coupling {

/// What a nonlinear solve did.
struct NonlinearReport {
  int iterations = 0;
  bool converged = false;
};

/// A fixed point x = g(x) by NOX. Every rank does the same arithmetic on the whole short vector, so iteration counts cannot differ between
/// ranks; g may be distributed inside and must return the same net on every rank.
class FixedPoint {
 public:
  using Map = std::function<Net(const Net&)>;
  using Norm = std::function<double(const Net&)>;
  /// Iterates combined for a shape of so many numbers at rest: near a fold, and where waves go round, four do not converge, and on fine meshes not
  /// twenty; on coarse ones forty are dependent.
  static int deep(Eigen::Index size) { return std::clamp(static_cast<int>(size / 64), 20, 40); }

  /// `method`: `anderson` (Anderson 1965; Walker & Ni 2011) or `newton-krylov` without a matrix: products with dg/dx by differences of g, Belos'
  /// solver `linear` with its preconditioner, own meaning none. `list` goes to NOX as it is, after our defaults; `depth`: of the iterates that
  /// `anderson` combines, where the list does not say.
  FixedPoint(std::string method, const std::shared_ptr<Teuchos::ParameterList>& list, const IterativeOptions& linear = {"GMRES"}, int depth = 4);
  ~FixedPoint();

  /// From x on, until rest(g(x) - x) <= tolerance, rest being `norm` where it is not given, or `most` iterations are over. Collective. A value of g
  /// that is not finite ends the iteration.
  /// Throws UserError where NOX refuses the list.
  NonlinearReport solve(const Map& g, const Norm& norm, double tolerance, int most, Net& x, const Norm& rest = {}) const;

  /// The path of a parameter of the given list that the last solve has not looked at; empty: none.
  std::string unread() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tanktread::coupling
