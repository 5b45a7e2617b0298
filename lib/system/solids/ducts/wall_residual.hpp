#pragma once
// Residual velocity on the wall of a duct between the collocation points.

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "stokes/layer.hpp"
#include "system/solids/ducts/tube.hpp"

namespace tanktread::coupling {

struct BetweenSites;

/// Discretisation error of the response of a tube to a load, which the collocation-error correction (2.42) needs: the velocity on the wall at Gauss
/// points between the collocation points, and the flow rate of the disturbance through the inlet. Both vanish for the exact response. Calls are
/// collective.
class WallResidual {
 public:
  explicit WallResidual(Tube& tube);  ///< `tube` must outlive this object

  void set_load(const Net& f);  ///< computes the errors of the response to the load f at the current shape of the tube

  /// Returns the contribution of the wall and the inlet to (2.42): the inner product of f^D and the velocity, minus dp times the flow rate. `of`:
  /// response (f^D, dp) to another load.
  double work(const Tube::Response& of) const;

  stokes::Evaluations evaluations() const { return layer_.evaluations(); }

 private:
  WallResidual(Tube& tube, const BetweenSites& between);

  Tube& tube_;
  Net at_;                               // positions of the Gauss points
  Eigen::SparseMatrix<double> weights_;  // see BetweenSites
  stokes::Layer layer_;                  // single layer of the wall at the Gauss points
  Net velocity_;                         // int N_A u dGamma over the wall, with u the velocity at the Gauss points
  double flow_ = 0;                      // flow rate through the inlet
};

}  // namespace tanktread::coupling
