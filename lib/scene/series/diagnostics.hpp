#pragma once
// Measurements on a particle, and the columns of a particle in the results.

#include <limits>
#include <span>

#include <Eigen/Geometry>

#include "base/columns.hpp"
#include "membrane/membrane.hpp"
#include "scene/body.hpp"
#include "surface/geometry.hpp"
#include "surface/silhouette.hpp"
#include "surface/transport.hpp"

namespace tanktread {

/// Initial value of data that every row must set: a value that is not set ends the run (Columns::check).
constexpr double not_set = std::numeric_limits<double>::quiet_NaN();

/// Data of a moving particle for one row of the results. Vectors have components in the laboratory frame. The columns state the units.
struct ParticleRow {
  int n_points = 0;
  surface::Measures measures{not_set, not_set, Vec3::Constant(not_set), Mat3::Constant(not_set)};
  surface::Deformation shape{not_set, not_set, not_set, Vec3::Constant(not_set)};
  surface::Silhouette silhouette{not_set, not_set, not_set, not_set};  ///< set only if Output/view direction is given
  surface::PrincipalAxes axes{.lengths = Vec3::Constant(not_set)};
  surface::TankTreading treading{not_set, not_set};
  Mat3 stresslet = Mat3::Constant(not_set);
  Vec3 centre = Vec3::Constant(not_set), velocity = Vec3::Constant(not_set);
  double energy = 0;  ///< 0 for a rigid body
  double intrinsic_viscosity = not_set, phase = not_set;

  virtual ~ParticleRow() = default;
  /// Adds the columns of this particle to a row. `particle_scene`: scene with the options of this particle only.
  virtual void add_columns(const ParticleScene& particle_scene, Columns& to) const = 0;

 protected:
  void add_moving(const ParticleScene& particle_scene, Columns& to) const;   ///< adds the columns that every moving particle has
  void add_turning(const ParticleScene& particle_scene, Columns& to) const;  ///< adds semi-axes, tank-treading and migration
};

struct DeformingRow : ParticleRow {
  double volume_error = not_set, refit_error = not_set, normal_velocity = not_set, shape_velocity = not_set;
  double dissipation = 0;  ///< 0 without surface viscosity
  membrane::TensionSummary tension{not_set, not_set, not_set, not_set};
  void add_columns(const ParticleScene& particle_scene, Columns& to) const override;
};

struct RigidRow : ParticleRow {
  Vec3 angular_velocity = Vec3::Constant(not_set);
  Vec3 drag = Vec3::Constant(not_set), torque = Vec3::Constant(not_set);  ///< set only in a coupled system
  Eigen::Vector4d quaternion = Eigen::Vector4d::Constant(not_set);        ///< quaternion of the rotation since the start, the scalar part first
  double shape_velocity = not_set;                                        ///< shape velocity (6.8), set only if Time/steady tolerance is given
  void add_columns(const ParticleScene& particle_scene, Columns& to) const override;
};

/// Totals over all particles (control points, energy and stresslet), and the mean velocity of all particles.
struct Together {
  int n_points = 0;
  double energy = 0;
  Mat3 stresslet = Mat3::Zero();
  Vec3 velocity = Vec3::Zero();
  void add_columns(const Scene& scene, Columns& to) const;
};

/// Each of these functions adds one group of columns that several kinds of rows contain.
void add_points(int n_points, Columns& to);
void add_size(const surface::Measures& measures, Columns& to);
void add_stresslet(const Mat3& stresslet, Columns& to);
void add_drag(const Vec3& drag, const Vec3& torque, Columns& to);
void add_gap(double to_wall, Columns& to);

/// Returns components 11, 22, 33, 12, 13, 23 of a symmetric tensor.
Eigen::Vector<double, 6> components(const Mat3& tensor);

/// Returns true if there is no duct and the flow is affine with a nonzero rate of strain, so that `intrinsic_viscosity` is defined.
bool has_intrinsic_viscosity(const SharedOptions& shared);

/// Computes the row data of a capsule or drop that follow from its shape x and velocity `slope`. Other data, such as the stresslet, are not set.
/// Collective.
DeformingRow deforming_row(const ParticleScene& particle_scene, const Body& body, const surface::Geometry& geometry,
                           const membrane::Membrane& membrane, const Net& x, const Net& slope, const coupling::Ranks& ranks);

/// Sets in `now` the velocity of the centroid and the tank-treading of the surface x, whose material moves at the velocity v.
void add_treading(const ParticleScene& particle_scene, const Body& body, const surface::Geometry& geometry, const Net& x, const Net& v,
                  ParticleRow& now);

/// Computes the Taylor parameter D and the inclination in the plane of the flow, and the extents along x1, x2 and x3. If the flow is not planar, uses
/// the plane of the longest and the shortest axis of inertia instead. If the middle axis is as long as the longest or the shortest axis, this plane
/// is not determined, and the inclination is NaN. Ranks share the elements. Collective.
surface::Deformation deformation(const surface::Geometry& geometry, const FlowPlane& plane, const Net& x, surface::Measures measures,
                                 const coupling::Ranks& ranks);

/// Returns S:E/(2 mu V E:E), with the stresslet S and volume V of the row, the symmetric part E of the flow's gradient and mu = `viscosity`; 0 if the
/// flow is not affine, and NaN if E is zero or the amplitude of the flow is zero up to rounding. `flow`: flow at the time of the row.
double intrinsic_viscosity(const stokes::AmbientFlow& flow, double viscosity, const ParticleRow& now);

/// Returns the row of a rigid body with the surface x, the velocities `motion` and the rotation `turn` since the start. `flow`: flow at the time of
/// the row. Drag and torque are not set. Collective.
RigidRow rigid_row(const ParticleScene& particle_scene, const Body& body, const stokes::AmbientFlow& flow, const surface::Geometry& geometry,
                   const Net& x, const coupling::RigidMotion& motion, const Eigen::Quaterniond& turn, const Mat3& stresslet,
                   const coupling::Ranks& ranks);

/// Returns the angle of y in the plane, in degrees in (-180, 180], from the plane's first direction, positive in the sense of positive tank-treading
/// (clockwise with x1 to the right and x3 up).
double angle_in(const FlowPlane& plane, const Vec3& y);

/// Returns the parametric point at which the ray from `from` along the first in-plane direction (a in FlowPlane) meets the surface.
spline::Site site_ahead(const spline::Space& space, const Net& x, const Vec3& from, const FlowPlane& plane);

/// Returns the largest normal velocity |v.n| at the collocation sites `sites`, with v = `slope`, divided by
/// ParticleScene::unit_speed(). v is relative to the velocity of the centroid. The result is zero if the shape is steady.
double normal_velocity(const ParticleScene& particle_scene, const Body& body, const surface::Geometry& geometry, const Net& x, const Net& slope,
                       std::span<const int> sites);

}  // namespace tanktread
