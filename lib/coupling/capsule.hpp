#pragma once
// A capsule or drop of the outer fluid's viscosity in unbounded flow: fluid and membrane meet here.

#include <memory>
#include <span>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "coupling/dynamics.hpp"
#include "coupling/frozen_operator.hpp"
#include "coupling/krylov.hpp"
#include "coupling/options.hpp"
#include "coupling/ranks.hpp"
#include "membrane/direct_solver.hpp"
#include "membrane/mass.hpp"
#include "membrane/membrane.hpp"
#include "membrane/options.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/ambient_flow.hpp"
#include "stokes/single_layer.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {

/// Work in units that do not depend on the machine.
struct Work {
  long evaluations = 0;        ///< velocity evaluations (4.2)
  long assemblies = 0;         ///< of the frozen layer operator (4.3)
  long tangents = 0;           ///< of the membrane
  long solves = 0;             ///< linear solves of the implicit step
  long solver_iterations = 0;  ///< of all of them
};

/// What a capsule is made of and how it is solved.
struct CapsuleParameters {
  double viscosity = 1;  ///< mu of both fluids
  double radius = 1;     ///< R_C
  membrane::Law law;
  bool strong_load = false;                                      ///< (P-3) at the collocation sites instead of (3.5)
  stokes::Measure measure = stokes::Measure::reference;          ///< of the weak load: (3.7) or (3.6)
  VolumeOptions volume;
  SolverOptions solvers;
  quadrature::Options quadrature;
};

/// dx/dt = v(x), lambda = 1, no wall: nothing has to be assembled or solved for the velocity (2.4), (4.2)
///
///   v(x) = v_inf - R^{-1} A M0^{-1} dE/dx,  then v <- v - (b.v / b.c) c,  b = dV/dx, c = M0^{-1} b         (2.8)
class Capsule : public Dynamics {
 public:
  /// `unstressed` and `initial`: control nets of shape (N, 3) on `space`; the volume of `initial` is the one to be kept.
  Capsule(const spline::Space& space, const Net& unstressed, const Net& initial, const stokes::AmbientFlow& flow,
          const CapsuleParameters& parameters, Ranks& ranks, Phases& phases);
  ~Capsule() override;

  Net velocity(const Net& x) override;
  void freeze(const Net& x) override;
  void linearise(const Net& x) override;
  Net solve(double shift, const Net& r, double tolerance) override;
  void restore_volume(Net& x) override;
  double norm(const Net& displacement) const override;

  /// Load of the fluids on the membrane, as control values: per unstressed area or per current area, as parameters say.
  Net load(const Net& x);

  /// Particle stresslet S_ij = int (df_i x_j + df_j x_i)/2 - delta_ij/3 df.x dG (lambda = 1), force times length.
  Mat3 stresslet(const Net& x);

  double volume_error(const Net& x) const;  ///< V/V0 - 1
  const membrane::Membrane& membrane() const { return membrane_; }
  const stokes::SingleLayer& single_layer() const { return layer_; }
  const surface::Geometry& geometry() const { return geometry_; }
  const Work& work() const { return work_; }
  Work& work() { return work_; }

 private:
  Net ambient(const Net& x) const;
  Net energy_gradient(const Net& x);
  Net flux_vector(const Net& x);
  Net jacobian(const Net& delta);

  const spline::Space& space_;
  stokes::AmbientFlow flow_;
  CapsuleParameters parameters_;
  Ranks& ranks_;
  Phases& phases_;
  std::vector<int> own_points_, own_elements_;
  surface::Geometry geometry_;
  membrane::MassMatrix mass_matrix_;
  membrane::Membrane membrane_;
  membrane::Tangent tangent_;
  stokes::SingleLayer layer_;
  membrane::DirectSolver collocation_, mass_, current_mass_;
  Krylov krylov_;
  FrozenOperator frozen_;
  double volume0_ = 0;
  Work work_;
};

}  // namespace tanktread::coupling
