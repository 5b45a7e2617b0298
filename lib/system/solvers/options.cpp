#include "system/solvers/options.hpp"

#include <Teuchos_ParameterList.hpp>

#include "deck/section.hpp"

namespace tanktread::coupling {

void IterativeOptions::declare(deck::Section& section) {
  path = section.path();
  section.key("iterative solver", solver, deck::Choice{},
              "name of the iterative solver in Belos (a package of Trilinos), for example `GMRES` or `BICGSTAB`, for the linear system "
              "of this section; Solvers/iterative solver if not given");
  section.foreign("Belos", belos,
                  "parameters that are passed unchanged to the iterative solver in Belos (a package of Trilinos) of the linear system "
                  "of this section, instead of Solvers/Belos");
  section.key("preconditioner", preconditioner, deck::Choice{"own", "none", "recycled"},
              "preconditioner of the iterative solver for the linear system of this section; change it if solves take many iterations. "
              "`own`: the one built into the program, if it has one for this system (for several rigid bodies: the inverse of the system "
              "of each body alone, and of each pair of bodies with a thin film between them; in a tube: see Solvers/tube). `none`: no "
              "preconditioner. `recycled`: exact for directions whose products with the matrix are known from earlier solves, and `own` for "
              "the remainder");
}

IterativeOptions SolverOptions::of(IterativeOptions system) const {
  const bool own_list = system.belos && system.belos->numParams() > 0;
  if (!system.solver && !own_list) system.belos = belos;
  if (!system.solver) system.solver = krylov;
  return system;
}

void SolverOptions::declare(deck::Section& section) {
  section.key("iterative solver", krylov, deck::Choice{},
              "name of the iterative linear solver in Belos (a package of Trilinos), for example `GMRES` or `BICGSTAB`. It is used for "
              "every linear system for which no other solver is set in its own section of Solvers");
  section.foreign("Belos", belos,
                  "parameters that are passed unchanged to the iterative solver of Belos, a package of Trilinos. Verbosity, Output Style and Output "
                  "Frequency cannot be set");
  section.section("velocity", velocity,
                  "linear system for the velocity: with a viscosity ratio other than 1, rigid bodies among other particles, Solvers/tube other than "
                  "`schur`, or Solvers/volume `multipliers`");
  section.section("traction", traction, "linear system for the traction on a single rigid particle in a tube");
  section.section("implicit step", implicit_step, "linear system of an implicit time step");
  section.section("spectrum", spectrum, "shift-inverted linear system of Spectrum/method `krylov`");
  section.section("steady", steady, "linear system of a Newton step of Steady/method `newton-krylov`");
  section.foreign("NOX", nox,
                  "parameters that are passed unchanged to NOX, the nonlinear solvers of Trilinos: for Steady, and for Time/scheme `crank-nicolson` "
                  "with a Time/nonlinear solver other than `plain`");
  section.key("tolerance", tolerance, deck::between(1e-15, 1e-1), "1",
              "relative residual to which the linear systems for velocities (viscosity ratio other than 1) and for tractions (rigid "
              "particles, Solvers/wall `iterative`) are solved. Keep it well below Quadrature/tolerance. Velocities that are recorded after implicit "
              "steps are solved for to a tenth of the error that Time/tolerance allows, if that is larger");
  section.key("double layer", double_layer, deck::Choice{"auto", "assembled", "matrix-free"},
              "treatment of the double-layer operator in the linear systems for velocities with a viscosity ratio other than 1. `assembled`: a "
              "matrix, assembled once per velocity. `matrix-free`: summed in every iteration of the solver, which needs less memory. `auto`: "
              "`matrix-free` if far sums are evaluated by `tree` (Quadrature/far sum), unless there are rigid bodies and the matrix takes less "
              "than 1 GB, and for velocities that are needed only roughly. In a Domain without a tube it is always `matrix-free`");
  if (in_lattice && double_layer == "assembled") section.without_effect({"double layer"}, "in a Domain without a tube");
  section.key("tube", tube, deck::Choice{"schur", "block triangular", "block diagonal", "block"},
              "form of the linear system for the velocity in a tube. `schur`: only the particle's velocity is unknown; the wall traction and "
              "pressure drop are eliminated with the LU factors of the wall, so that no system remains to be solved at viscosity ratio 1. "
              "`block triangular`, `block diagonal`, `block`: wall traction and pressure drop are unknown, too, and, unless Solvers/volume says "
              "otherwise, the multipliers of the volumes; the LU factors of the wall are the preconditioner, except for `block`, which has none");
  section.key("volume", volume, deck::Choice{"auto", "projection", "multipliers"},
              "constant volumes in the linear system for the velocity (2.8). `projection`: the volume constraints are eliminated by a projection of "
              "the velocities. `multipliers`: one Lagrange multiplier per deformable particle is an unknown of the system, which is then solved "
              "even at viscosity ratio 1. `auto`: `multipliers` only with Solvers/tube other than `schur`. With the tractions on rigid bodies as "
              "unknowns (Solvers/rigid bodies `first kind`), the volumes are always eliminated");
  section.key("wall", wall, deck::Choice{"auto", "factored", "iterative"},
              "solver of the linear system for the traction on the wall of a Channel. `factored`: LU factors, computed once. `iterative`: "
              "GMRES for each velocity, with sums over clusters of nodes; the wall is then neglected in the Jacobian. `auto`: `iterative` if "
              "the factors would take more than 4 GB");
  if (!in_duct) section.without_effect({"tube"}, "without Tube or Channel"), section.without_effect({"wall"}, "without Channel");
  section.key(
      "rigid bodies", rigid_bodies, deck::Choice{"auto", "second kind", "first kind"},
      "boundary integral equation for rigid bodies. `second kind`: double-layer equation (2.23), solved iteratively, for many bodies. `first "
      "kind`: dense system for the tractions (2.40), factored for every configuration; far more accurate if gaps are small. `auto`: `first "
      "kind` in time-dependent runs for two to four rigid bodies with at most 1500 control points together at the start, all with "
      "Adaptation/enabled or with Quadrature/tolerance at most 1e-7; for one rigid body of at most 2000 control points as the only particle, "
      "in a Tube or Channel with Solvers/tube `schur`, or between walls or posts in a Domain if its motion is prescribed. Otherwise `second kind`");
  section.key("projection", projection, deck::Choice{"collocation", "least squares"},
              "projection of velocities onto the splines of the surface. `collocation`: one site per control point, error O(h^4) with the "
              "element length h. `least squares`: best fit at four sites per element, error O(h^6), four times the kernel evaluations; not "
              "in a tube, at a wall or with rigid bodies");
  section.key("frozen operator", frozen_operator, deck::Choice{"auto", "nodal", "assembled"},
              "storage of the single-layer operator in the approximate Jacobian of implicit time steps, which is kept over several steps "
              "(4.3). `nodal`: matrix-free sums over one quadrature node per control point, with near-field corrections. `assembled`: a full "
              "matrix, 12 bytes per pair of points. `auto`: `assembled` with a viscosity ratio other than 1 and fewer than 4000 control points "
              "together, otherwise `nodal`");
  direct.declare(section);
}

}  // namespace tanktread::coupling
