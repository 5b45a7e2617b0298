#pragma once
// Parameters of a Capsule, and counts of its operations.

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "quadrature/options.hpp"
#include "stokes/medium/medium.hpp"
#include "stokes/medium/periodic_images.hpp"
#include "surface/symmetry.hpp"
#include "system/particle.hpp"
#include "system/solids/plates/solid_response.hpp"
#include "system/solvers/options.hpp"
#include "system/options.hpp"

namespace tanktread::coupling {

/// Counts of operations, as a measure of cost that does not depend on the machine.
struct OperationCounts {
  long evaluations = 0;        ///< velocity evaluations (4.2)
  long assemblies = 0;         ///< assemblies of the frozen layer operators (4.3)
  long tangents = 0;           ///< evaluations of the membrane tangent
  long solves = 0;             ///< linear solves of the implicit step
  long solver_iterations = 0;  ///< iterations of linear solves with the Jacobian, including inner solves with B (4.3)
  long velocity_iterations = 0;  ///< iterations of the linear systems for velocities or tractions
  long velocity_solves = 0;      ///< solves of the linear systems for velocities or tractions
  long most_velocity_iterations = 0;  ///< largest number of iterations of one velocity or traction solve
};

static_assert(sizeof(OperationCounts) == 8 * sizeof(long), "add the new count to the sum below, to each_count() and to counts() of free bodies");
inline OperationCounts operator+(OperationCounts a, const OperationCounts& b) {
  using Of = OperationCounts;
  for (long Of::*count : {&Of::evaluations, &Of::assemblies, &Of::tangents, &Of::solves, &Of::solver_iterations, &Of::velocity_iterations,
                          &Of::velocity_solves})
    a.*count += b.*count;
  a.most_velocity_iterations = std::max(a.most_velocity_iterations, b.most_velocity_iterations);
  return a;
}

class UserEquation;
struct ParticlesAtRest;
using UserEquationMaker = std::function<std::shared_ptr<const UserEquation>(const ParticlesAtRest&)>;

/// Particles, medium and solver options of a Capsule.
struct CapsuleParameters {
  double viscosity = 1;                                          ///< mu of the outer fluid
  std::vector<Particle> particles{1};                            ///< particles in stacking order; the space of a single particle need not be set
  bool strong_load = false;  ///< true: membrane load from the strong form -div_s tau; false: from virtual work (3.5)
  VolumeOptions volume;
  SolverOptions solvers;
  quadrature::Options quadrature;
  std::optional<stokes::PeriodicCell> cell;  ///< cell of the lattice at time zero, if any. The flow deforms it, unless it has walls or posts
  std::shared_ptr<const stokes::Medium> medium;  ///< for example a plane wall; null in unbounded fluid, a lattice or a tube
  std::optional<SolidScene> solids;          ///< plates and posts in the cell
  std::vector<UserEquationMaker> equations;  ///< equations that the program adds (system/equations/user_equation.hpp)
  surface::Symmetry symmetry;  ///< common symmetry of the flow, the space and all shapes to be evaluated; Symmetry() if there is none

  bool any_rigid() const { return std::ranges::any_of(particles, [](const Particle& one) { return one.rigid.has_value(); }); }
};

}  // namespace tanktread::coupling
