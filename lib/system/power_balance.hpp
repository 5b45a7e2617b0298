#pragma once
// What the flow and forces do to the particles, and where it goes.

#include <optional>
#include <vector>

#include <Eigen/SparseCore>

#include "base/columns.hpp"
#include "base/types.hpp"
#include "membrane/mass.hpp"
#include "quadrature/options.hpp"
#include "stokes/layer.hpp"
#include "system/capsule.hpp"
#include "system/ranks.hpp"

namespace tanktread::coupling {

/// Powers at one moment, force x velocity, of all particles.
struct Powers {
  double flow = 0;         ///< that the ambient flow puts in beyond what the fluid alone would take (6.11)
  double forces = 0;       ///< of weights, forces on membranes and bodies, and contacts
  double storing = 0;      ///< rate of the energy of the membranes
  double membranes = 0;    ///< dissipated in them
  double fluids = 0;       ///< dissipated in the fluids, beyond what the ambient flow would dissipate everywhere: the rest of these (6.12)
  double left_over = 0;    ///< of what the velocities miss of (2.22) between the collocation sites (6.13)

  void add_columns(Columns& to) const;
};

/// Of (6.12) half the sum of the magnitudes of what flow and forces put in, of what the fluids dissipate, and of the rest: what is put in where
/// all that is dissipated or stored is positive.
double turnover(double flow, double forces, double fluids);

/// The balance of power of particles that deform, and of rigid bodies among them, in affine flows or a tube.
class PowerBalance {
 public:
  /// Of the system's particles on their present meshes. What is given by reference outlives this.
  PowerBalance(Capsule& capsule, const spline::Space& space, const Net& unstressed, double viscosity, const quadrature::Options& quadrature,
               const std::optional<stokes::PlaneWall>& wall, const Ranks& ranks);

  /// At x, where control points move by `slope`. One evaluation of the layers at 2 x 2 Gauss points of each element. Collective.
  Powers operator()(const Net& x, const Net& slope);

 private:
  double left_over(const Net& load, const Net& left, const Net& x, const Net& measured) const;
  Net missed(Evaluation& e, Net v, Net density, const Net& load);
  Net density(const Net& v, const RigidParticles& rigid) const;
  double of_flow(Evaluation& e, const Net& work, const Net& inside);

  Capsule& capsule_;
  const spline::Space& space_;
  double viscosity_;
  const Ranks& ranks_;
  stokes::Sites places_;
  Eigen::SparseMatrix<double> values_;  // N_A there
  membrane::MassMatrix mass_;
  stokes::Layer single_;
  std::optional<stokes::Layer> double_;
};

}  // namespace tanktread::coupling
