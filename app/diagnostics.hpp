#pragma once
// The series of a run, of every kind of particle: each is stated once, with its unit, what it is, and where its value comes from.

#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/body.hpp"
#include "coupling/capsule.hpp"
#include "coupling/tube.hpp"
#include "membrane/membrane.hpp"
#include "motion/integrator.hpp"
#include "surface/geometry.hpp"
#include "surface/principal_axes.hpp"
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
  double volume_error = 0, refit_error = 0, energy = 0, normal_velocity = 0, shape_velocity = 0;
  membrane::TensionSummary tension;
  Mat3 stresslet = Mat3::Zero();
  double intrinsic_viscosity = 0;
  Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  Eigen::Vector4d quaternion = Eigen::Vector4d::Zero();  ///< the scalar part first
  surface::Treading treading;
  double phase = 0;
  double pressure_drop = 0, gap = 0;  ///< in a tube
  Nearest nearest;                    ///< among others
  coupling::Tube::Checks tube;
  Vec3 drag = Vec3::Zero(), torque = Vec3::Zero();  ///< on a prescribed body; errors against the exact solution
  double drag_error = 0, drag_error_of_traction = 0, torque_error = 0, pressure_error = 0, normal_error = 0, kernel_evaluations = 0;
};

/// A column of `/series` and its value.
struct Series {
  std::string_view name;
  const char *unit, *description;
  double (*value)(const Moment& now);
};

/// All of them, whatever particle has them.
std::span<const Series> all_series();

/// Those of these names, in this order.
std::vector<Series> series(std::initializer_list<std::string_view> names);

/// Name, unit and description of one column of `/series`.
struct Column {
  std::string name, unit, description;
};
std::vector<Column> columns(std::span<const Series> of);

/// One row. Throws RunFailure, which names the series, where a value is not a number.
std::vector<double> row(std::span<const Series> of, const Moment& now);

/// The value of one series in a row. Throws std::out_of_range where there is no such series.
double entry(const std::vector<Column>& columns, const std::vector<double>& row, std::string_view name);

/// Those of all particles, `name` and `<particle>/name`, in their order; without the run's own where particles have it.
std::vector<double> entries_of_particles(const std::vector<Column>& columns, const std::vector<double>& row, std::string_view name);

/// What every capsule and drop has that its own shape x and slope tell. Collective.
Moment moment(const Scene& scene, const Body& body, const surface::Geometry& geometry, const membrane::Membrane& membrane, const Net& x,
              const Net& slope, const coupling::Ranks& ranks);

/// Velocity of the centroid, and tank-treading, of a surface x whose material moves by v.
void add_treading(const Scene& scene, const Body& body, const surface::Geometry& geometry, const Net& x, const Net& v, Moment& now);

/// D and inclination in the plane of the flow, and extents. Ranks share the elements. Collective.
surface::Deformation deformation(const surface::Geometry& geometry, const FlowPlane& plane, const Net& x, surface::Measures measures,
                                 const coupling::Ranks& ranks);

/// Whether the unbounded flow has one rate of strain, which is not zero: what `intrinsic_viscosity` takes.
bool strains(const Scene& scene);

/// S:E/(2 mu V E:E), E the symmetric part of the gradient.
double intrinsic_viscosity(const Mat3& stresslet, const Mat3& gradient, double viscosity, double volume);

/// Angle of y in the plane, in degrees from its first direction in the sense of tank-treading, in (-180, 180].
double angle_in(const FlowPlane& plane, const Vec3& y);

/// The site of the surface that is seen from `from` in the first direction of the plane.
spline::Site site_ahead(const spline::Space& space, const Net& x, const Vec3& from, const FlowPlane& plane);

/// Largest |v.n| over these collocation sites, over rate x R_C: zero when the shape is steady. In a tube of the velocity relative to the centroid's
/// along the tube, over the mean velocity.
double normal_velocity(const Scene& scene, const Body& body, const surface::Geometry& geometry, const Net& x, const Net& slope,
                       std::span<const int> sites);

}  // namespace tanktread
