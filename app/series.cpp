#include "app/series.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "app/exact_body.hpp"
#include "base/errors.hpp"
#include "stokes/ambient_flow.hpp"

namespace tanktread {

namespace {

constexpr unsigned all_particles = of_deforming | of_rigid | of_free | of_prescribed;
constexpr unsigned moving = of_deforming | of_rigid | of_free;
constexpr unsigned told_or_among_others = of_rigid | of_prescribed;
constexpr unsigned timed = of_run | of_free;
constexpr unsigned in_tubes = of_run | of_free | of_prescribed;
constexpr const char* axes = "x1 x2 x3";

/// One series, or several with the names of their components behind their own, which stand in the description for each `#`.
struct Statement {
  const char *name, *components, *unit, *description;
  unsigned owners;
  double (*value)(const Moment& now, int component);
  Needs needs = Needs::nothing;
  const char* undefined_if = "";  // condition under which the value is NaN, as a clause
};

double stresslet(const Moment& m, int component) {
  constexpr int places[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  return m.stresslet(places[component][0], places[component][1]);
}

/// Of the centroid, in the cross-section of a tube.
double migration_velocity(const Moment& m, int) {
  const auto place = m.centre.tail<2>(), velocity = m.velocity.tail<2>();
  return place.dot(velocity) > 0 ? -velocity.norm() : velocity.norm();
}

constexpr Statement statements[] = {
    {"time", "", "time", "simulated time; 0 of a steady problem", timed | of_prescribed, [](const Moment& m, int) { return m.time; }},
    {"time_step", "", "time", "size of the step that ended here", timed, [](const Moment& m, int) { return m.step.step; }},
    {"taylor_inertia", "", "1", "Taylor parameter (6.2) of the ellipsoid with the same second moments, in the plane of the flow", of_deforming,
     [](const Moment& m, int) { return m.shape.taylor_inertia; }},
    {"taylor_surface", "", "1", "Taylor parameter (6.2) of the longest and shortest distance from the centroid, in the plane of the flow",
     of_deforming, [](const Moment& m, int) { return m.shape.taylor_surface; }},
    {"inclination", "", "degree",
     "angle of the long axis of inertia with the first direction of the plane of the flow (x1), towards the second (x3)", moving,
     [](const Moment& m, int) { return m.shape.inclination; }, Needs::nothing,
     "the two semi-axes in the plane of the flow (any two if the flow is not planar) differ by less than 1e-6 R_C"},
    {"volume", "", "length^3", "enclosed volume (P-43)", of_deforming | told_or_among_others, [](const Moment& m, int) { return m.measures.volume; }},
    {"volume_error", "", "1", "V/V0 - 1", of_deforming, [](const Moment& m, int) { return m.volume_error; }},
    {"refit_error", "", "1", "sum of what changes of the mesh have moved the present and the unstressed surface by so far, over R_C", of_deforming,
     [](const Moment& m, int) { return m.refit_error; }, Needs::adaptation},
    {"area", "", "length^2", "area of the surface", of_deforming | told_or_among_others, [](const Moment& m, int) { return m.measures.area; }},
    {"energy", "", "force length",
     "stored in the membrane, in the springs of a Maxwell element (3.23) too; of a drop with surfactant the free energy of its surface (3.21)",
     of_deforming | of_several, [](const Moment& m, int) { return m.energy; }},
    {"membrane_dissipation", "", "force length/time", "power that the membrane's viscosity turns into heat (3.10), (3.25)", of_deforming,
     [](const Moment& m, int) { return m.dissipation; }, Needs::viscous_membrane},
    {"smallest_tension", "", "1", "smallest principal tension over G_s, of a drop over sigma", of_deforming,
     [](const Moment& m, int) { return m.tension.smallest; }},
    {"compressed_area", "", "1", "share of the area with a negative principal tension", of_deforming,
     [](const Moment& m, int) { return m.tension.compressed_area; }},
    {"local_area_change", "", "1", "largest change of area of a place of the membrane, over its area unstressed", of_deforming,
     [](const Moment& m, int) { return m.tension.area_change; }, Needs::membrane},
    {"flow_power", "", "force length/time", "power that the flow puts in beyond what the outer fluid alone would take (6.11)", of_run,
     [](const Moment& m, int) { return m.flow_power; }, Needs::power},
    {"force_power", "", "force length/time", "power of weights, of forces on membranes and bodies, and of contacts", of_run,
     [](const Moment& m, int) { return m.force_power; }, Needs::power},
    {"fluid_dissipation", "", "force length/time", "power that the fluids turn into heat, beyond what the outer one alone would (6.12)", of_run,
     [](const Moment& m, int) { return m.fluid_dissipation; }, Needs::power},
    {"power_residual", "", "1", "what the balance of power lacks (6.13), over half the magnitudes of its terms", of_run,
     [](const Moment& m, int) { return m.power_residual; }, Needs::power},
    {"stresslet_", "11 22 33 12 13 23", "force length", "particle stresslet (6.7), component #", all_particles | of_several, stresslet},
    {"length_", axes, "length", "extent along #", moving, [](const Moment& m, int c) { return m.shape.lengths[c]; }},
    {"normal_velocity", "", "1",
     "largest |v.n| over rate x R_C (in a tube over the mean velocity; there and in parabolic flow in the particle's frame): "
     "zero when the shape is steady",
     of_deforming, [](const Moment& m, int) { return m.normal_velocity; }},
    {"shape_velocity", "", "1", "what smooth changes of shape have of it, root mean square (6.8): `Time/steady tolerance` is held against this",
     of_deforming, [](const Moment& m, int) { return m.shape_velocity; }},
    {"n_control_points", "", "1", "control points of the surface", all_particles | of_several,
     [](const Moment& m, int) { return double(m.n_points); }},
    {"step_error", "", "1", "estimated error of the step, in the norm of Time/tolerance", timed, [](const Moment& m, int) { return m.step.error; }},
    {"rejected_steps", "", "1", "attempts given up in this step", timed, [](const Moment& m, int) { return double(m.step.rejected); }},
    {"iterations", "", "1", "nonlinear iterations or sub-iterations in this step", of_run,
     [](const Moment& m, int) { return double(m.step.iterations); }},
    {"evaluations", "", "1", "velocity evaluations so far", timed, [](const Moment& m, int) { return double(m.work.evaluations); }},
    {"assemblies", "", "1", "assemblies of the frozen layer operator so far", of_run, [](const Moment& m, int) { return double(m.work.assemblies); }},
    {"solver_iterations", "", "1", "iterations of the linear solver so far", of_run | of_free_in_tube | of_prescribed,
     [](const Moment& m, int) { return double(m.work.solver_iterations); }},
    {"velocity_iterations", "", "1", "iterations of the systems that velocities come from so far (viscosity ratio other than 1)", of_run,
     [](const Moment& m, int) { return double(m.work.velocity_iterations); }},
    {"wall_seconds", "", "s", "time since the run was started, earlier parts of a resumed run included", timed | of_prescribed,
     [](const Moment& m, int) { return m.wall_seconds; }},
    {"centroid_", axes, "length", "centroid (P-42), component #; x1 in a tube is what the frame has travelled", of_deforming | of_rigid,
     [](const Moment& m, int c) { return m.centre[c]; }},
    {"center_", axes, "length", "centre of the rigid body, component #", of_free, [](const Moment& m, int c) { return m.centre[c]; }},
    {"velocity_", axes, "length/time", "of the centroid (6.4), or of the centre of a rigid body, component #; of several particles the mean",
     moving | of_several, [](const Moment& m, int c) { return m.velocity[c]; }},
    {"angular_velocity_", axes, "1/time", "of the rigid body, component #", of_rigid | of_free,
     [](const Moment& m, int c) { return m.angular_velocity[c]; }},
    {"quaternion_", "0 1 2 3", "1", "turn from the initial place, component #, of which 0 is the scalar part", of_rigid | of_free,
     [](const Moment& m, int c) { return m.quaternion[c]; }},
    {"axis_", "1 2 3", "length", "semi-axis # of the ellipsoid with the same second moments (6.1), the longest one first", of_deforming | of_free,
     [](const Moment& m, int c) { return m.axes.lengths[c]; }},
    {"axis_1_", axes, "1", "direction of the longest semi-axis, component #; the first nonzero component is positive", of_deforming | of_free,
     [](const Moment& m, int c) { return m.axes.longest_defined ? m.axes.directions(c, 0) : std::numeric_limits<double>::quiet_NaN(); },
     Needs::nothing, "the two longest semi-axes differ by less than 1e-6 R_C"},
    {"tank_treading_velocity", "", "length/time",
     "mean tangential velocity relative to the centroid on the curve that the plane of the flow through it cuts out (6.5); positive where the side "
     "of larger x3 moves along x1, clockwise with x1 to the right and x3 up",
     of_deforming | of_free, [](const Moment& m, int) { return m.treading.velocity; }},
    {"tank_treading_frequency", "", "1/time",
     "mean angular velocity of the material points of that curve about the centroid (6.6), in radians over time and of the same sense: 2 pi over "
     "the period of a steady motion; of a rigid body its angular velocity",
     of_deforming | of_free, [](const Moment& m, int) { return m.treading.frequency; }},
    {"phase", "", "degree",
     "angle about the centroid, in the plane of the flow and of the same sense, of the material point that starts at the angle 0, on the side of "
     "x1, counted on past whole turns; of a drop whose mesh slides the integral of tank_treading_frequency",
     of_deforming | of_free, [](const Moment& m, int) { return m.phase; }},
    {"intrinsic_viscosity", "", "1", "S:E/(2 mu V E:E) with the stresslet S (6.7) and the rate of strain E of the flow: 5/2 of a rigid sphere",
     moving, [](const Moment& m, int) { return m.intrinsic_viscosity; }, Needs::strain},
    {"migration_velocity", "", "length/time", "speed of the centroid in the x2 x3 plane, positive towards the axis of the tube",
     of_deforming | of_free, migration_velocity, Needs::tube},
    {"disturbed_pressure_drop", "", "force/length^2", "pressure drop that the particle adds (2.7); of one period of a train", timed | of_prescribed,
     [](const Moment& m, int) { return m.pressure_drop; }, Needs::tube},
    {"gap", "", "length", "smallest distance between particle and wall", timed | of_prescribed,
     [](const Moment& m, int) { return m.gap; }, Needs::tube_or_wall},
    {"flow_rate", "", "length^3/time", "through the tube, where Flow/held is `pressure drop`", timed | of_prescribed,
     [](const Moment& m, int) { return m.flow_rate; }, Needs::held_pressure},
    {"channel_pressure_drop", "", "force/length^2", "between the ends of the empty channel (2.30)", timed | of_prescribed,
     [](const Moment& m, int) { return m.channel_pressure_drop; }, Needs::channel},
    {"channel_extra_pressure_drop", "", "force/length^2", "the same, over that of a straight tube of the inlet's section and as long",
     timed | of_prescribed, [](const Moment& m, int) { return m.channel_extra_pressure_drop; }, Needs::channel},
    {"nearest_to_wall_", axes, "length", "place of a particle's surface that is nearest to the plane wall, component #", timed | of_prescribed,
     [](const Moment& m, int c) { return m.at_wall.place[c]; }, Needs::wall},
    {"particle_at_wall", "", "1", "number of the particle that is nearest to it, from 1 in the order of the deck", of_several,
     [](const Moment& m, int) { return double(m.at_wall.first); }, Needs::wall},
    {"smallest_gap", "", "length", "smallest distance between two of several particles, or images of them in a lattice", of_several,
     [](const Moment& m, int) { return m.nearest.gap; }},
    {"first_of_gap", "", "1", "number of the first of these two, from 1 in the order of the deck", of_several,
     [](const Moment& m, int) { return double(m.nearest.first); }},
    {"second_of_gap", "", "1", "number of the second one", of_several, [](const Moment& m, int) { return double(m.nearest.second); }},
    {"gap_", axes, "length", "place between their nearest points, component #", of_several,
     [](const Moment& m, int c) { return m.nearest.place[c]; }},
    {"contact_force", "", "force",
     "sum of the forces by which Contact/limiter held particles apart over the step that ended here; 0 where the fluid did", of_several,
     [](const Moment& m, int) { return m.contact_force; }, Needs::limiter},
    {"contact_impulse", "", "force time", "sum of these forces times the time that they acted for, so far", of_several,
     [](const Moment& m, int) { return m.contact_impulse; }, Needs::limiter},
    {"volume_fraction", "", "1", "volume of the particles over that of the cell", of_several, [](const Moment& m, int) { return m.volume_fraction; },
     Needs::cell},
    {"cell_", "1_x1 1_x2 1_x3 2_x1 2_x2 2_x3 3_x1 3_x2 3_x3", "length",
     "vector and component # of the cell that repeats, at this time; across directions that do not repeat unit vectors", of_several,
     [](const Moment& m, int c) { return m.cell(c % 3, c / 3); }, Needs::lattice},
    {"particle_stress_", "11 22 33 12 13 23", "force/length^2", "what the particles add to the mean stress (6.9), without its trace, component #",
     of_several,
     [](const Moment& m, int component) {
       constexpr int places[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
       return m.particle_stress(places[component][0], places[component][1]);
     },
     Needs::cell},
    {"relative_viscosity", "", "1", "effective viscosity over mu (6.10)", of_several, [](const Moment& m, int) { return m.relative_viscosity; },
     Needs::cell_strain},
    {"normal_stress_difference_", "1 2", "force/length^2",
     "number # of the particle stress, 11 - 33 and 33 - 22 where the flow is along x1 and its plane x1 x3; otherwise in the axes of that plane",
     of_several, [](const Moment& m, int c) { return m.turned_stress(2 * c, 2 * c) - m.turned_stress(2 - c, 2 - c); },
     Needs::cell_strain},
    {"pressure_gradient_", axes, "force/length^3", "uniform one that balances the force of the particles on the fluid, component #", of_several,
     [](const Moment& m, int c) { return m.pressure_gradient[c]; }, Needs::cell},
    {"disturbance_flux", "", "1", "flow rate of the disturbance through the inlet, over the duct's: should vanish (2.14)", in_tubes,
     [](const Moment& m, int) { return m.tube.flux; }, Needs::tube},
    {"force_imbalance", "", "1",
     "axial force of the disturbance on caps, wall and particle, over the duct's own on the length R_T: should vanish (2.14)", in_tubes,
     [](const Moment& m, int) { return m.tube.force; }, Needs::tube},
    {"cap_velocity", "", "1", "largest disturbance velocity left on the caps, over the mean velocity", in_tubes,
     [](const Moment& m, int) { return m.tube.cap_velocity; }, Needs::tube},
    {"pressure_drop_by_flux", "", "force/length^2", "disturbed pressure drop for which the flux of the disturbance vanishes", in_tubes,
     [](const Moment& m, int) { return m.tube.pressure_by_flux; }, Needs::tube},
    {"pressure_drop_by_force", "", "force/length^2", "disturbed pressure drop for which the axial forces balance", in_tubes,
     [](const Moment& m, int) { return m.tube.pressure_by_force; }, Needs::tube},
    {"drag_", axes, "force", "force on the particle, component #", told_or_among_others, [](const Moment& m, int c) { return m.drag[c]; }},
    {"torque_", axes, "force length", "torque on the particle about its centre, component #", told_or_among_others,
     [](const Moment& m, int c) { return m.torque[c]; }},
    {"drag_error", "", "1", "|F - F_exact|/|F_exact|, where the exact force is known and not zero", of_prescribed,
     [](const Moment& m, int) { return m.drag_error; }, Needs::exact_force},
    {"drag_error_of_traction", "", "1", "the same, of the integral of the traction alone", of_prescribed,
     [](const Moment& m, int) { return m.drag_error_of_traction; }, Needs::exact_force},
    {"torque_error", "", "1", "|T - T_exact|/|T_exact|, where the exact torque is known and not zero", of_prescribed,
     [](const Moment& m, int) { return m.torque_error; }, Needs::exact_torque},
    {"pressure_l2_error", "", "1", "L2 norm of p - p_exact over that of p_exact, p = -t.n (6.3), where that is known", of_prescribed,
     [](const Moment& m, int) { return m.pressure_error; }, Needs::exact_pressure},
    {"normal_l2_error", "", "1", "L2 norm of n_h - n over that of n (6.3), where that is known", of_prescribed,
     [](const Moment& m, int) { return m.normal_error; }, Needs::exact},
    {"surfactant_mass", "", "1", "integral of the concentration over the interface, over the initial one: stays 1 to round-off", of_deforming,
     [](const Moment& m, int) { return m.surfactant_mass; }, Needs::surfactant},
    {"smallest_concentration", "", "1", "of surfactant over the initial one", of_deforming,
     [](const Moment& m, int) { return m.smallest_concentration; }, Needs::surfactant},
    {"largest_concentration", "", "1", "the same", of_deforming,
     [](const Moment& m, int) { return m.largest_concentration; }, Needs::surfactant},
    {"parameter", "", "of the key", "Continuation/parameter", of_branch, [](const Moment& m, int) { return m.parameter; }},
    {"fold", "", "1", "1 where the parameter turns back along the branch, else 0", of_branch, [](const Moment& m, int) { return m.fold; }},
    {"second_parameter", "", "of the key", "Continuation/second parameter", of_folds, [](const Moment& m, int) { return m.second_parameter; }},
    {"period", "", "time", "after which the shape is back (Periodic)", of_periodic, [](const Moment& m, int) { return m.period; }},
    {"leading_rate", "", "1/time",
     "largest rate of the modes that change the shape, translations and rotations left out: negative where it is stable",
     of_spectrum, [](const Moment& m, int) { return m.leading_rate; }},
    {"unstable_modes", "", "1", "of those modes, how many grow", of_spectrum, [](const Moment& m, int) { return m.unstable_modes; }},
    {"rate_", "k", "1/time",
     "of mode k of the spectrum, as its displacement grows (Spectrum): the modes as Spectrum/number and Spectrum/near order them",
     of_mode, [](const Moment& m, int) { return m.rate.real(); }},
    {"frequency_", "k", "1/time", "of the same mode, 2 pi over the period with which it oscillates; not negative", of_mode,
     [](const Moment& m, int) { return std::abs(m.rate.imag()); }},
    {"kernel_evaluations", "", "1", "of the layer operator, all rules together", of_prescribed,
     [](const Moment& m, int) { return m.kernel_evaluations; }},
};

std::vector<Series> stated() {
  std::vector<Series> all;
  for (const Statement& one : statements) {
    std::istringstream components(one.components);
    std::string component, description = one.description;
    components >> component;
    for (int c = 0; c == 0 || components >> component; ++c) {
      description = one.description;
      if (const auto at = description.find('#'); at != description.npos) description.replace(at, 1, component);
      if (*one.undefined_if) description += "; NaN if " + std::string(one.undefined_if);
      all.push_back({one.name + component, one.unit, description, one.undefined_if, one.owners, one.needs, c, one.value});
    }
  }
  return all;
}

bool holds(const Scene& scene, Needs needs) {
  if (needs == Needs::nothing) return true;
  if (needs == Needs::tube) return scene.tube.present;
  if (needs == Needs::held_pressure) return scene.tube.present && scene.flow.held == "pressure drop";
  if (needs == Needs::channel) return scene.tube.channel.has_value();
  if (needs == Needs::wall) return scene.wall.present;
  if (needs == Needs::tube_or_wall) return scene.tube.present || scene.wall.present;
  if (needs == Needs::viscous_membrane) return scene.viscous_membrane();
  if (needs == Needs::surfactant) return scene.surfactant.has_value();
  if (needs == Needs::membrane) return scene.membrane.law != "surface tension";
  if (needs == Needs::strain) return strains(scene);
  if (needs == Needs::lattice) return scene.domain.present;
  if (needs == Needs::cell || needs == Needs::cell_strain)
    return scene.domain.present && scene.domain.directions() == 3 && (needs == Needs::cell || strains(scene));
  if (needs == Needs::adaptation) return scene.adaptation.enabled;
  if (needs == Needs::limiter) return scene.contact.limiter;
  if (needs == Needs::power) return scene.output.power_balance;
  const auto exact = scene.tube.present ? std::nullopt : exact_body(scene);
  if (!exact || needs == Needs::exact) return exact.has_value();
  if (needs == Needs::exact_pressure) return exact->presses();
  return (needs == Needs::exact_force ? exact->force() : exact->torque()).norm() > 0;
}

Owner owner_of_particle(const Scene& one) { return one.particle.rigid() ? of_rigid : of_deforming; }

}  // namespace

const std::vector<Series>& all_series() {
  static const std::vector<Series> all = stated();
  return all;
}

std::vector<Series> series(const Scene& scene, Owner owner) {
  unsigned owners = owner;
  const unsigned alone = scene.particles.empty() ? unsigned{owner_of_particle(scene)} : 0;  // whose own columns have the same names
  if (owner == of_run && scene.has_gaps()) owners |= of_several;
  if (owner == of_free && (scene.tube.present || scene.wall.present)) owners |= of_free_in_tube;
  std::vector<Series> found;
  for (const Series& one : all_series())
    if ((one.owners & owners) && !(owner == of_run && (one.owners & alone)) && holds(scene, one.needs)) found.push_back(one);
  return found;
}

std::vector<Series> particle_series(const Scene& one) { return series(one, owner_of_particle(one)); }

std::vector<Series> run_series(const Scene& scene) {
  if (!scene.in_system()) return series(scene, scene.particle.motion == Motion::free ? of_free : of_prescribed);
  std::vector<Series> all = series(scene, of_run);
  for (const Scene& one : scene.alone())
    for (Series& own : particle_series(one)) {
      if (!one.name.empty()) own.name = one.name + "/" + own.name;
      all.push_back(std::move(own));
    }
  std::ranges::move(steady_series(scene), std::back_inserter(all));
  return all;
}

std::vector<Series> steady_series(const Scene& scene) {
  std::vector<Series> all;
  if (scene.continuation.present) all = series(scene, of_branch);
  if (scene.continuation.second_parameter) std::ranges::move(series(scene, of_folds), std::back_inserter(all));
  if (scene.periodic.present) std::ranges::move(series(scene, of_periodic), std::back_inserter(all));
  if (scene.spectrum.present) std::ranges::move(series(scene, of_spectrum), std::back_inserter(all));
  for (int k = 1; scene.spectrum.present && k <= scene.spectrum.number; ++k)
    for (Series one : series(scene, of_mode)) {
      one.name.replace(one.name.size() - 1, 1, std::to_string(k));
      all.push_back(std::move(one));
    }
  return all;
}

std::vector<double> row(std::span<const Series> of, const Moment& now) {
  std::vector<double> values;
  for (const Series& one : of) {
    values.push_back(one.value(now, one.component));
    if (std::isnan(values.back()) && one.undefined_if.empty()) throw RunFailure("the series " + one.name + " is not a number");
  }
  return values;
}

double entry(const std::vector<Series>& series, const std::vector<double>& row, std::string_view name) {
  const auto at = std::ranges::find(series, name, &Series::name);
  if (at == series.end()) throw std::out_of_range("there is no series '" + std::string(name) + "'");
  return row.at(static_cast<size_t>(at - series.begin()));
}

std::vector<double> entries_of_particles(const std::vector<Series>& series, const std::vector<double>& row, std::string_view name) {
  std::vector<double> found;
  for (size_t k = 0; k < series.size(); ++k)
    if (series[k].name.ends_with("/" + std::string(name))) found.push_back(row.at(k));
  if (found.empty() && std::ranges::count(series, name, &Series::name) > 0) found.push_back(entry(series, row, name));
  return found;
}

/// (6.9), (6.10)
void add_bulk_stress(const Scene& scene, const stokes::PeriodicCell& cell, const Mat3& plane, double volume, const Vec3& force, Moment& now) {
  const Mat3 gradient = stokes::AmbientFlow(scene.flow).gradient(Vec3::Zero()), strain = (gradient + gradient.transpose()) / 2;
  now.volume_fraction = volume / cell.volume();
  now.particle_stress = now.stresslet / cell.volume();
  now.turned_stress = plane * now.particle_stress * plane.transpose();
  now.pressure_gradient = force / cell.volume();
  if (strain.isZero(0)) return;
  now.relative_viscosity = 1 + now.particle_stress.cwiseProduct(strain).sum() / (2 * scene.flow.viscosity * strain.squaredNorm());
}

bool strains(const Scene& scene) {
  if (scene.tube.present) return false;
  const stokes::AmbientFlow flow(scene.flow);
  const Mat3 gradient = flow.gradient(Vec3::Zero());
  return flow.affine() && (gradient + gradient.transpose()).norm() > 1e-10 * gradient.norm();
}

}  // namespace tanktread
