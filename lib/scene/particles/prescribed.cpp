#include "scene/particles/prescribed.hpp"

#include <functional>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "surface/geometry.hpp"
#include "system/solids/rigid_body.hpp"

namespace tanktread {

namespace {

/// Returns seven integrals of the velocity residual of the force density f, which is the error of the velocity between collocation points
/// (Resistance::residual_work). The first six are the errors of the force and of the torque on the fluid, by the reciprocal theorem. The seventh is
/// the work of f on the velocity residual.
Eigen::VectorXd reciprocal_correction(coupling::Resistance& body, const std::function<Net(const Net& x)>& u, const Net& f, const Vec3& centre) {
  std::vector<Net> z;
  for (int k = 0; k < 6; ++k) z.push_back(body.force_density(coupling::rigid_velocity(body.surface(), coupling::unit_motion(k), centre)));
  z.push_back(f);
  return body.residual_work(u, f, z);
}

double relative(const Vec3& value, const Vec3& exact) { return exact.norm() > 0 ? (value - exact).norm() / exact.norm() : RigidSolution::unknown; }

}  // namespace

void PrescribedRow::add_columns(const Scene& scene, Columns& to) const {
  add_size(measures, to);
  add_stresslet(stresslet, to);
  add_points(n_points, to);
  add_drag(solution.force, solution.torque, to);
  const auto exact = exact_body(scene);
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

coupling::Resistance resistance_of(const Scene& scene, const Body& body, coupling::Ranks& ranks, Phases& phases, coupling::Tube* tube) {
  return {body.space, body.rest, scene.flow.viscosity, scene.quadrature, scene.solvers, ranks, phases, tube, scene.wall.plane()};
}

RigidSolution rigid_solution(const Scene& scene, const Body& body, coupling::Resistance& resistance, Phases& phases, const coupling::Tube* tube) {
  const Vec3& centre = scene.particle.shape.center;
  const coupling::RigidMotion motion = prescribed_motion(scene);
  const auto relative_velocity = [&](const Net& x) -> Net { return coupling::rigid_velocity(x, motion, centre) - body.flow.velocities(x); };

  RigidSolution s;
  s.density = resistance.force_density(resistance.interpolated(relative_velocity));
  s.iterations = resistance.last_iterations();
  s.integral = s.force = -resistance.force(s.density);
  s.torque = -resistance.torque(s.density, centre);
  double drop_lacking = 0;
  if (scene.reciprocal_forces()) {
    const Eigen::VectorXd lacking = reciprocal_correction(resistance, relative_velocity, s.density, centre);
    s.force -= lacking.head<3>();
    s.torque -= lacking.segment<3>(3);
    const double work_of_motion = lacking.head<3>().dot(motion.velocity) + lacking.segment<3>(3).dot(motion.angular_velocity);
    drop_lacking = resistance.lacking_pressure(body.flow, s.density, work_of_motion - lacking[6]);
  }
  if (tube) {
    s.pressure_drop = resistance.pressure_drop(s.density) + drop_lacking;
    return s;
  }
  if (const auto exact = exact_body(scene)) {
    const auto clock = phases.time("diagnostics");
    s.error = relative(s.force, exact->force());
    s.integral_error = relative(s.integral, exact->force());
    s.torque_error = relative(s.torque, exact->torque());
    s.surface = surface_errors(body.space, body.rest, s.density, *exact);
  }
  return s;
}

}  // namespace tanktread
