#pragma once
// Power balance: power input by the flow and by forces, rate of change of stored energy, and dissipation.

#include <optional>

#include <Eigen/SparseCore>

#include "base/columns.hpp"
#include "base/types.hpp"
#include "membrane/mass.hpp"
#include "system/capsule.hpp"
#include "system/targets/layers_at.hpp"
#include "system/parallel/ranks.hpp"

namespace tanktread::coupling {

/// Powers of all particles at one time, force x velocity.
struct Powers {
  double flow = 0;         ///< power input of the ambient flow minus its input without particles (6.11)
  double forces = 0;       ///< power input of weight, of forces on membranes and bodies, and of contact forces
  double storing = 0;      ///< rate of change of the energy stored in the membranes
  double membranes = 0;    ///< dissipation in the membranes
  double fluids = 0;       ///< dissipation in the fluids minus dissipation in the ambient flow, computed as the remainder of the balance (6.12)
  /// integral of |Df| |v| + viscosity x |v|^2/R_C over all surfaces, with the load Df and the velocity v: the powers are sums of contributions of
  /// this size, which may cancel
  double scale = 0;
  double residual = 0;     ///< power of the residual velocity of the boundary integral equation at 2 x 2 Gauss points per element (6.13)

  void add_columns(Columns& to) const;
};

/// Returns half the sum of the magnitudes of four terms of (6.12): the power inputs by the flow and by forces, the dissipation in the fluids, and the
/// remainder flow + forces - fluids. Equals the power input if no term is negative.
double turnover(double flow, double forces, double fluids);

/// Evaluates the power balance of deformable particles, and of rigid bodies among them, in affine and parabolic flows, in a tube or among plates and
/// posts.
class PowerBalance {
 public:
  /// `capsule`: the system with its particles on their current meshes. References must outlive this object.
  PowerBalance(Capsule& capsule, const Ranks& ranks);

  /// Returns the powers at x, where control points move with the velocity `slope`. Evaluates the layers once at 2 x 2 Gauss points per element.
  /// Collective.
  Powers operator()(const Net& x, const Net& slope);

 private:
  double residual_power(const Net& load, const Net& residual_velocity, const Net& x, const Net& measured) const;
  Net residual_velocity(Evaluation& e, Net v, const RigidParticles& rigid, const Net& load);
  Net density(const Net& v, const RigidParticles& rigid) const;
  double flow_power(Evaluation& e, const Net& work, const Net& inside);

  Capsule& capsule_;
  const spline::Space& space_;
  stokes::Sites gauss_points_;
  Eigen::SparseMatrix<double> values_;  // N_A at `gauss_points_`
  membrane::MassMatrix mass_;
  LayersBetween layers_;
};

}  // namespace tanktread::coupling
