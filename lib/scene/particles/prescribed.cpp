#include "scene/particles/prescribed.hpp"

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "surface/geometry.hpp"
#include "system/solids/bodies/rigid_body.hpp"

namespace tanktread {

namespace {

double relative(const Vec3& value, const Vec3& exact) { return exact.norm() > 0 ? (value - exact).norm() / exact.norm() : RigidSolution::unknown; }

}  // namespace

void PrescribedRow::add_columns(const ParticleScene& particle_scene, Columns& to) const {
  add_size(measures, to);
  add_stresslet(solution.stresslet, to);
  add_points(n_points, to);
  add_drag(solution.force, solution.torque, to);
  const auto exact = exact_body(particle_scene);
  if (to.when(exact && exact->force().norm() > 0)) {
    to.add(solution.error,
           {"drag_error", "1",
            "relative error |F - F_exact|/|F_exact| of the force F on the particle, if the exact force is known and not zero"});
    to.add(solution.integral_error, {"drag_error_of_traction", "1",
                                     "relative error |F - F_exact|/|F_exact| of the force F on the particle if it is computed as the "
                                     "integral of the traction, without correction"});
  }
  if (to.when(exact && exact->torque().norm() > 0))
    to.add(solution.torque_error,
           {"torque_error", "1",
            "relative error |T - T_exact|/|T_exact| of the torque T on the particle, if the exact torque is known and not zero"});
  if (to.when(exact && exact->presses()))
    to.add(solution.surface.pressure, {"pressure_l2_error", "1",
                                       "relative error of the pressure p = -t.n on the surface, with traction t and normal n: L2 norm of p "
                                       "- p_exact divided by the L2 norm of p_exact, if p_exact is known (6.3)"});
  if (to.when(exact.has_value()))
    to.add(solution.surface.normal, {"normal_l2_error", "1",
                                     "relative error of the computed normal n_h: L2 norm of n_h - n divided by the L2 norm of the exact "
                                     "normal n, if it is known (6.3)"});
  to.add(kernel_evaluations,
         {"kernel_evaluations", "1", "number of evaluations of the Stokes kernels for the boundary integrals, by all quadrature rules"});
}

coupling::RigidTractions make_tractions(const ParticleScene& particle_scene, const Body& body, coupling::Ranks& ranks, coupling::Tube* tube) {
  const auto single = coupling::single_body(body.space, body.radius, particle_scene.flow.viscosity, particle_scene.quadrature, particle_scene.solvers,
                                            particle_scene.medium());
  if (tube) tube->set_particles(body.rest, single.particles);
  return {body.space, body.rest, body.rest, single, {tube}, {}, ranks};
}

RigidSolution rigid_solution(const ParticleScene& particle_scene, const Body& body, coupling::RigidTractions& tractions, Phases& phases) {
  const Vec3& centre = particle_scene.particle.shape.center;
  const coupling::RigidDrive driven{true, prescribed_motion(particle_scene)};
  coupling::Tube* const tube = tractions.tube();
  RigidSolution s;
  {
    const auto clock = phases.time("tractions");
    if (tube) tube->set_shape(body.rest);
    if (particle_scene.reciprocal_forces()) {
      tractions.solve(body.rest, {&centre, 1}, {&driven, 1}, body.flow);
      s.density = tractions.solution().unknowns;
    } else {
      tractions.set_shape(body.rest, {&centre, 1});
      s.density = tractions.density(coupling::rigid_velocity(tractions.sites(), driven.motion, centre) - body.flow.velocities(tractions.sites()));
    }
  }
  s.iterations = tractions.converged_iterations();
  const auto integrals = tractions.integrals(0, s.density);
  const auto corrected = particle_scene.reciprocal_forces() ? tractions.solution().bodies.front() : integrals;
  s.integral = -integrals.force;
  s.force = -corrected.force, s.torque = -corrected.torque;
  s.stresslet = -integrals.stresslet();
  if (tube) {
    s.pressure_drop = (particle_scene.reciprocal_forces() ? tractions.solution().pressure_correction : 0) - tube->pressure_of(s.density);
    return s;
  }
  if (const auto exact = exact_body(particle_scene)) {
    const auto clock = phases.time("diagnostics");
    s.error = relative(s.force, exact->force());
    s.integral_error = relative(s.integral, exact->force());
    s.torque_error = relative(s.torque, exact->torque());
    s.surface = surface_errors(body.space, body.rest, s.density, *exact);
  }
  return s;
}

}  // namespace tanktread
