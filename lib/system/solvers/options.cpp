#include "system/solvers/options.hpp"

#include <Teuchos_ParameterList.hpp>

#include "deck/section.hpp"

namespace tanktread::coupling {

void VolumeOptions::declare(deck::Section& section) {
  section.key(
      "constraint", constraint, deck::Choice{"exact", "flux", "none"},
      "`flux`: no net flux through the surface in every evaluation (2.8); `exact`: that, and the volume restored after every step; `none`");
}

void InterfaceOptions::declare(deck::Section& section) {
  section.key("motion", motion, deck::Choice{"material", "normal", "relaxed"},
              "control points of a drop move with the fluid, across the interface only, or along it so that elements keep their shape (the "
              "default for a surface tension)");
  section.key("relaxation", relaxation, deck::not_negative(), "1",
              "`relaxed`: the mesh slides as an elastic bag of capillary number 1/relaxation would");
}

void IterativeOptions::declare(deck::Section& section) {
  path = section.path();
  section.key("iterative solver", solver, deck::Choice{}, "Belos' name of its solver, in place of Solvers/iterative solver");
  section.foreign("Belos", belos, "list handed to it as it is, in place of Solvers/Belos");
  section.key("preconditioner", preconditioner, deck::Choice{"own", "none", "neumann", "recycled"},
              "`own`: what the system brings (rigid bodies inverted alone and across films; the blocks of Solvers/tube), or none; `neumann`: "
              "2 - A for the system A, scaled, a product more in each application; `recycled`: what products of the solves before tell, and "
              "elsewhere `own`");
}

IterativeOptions SolverOptions::of(IterativeOptions system) const {
  const bool own_list = system.belos && system.belos->numParams() > 0;
  if (!system.solver && !own_list) system.belos = belos;
  if (!system.solver) system.solver = krylov;
  return system;
}

void SolverOptions::declare(deck::Section& section) {
  section.key("iterative solver", krylov, deck::Choice{}, "Belos' name of the iterative solver of linear systems");
  section.foreign("Belos", belos, "list handed to the iterative solver as it is; what it says, and how, cannot be set");
  section.section("velocity", velocity, "the system of a velocity: viscosity ratio other than 1, rigid bodies among others, the blocks in a tube");
  section.section("traction", traction, "the system of the traction of a single rigid particle, and of its motion in a tube");
  section.section("implicit step", implicit_step, "the system of an implicit step");
  section.section("spectrum", spectrum, "the shift-inverted system of Spectrum/method `krylov`");
  section.section("steady", steady, "the system of a Newton step of Steady/method `newton-krylov`");
  section.foreign("NOX", nox,
                  "list handed as it is to the nonlinear solver: of Steady, and of Time/scheme `crank-nicolson`, where that is not `plain`");
  section.key("tolerance", tolerance, deck::between(1e-15, 1e-1), "1",
              "relative residual of the systems that a velocity (viscosity ratio other than 1) or a traction (rigid particle) comes from");
  section.key("double layer", double_layer, deck::Choice{"auto", "assembled", "matrix-free"},
              "viscosity ratio other than 1: `assembled` once a velocity, or summed in every iteration of its solver; `auto`: the latter where far "
              "sums are taken by clusters and there are no rigid bodies, or more than 1 GB of it");
  section.key("tube", tube, deck::Choice{"schur", "block triangular", "block diagonal", "block"},
              "in a tube: `schur` solves for the particle's velocity alone, wall and pressure drop eliminated by the factored wall (nothing is "
              "left to solve at viscosity ratio 1); the others solve for all blocks (2.5)-(2.8) at once, preconditioned by the factored wall or "
              "(`block`) not at all");
  section.key("wall", wall, deck::Choice{"auto", "factored", "iterative"},
              "of a Channel: `factored` once, or `iterative`, found by GMRES and clusters in each velocity and left out of the Jacobian; "
              "`auto`: the latter where the factors would take more than 4 GB");
  section.key("rigid bodies", rigid_bodies, deck::Choice{"second kind", "first kind"},
              "several: `second kind`, by a double layer (2.23), an iterative solver and clusters; or, where all particles are rigid, `first kind`, "
              "by their tractions (2.40), dense and factored at every place, whose forces and motions are far more accurate in films");
  section.key("projection", projection, deck::Choice{"collocation", "least squares"},
              "of velocities onto the splines: one place a control point, or the best fit to four places an element, whose error falls with the "
              "sixth power of the element in place of the fourth, for four times the kernel evaluations; the latter not in a tube or with rigid "
              "bodies");
  section.key("frozen operator", frozen_operator, deck::Choice{"nodal", "assembled"},
              "the single layer that the Jacobian (4.3) keeps: one node a control point, summed in every product, with corrections for near ones; or "
              "assembled, 12 bytes a pair of points");
  direct.declare(section);
}

}  // namespace tanktread::coupling
