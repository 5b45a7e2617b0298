#pragma once
// The series of a run: each is stated once, with its unit, what it is, which particles have it, and where its value comes from.

#include <complex>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene.hpp"
#include "coupling/capsule.hpp"
#include "coupling/tube.hpp"
#include "membrane/membrane.hpp"
#include "motion/integrator.hpp"
#include "surface/geometry.hpp"
#include "surface/transport.hpp"

namespace tanktread {

/// The two of several particles that are nearest to each other, by their numbers from 1 in the order of the deck, and the place between them.
struct Nearest {
  double gap = std::numeric_limits<double>::infinity();
  int first = 0, second = 0;
  Vec3 place = Vec3::Zero();
};

/// What a row is taken from. A particle fills in what its series ask for. Vectors are in the axes of space.
struct Moment {
  double time = 0, wall_seconds = 0;
  motion::StepReport step;
  coupling::Work work;
  int n_points = 0;
  surface::Measures measures;
  surface::Deformation shape;
  surface::PrincipalAxes axes;
  double volume_error = 0, refit_error = 0, energy = 0, normal_velocity = 0, shape_velocity = 0, dissipation = 0;
  membrane::TensionSummary tension;
  Mat3 stresslet = Mat3::Zero();
  double intrinsic_viscosity = 0;
  Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  Eigen::Vector4d quaternion = Eigen::Vector4d::Zero();  ///< the scalar part first
  surface::Treading treading;
  double phase = 0;
  std::complex<double> rate;  ///< of one mode
  double leading_rate = 0, unstable_modes = 0;  ///< of a spectrum
  double surfactant_mass = 0, smallest_concentration = 0, largest_concentration = 0;
  double parameter = 0, second_parameter = 0, fold = 0;  ///< of a branch
  double period = 0;  ///< of a motion that comes back
  double pressure_drop = 0, gap = 0;  ///< in a tube; the latter beside a wall too
  double flow_rate = 0, channel_pressure_drop = 0, channel_extra_pressure_drop = 0;  ///< in a tube; of an empty channel
  Nearest at_wall;                    ///< of a plane wall: the particle's number, and its place there
  Nearest nearest;                    ///< among others
  double contact_force = 0, contact_impulse = 0;
  double flow_power = 0, force_power = 0, fluid_dissipation = 0, power_residual = 0;
  Mat3 cell = Mat3::Zero();             ///< vectors of the lattice, columns
  Mat3 particle_stress = Mat3::Zero();  ///< in a cell: sum of stresslets over its volume; in the axes of the plane of the flow: `turned_stress`
  Mat3 turned_stress = Mat3::Zero();
  double relative_viscosity = 1, volume_fraction = 0;
  Vec3 pressure_gradient = Vec3::Zero();
  coupling::Tube::Checks tube;
  Vec3 drag = Vec3::Zero(), torque = Vec3::Zero();  ///< on a prescribed body; errors against the exact solution
  double drag_error = 0, drag_error_of_traction = 0, torque_error = 0, pressure_error = 0, normal_error = 0, kernel_evaluations = 0;
};

/// Whose row a series is in, as bits: the run's, which of several particles is that of all; a capsule's or drop's; that of a rigid body among several
/// particles; of a free body, in a tube only; of a prescribed one; of each mode of a spectrum, of all of it; of a branch;
/// of folds that go on; of a periodic motion.
enum Owner : unsigned {
  of_run = 1, of_several = 2, of_deforming = 4, of_rigid = 8, of_free = 16, of_free_in_tube = 32, of_prescribed = 64, of_mode = 128,
  of_spectrum = 256, of_branch = 512, of_folds = 1024, of_periodic = 2048
};

/// Condition on the scene under which a series exists. `lattice`: the scene repeats in any directions; `cell`: in three; `exact`: an exact solution
/// of a prescribed body is known; `exact_force`, `exact_torque`, `exact_pressure`: this quantity of it is not 0.
enum class Needs {
  nothing, tube, wall, tube_or_wall, held_pressure, channel, viscous_membrane, strain, lattice, cell, cell_strain, adaptation, exact, exact_force,
  exact_torque, exact_pressure, limiter, power, membrane,
  surfactant
};

/// A column of `/series` and its value.
struct Series {
  std::string name;
  const char* unit;
  std::string description;    ///< includes when the series is undefined
  std::string undefined_if;   ///< condition under which the value is NaN, as a clause; empty if the series is always defined
  unsigned owners;
  Needs needs;
  int component;  ///< the number of one of several that are stated together, from 0
  double (*value)(const Moment& now, int component);
};

/// All of them, whatever particle has them.
const std::vector<Series>& all_series();

/// Those of one row, as the owner has them in this scene.
std::vector<Series> series(const Scene& scene, Owner owner);

/// Those of one particle of a system, which is a capsule, a drop or a rigid body.
std::vector<Series> particle_series(const Scene& one);

/// Those of the run of a scene, one particle after another: `<name>`, of one of several particles `<particle>/<name>`.
std::vector<Series> run_series(const Scene& scene);

/// Those that a steady shape has beside, of a branch, and of a spectrum: `rate_1`, …
std::vector<Series> steady_series(const Scene& scene);

/// Returns one row. Throws RunFailure, which names the series, if a value is NaN and its series is always defined.
std::vector<double> row(std::span<const Series> of, const Moment& now);

/// The value of one series in a row. Throws std::out_of_range where there is no such series.
double entry(const std::vector<Series>& series, const std::vector<double>& row, std::string_view name);

/// Those of all particles, `name` and `<particle>/name`, in their order; without the run's own where particles have it.
std::vector<double> entries_of_particles(const std::vector<Series>& series, const std::vector<double>& row, std::string_view name);

/// Markdown: series and fields of the results, entries of the summary and numbers of a scene, each with its unit.
std::string series_manual();

/// Of the run's row, on a lattice: from stresslet and volume of all, and the force that they exert on the fluid.
void add_bulk_stress(const Scene& scene, const stokes::PeriodicCell& cell, const Mat3& plane, double volume, const Vec3& force, Moment& now);

/// Whether the unbounded flow has one rate of strain, which is not zero: what `intrinsic_viscosity` takes.
bool strains(const Scene& scene);

}  // namespace tanktread
