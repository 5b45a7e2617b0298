#include "scene/series/series.hpp"

#include <sstream>
#include <unordered_map>

#include "scene/particles/prescribed.hpp"
#include "scene/series/diagnostics.hpp"
#include "scene/series/run_row.hpp"
#include "scene/series/surface_fields.hpp"

namespace tanktread {

namespace {

/// Order of columns in a row of the results and in the manual. Columns with components are listed by the part of their name before the component, and
/// columns of posts, `<post>/post_force_x1`, by the part after the name of the post.
constexpr const char* order =
    "time time_step taylor_inertia taylor_surface inclination volume volume_error refit_error area energy membrane_dissipation smallest_tension "
    "compressed_area local_area_change rms_area_change flow_power force_power fluid_dissipation power_residual stresslet_ length_ projected_area "
    "circularity hull_area hull_circularity normal_velocity shape_velocity "
    "n_control_points step_error rejected_steps iterations evaluations assemblies solver_iterations velocity_iterations wall_seconds centroid_ "
    "center_ velocity_ angular_velocity_ quaternion_ axis_ axis_1_ tank_treading_velocity tank_treading_frequency phase intrinsic_viscosity "
    "migration_velocity disturbed_pressure_drop gap flow_rate channel_pressure_drop channel_extra_pressure_drop nearest_to_wall_ particle_at_wall "
    "wall_force_ second_wall_force_ post_force_ mean_velocity_ permeability "
    "smallest_gap first_of_gap second_of_gap gap_ contact_force contact_impulse volume_fraction cell_1_ cell_2_ cell_3_ particle_stress_ "
    "relative_viscosity normal_stress_difference_ pressure_gradient_ disturbance_flux force_imbalance cap_velocity pressure_drop_by_flux "
    "pressure_drop_by_force drag_ torque_ drag_error drag_error_of_traction torque_error pressure_l2_error normal_l2_error surfactant_mass "
    "smallest_concentration largest_concentration parameter fold second_parameter period mean_particle_velocity_ leading_rate unstable_modes "
    "rate_ frequency_ kernel_evaluations";

std::size_t rank(const std::string& column) {
  static const auto ranks = [] {
    std::unordered_map<std::string, std::size_t> all;
    std::istringstream names(order);
    for (std::string one; names >> one;) all.emplace(one, all.size());
    return all;
  }();
  const std::string name = column.substr(column.find('/') + 1);
  auto at = ranks.find(name);
  const std::string component = "xk0123456789", stem = name.substr(0, name.find_last_not_of(component) + 1);  // `cell_1_` of `cell_1_x2`
  if (at == ranks.end() && stem.ends_with('_')) at = ranks.find(stem);
  return at == ranks.end() ? ranks.size() : at->second;
}

/// Adds the columns of all registered series of the type Series. If arguments `of` are given, the values of the columns are computed by calling each
/// series with these arguments. Otherwise the columns have no values.
template <class Series, class... Of>
void add_series_of(const SharedOptions& shared, Columns& to, const Of&... of) {
  for (const SeriesParts::Chosen& part : shared.series) {
    const auto made = part.make();
    const Series* const series = std::get_if<Series>(&made);
    if (!series) continue;
    if constexpr (sizeof...(of) > 0) part.add_columns((*series)(of...), to);
    else part.add_columns(to);
  }
}

}  // namespace

void add_series(const SharedOptions& shared, double time, const RecordedParticle& particle, Columns& to) {
  add_series_of<ParticleSeries>(shared, to, time, particle);
}

void add_series(const SharedOptions& shared, double time, std::span<const RecordedParticle> particles, Columns& to) {
  add_series_of<RunSeries>(shared, to, time, particles);
}

void ProgressRow::add_columns(const Scene& scene, Columns& to) const {
  const bool prescribed = scene.only_solids || scene.is_resistance_problem();
  to.add(time, {"time", "time", "simulated time; along a branch of steady shapes the number of the point, from 0; 0 for any other steady problem"});
  to.add(wall_seconds, {"wall_seconds", "s", "wall-clock time since the start of the run, including the earlier parts of a resumed run"});
  if (scene.in_system() || prescribed || scene.tube.present || scene.medium())
    to.add(static_cast<double>(counts.solver_iterations),
           {"solver_iterations", "1",
            "number of iterations of the linear solver, for implicit steps or for tractions, since the start of the run"});
  if (prescribed) return;
  to.add(step.step, {"time_step", "time", "length of the time step that ended at this time"});
  to.add(step.error, {"step_error", "1",
                      "estimated error of the time step, to be compared with Time/tolerance: root mean square displacement of the control "
                      "points divided by R_C, the radius of the sphere with the particle's volume"});
  to.add(step.rejected, {"rejected_steps", "1", "number of attempts at this time step that were rejected because their error was too "
                                                "large or an iteration failed"});
  to.add(static_cast<double>(evaluations.value_or(counts.evaluations)),
         {"evaluations", "1", "number of evaluations of the velocity of all control points, since the start of the run"});
  if (!scene.in_system()) return;
  to.add(step.iterations, {"iterations", "1", "number of nonlinear iterations (quasi-Newton or fixed-point) in this time step"});
  to.add(
      static_cast<double>(counts.assemblies),
      {"assemblies", "1", "number of times that the boundary-integral operator in the Jacobian was assembled, since the start of the run"});
  to.add(static_cast<double>(counts.velocity_iterations),
         {"velocity_iterations", "1",
          "number of iterations of the linear solver for velocities (viscosity ratio other than 1) since the start of the run"});
}

void RunRow::add_columns(const Scene& scene, Columns& to) const {
  progress.add_columns(scene, to);
  tube.add_columns(scene, to);
  solids.add_columns(scene, to);
  if (scene.has_gaps()) domain.add_columns(scene, to);
  if (scene.only_solids) return;
  wall.add_columns(scene, to);
  if (!scene.in_system()) return;
  together.add_columns(scene, to);
  if (to.when(scene.output.power_balance)) powers.add_columns(to);
  if (!scene.has_gaps()) return;
  nearest.add_columns(to);
  if (to.when(scene.contact.limiter)) contacts.add_columns(to);
}

Columns run_columns(const Scene& scene, bool every) {
  Columns all(every);
  RunRow().add_columns(scene, all);
  if (!scene.only_solids && !scene.in_system()) {
    const ParticleScene one = scene.first();
    switch (one.particle.motion) {
      case Motion::free: RigidRow().add_columns(one, all); break;
      case Motion::prescribed: PrescribedRow().add_columns(one, all); break;
      case Motion::deforming: break;  // in_system() is true
    }
  }
  for (const EquationParts::Chosen& one : scene.equations) one.add_columns(all);
  if (!scene.only_solids) add_series_of<RunSeries>(scene, all);
  put_in_order(all);
  return all;
}

Columns particle_columns(const ParticleScene& particle_scene, bool every) {
  Columns all(every);
  if (particle_scene.particle.rigid()) {
    RigidRow().add_columns(particle_scene, all);
  } else {
    DeformingRow().add_columns(particle_scene, all);
    if (all.when(particle_scene.surfactant.has_value())) SurfactantRow().add_columns(all);
    for (const auto& part : particle_scene.loads) part.add_columns(all);
    for (const auto& part : particle_scene.fields) part.add_columns(all);
  }
  add_series_of<ParticleSeries>(particle_scene, all);
  put_in_order(all);
  return all;
}

Columns columns(const Scene& scene) {
  Columns all = run_columns(scene);
  if (!scene.in_system()) return all;
  for (const ParticleScene& one : scene.particle_scenes()) all.append(particle_columns(one), one.name.empty() ? "" : one.name + "/");
  SteadyRow().add_columns(scene, all);
  return all;
}

void SteadyRow::add_columns(const Scene& scene, Columns& to) const {
  if (scene.continuation.present) point.add_columns(scene.continuation.second_parameter.has_value(), to);
  if (scene.periodic.present) {
    to.add(period, {"period", "time", "period of the periodic motion, after which the shape recurs"});
    to.add(mean_velocity, "x1 x2 x3",
           {"mean_particle_velocity_", "length/time",
            "component # of the mean velocity of the particles over the period, along directions in which walls and flow do not change; with "
            "Periodic/turn only x2"});
  }
  const auto rigid = [](const ParticleScene& one) { return one.particle.rigid(); };
  if (scene.spectrum.present) motion::add_columns(modes, scene.spectrum.number, std::ranges::all_of(scene.particle_scenes(), rigid), to);
}

void put_in_order(Columns& columns) { columns.sort(rank); }

void finish(Columns& row) {
  put_in_order(row);
  row.check();
}

}  // namespace tanktread
