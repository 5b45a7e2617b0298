#include "scene/series/diagnostics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "base/indices.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "spline/bernstein.hpp"
#include "surface/geometry.hpp"
#include "surface/patch.hpp"
#include "surface/transport.hpp"

namespace tanktread {

double angle_in(const FlowPlane& plane, const Vec3& y) {
  const Vec3 at = plane.components(y);
  return std::atan2(-at[2], at[0]) * 180 / std::numbers::pi;
}

namespace {

constexpr const char* axes_of_space = "x1 x2 x3";

void add_energy(double energy, Columns& to) {
  to.add(energy, {"energy", "force length",
                  "energy stored in the membrane, including the springs of a Maxwell element (3.23); for a drop with surfactant the free "
                  "energy of its interface (3.21)"});
}

void add_velocity(const Vec3& velocity, Columns& to) {
  to.add(
      velocity, axes_of_space,
      {"velocity_", "length/time",
       "component # of the velocity of the particle's centroid (6.4), or of a rigid body's centre; without a particle's name before it, "
       "the mean over all particles"});
}

void add_centroid(const Vec3& centroid, Columns& to) {
  to.add(centroid, axes_of_space,
         {"centroid_", "length",
          "component # of the position of the particle's centroid; in a tube, x1 counts from the position at the start"});
}

/// Returns the cosine of the angle between the vector y and the first direction of the plane.
double ahead(const FlowPlane& plane, const Vec3& y) { return plane.components(y).normalized()[0]; }

/// Returns the parametric point at which the ray from `from` along the first direction of the plane meets the element, by Newton's method from the
/// parametric point `site`.
spline::Site straight_ahead(const surface::ElementPoints& element, spline::Site site, const Vec3& from, const FlowPlane& plane) {
  // Limits a Newton step so that s and t stay inside the element, because the iteration would stop at a pole on the boundary of the element.
  const auto stepped = [](double at, double step) { return std::clamp(at + step, 0.1 * at, 1 - 0.1 * (1 - at)); };
  for (int iteration = 0; iteration < 20; ++iteration) {
    const surface::Jet at = surface::jet(element.patch(), site.s, site.t);
    const Vec3 y = plane.components(at.x - from), ds = plane.components(at.s), dt = plane.components(at.t);
    const double determinant = ds[1] * dt[2] - ds[2] * dt[1];
    if (!(std::abs(determinant) > 1e-9 * ds.norm() * dt.norm())) break;  // ends if the Jacobian is singular, as at a pole, where `ds` or `dt` is 0
    site.s = stepped(site.s, -(y[1] * dt[2] - y[2] * dt[1]) / determinant);
    site.t = stepped(site.t, -(ds[1] * y[2] - ds[2] * y[1]) / determinant);
  }
  return site;
}

/// Extremes over the part of the surface that one rank evaluates: the smallest tension (infinity without elements), the largest change of area, and
/// the largest normal velocity.
using Extremes = std::array<double, 3>;

double sum(const std::vector<double>& all) { return std::accumulate(all.begin(), all.end(), 0.); }

/// Returns the elements that this rank evaluates: whole blocks of elements.
std::vector<int> own_elements(const surface::Geometry& geometry, const coupling::Ranks& ranks) {
  return surface::elements_of(ranks.share(geometry.n_blocks()), geometry.bezier().n_elements());
}

}  // namespace

void ParticleRow::add_moving(const ParticleScene& particle_scene, Columns& to) const {
  to.add(shape.inclination,
         {"inclination", "degree",
          "inclination: angle of the particle's longest axis of inertia with the first direction of the plane of the flow (x1), positive "
          "towards the second direction (x3)",
          "the two semi-axes in the plane of the flow (any two if the flow is not planar) differ by less than 1e-6 R_C"});
  add_stresslet(stresslet, to);
  to.add(shape.lengths, axes_of_space, {"length_", "length", "extent of the particle along #: largest minus smallest coordinate of its "
                                                             "surface"});
  if (to.when(particle_scene.output.view.has_value())) {
    to.add(silhouette.area, {"projected_area", "length^2",
                             "area of the particle as seen in the direction Output/view direction: the area inside its outline, which is the outer "
                             "boundary of its projection"});
    to.add(silhouette.circularity, {"circularity", "1", "circularity 4 pi A/P^2 of the outline of `projected_area`, with its area A and perimeter P; "
                                                        "1 for a circle"});
    to.add(silhouette.hull_area, {"hull_area", "length^2", "area of the convex hull of the outline of `projected_area`"});
    to.add(silhouette.hull_circularity, {"hull_circularity", "1", "circularity 4 pi A/P^2 of the convex hull of the outline of `projected_area`"});
  }
  add_points(n_points, to);
  add_velocity(velocity, to);
  if (to.when(has_intrinsic_viscosity(particle_scene)))
    to.add(intrinsic_viscosity, {"intrinsic_viscosity", "1",
                                 "intrinsic viscosity S:E/(2 mu V E:E), with the stresslet S (6.7), the particle's volume V, the outer "
                                 "viscosity mu and the rate of strain E of the flow at this time; 5/2 for a rigid sphere",
                                 "the rate of strain of the flow is zero at this time"});
}

void ParticleRow::add_turning(const ParticleScene& particle_scene, Columns& to) const {
  to.add(axes.lengths, "1 2 3",
         {"axis_", "length", "semi-axis # of the ellipsoid with the particle's second moments (6.1); 1 is the longest"});
  to.add(axes.longest_defined ? Vec3(axes.directions.col(0)) : Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), axes_of_space,
         {"axis_1_", "1", "component # of the unit vector along the longest semi-axis; the first nonzero component is positive",
          "the two longest semi-axes differ by less than 1e-6 R_C"});
  to.add(
      treading.velocity,
      {"tank_treading_velocity", "length/time",
       "tank-treading velocity: mean tangential velocity, relative to the centroid, on the curve in which the plane of the flow through "
       "the centroid cuts the surface (6.5); positive if the side of larger x3 moves along x1 (clockwise with x1 to the right and x3 up)"});
  to.add(treading.frequency, {"tank_treading_frequency", "1/time",
                              "tank-treading frequency: mean angular velocity about the centroid, in radians per time, of the material "
                              "points of the curve of `tank_treading_velocity` (6.6), positive in the same sense. In a steady motion it is "
                              "2 pi divided by the period; for a rigid body it is its angular velocity"});
  to.add(phase, {"phase", "degree",
                 "phase of tank-treading: angle about the centroid, in the plane of the flow, of the material point that starts at the "
                 "angle 0 (direction x1), positive like `tank_treading_velocity` and not reduced by whole turns. For a drop whose mesh "
                 "slides it is the time integral of `tank_treading_frequency`"});
  if (!to.when(particle_scene.tube.present)) return;
  const auto off_axis = centre.tail<2>(), moves = velocity.tail<2>();
  to.add(off_axis.dot(moves) > 0 ? -moves.norm() : moves.norm(),
         {"migration_velocity",
          "length/time",
          "speed of the centroid in the plane x2 x3, positive towards the axis of the tube",
          {},
          "; in a tube"});
}

void DeformingRow::add_columns(const ParticleScene& particle_scene, Columns& to) const {
  to.add(shape.taylor_inertia, {"taylor_inertia", "1",
                                "Taylor deformation parameter D = (L - B)/(L + B) (6.2), with the longest and shortest semi-axis L and B, "
                                "in the plane of the flow, of the ellipsoid with the particle's second moments"});
  to.add(shape.taylor_surface, {"taylor_surface", "1",
                                "Taylor deformation parameter D = (L - B)/(L + B) (6.2), with the longest and shortest distance L and B "
                                "from the centroid to the surface, in the plane of the flow"});
  add_moving(particle_scene, to);
  add_size(measures, to);
  to.add(volume_error, {"volume_error", "1", "relative error V/V0 - 1 of the particle's volume V, with its volume V0 at the start"});
  if (to.when(particle_scene.adaptation.enabled))
    to.add(refit_error, {"refit_error", "1",
                         "sum of the displacements of the current and the unstressed surface by all refinements and coarsenings of the "
                         "mesh so far, divided by R_C, the radius of the sphere with the particle's volume"});
  add_energy(energy, to);
  if (to.when(particle_scene.viscous_membrane()))
    to.add(dissipation, {"membrane_dissipation", "force length/time", "power dissipated by the viscosity of the membrane (3.10), (3.25)"});
  to.add(
      tension.smallest,
      {"smallest_tension", "1",
       "smallest principal tension anywhere on the membrane, negative under compression, divided by the surface shear modulus G_s; for a "
       "drop divided by the surface tension. Includes the tension of Membrane/global area dilatation and that of a surfactant, but "
       "not the stresses of Membrane/relaxation time and of surface viscosity"});
  to.add(tension.compressed_area, {"compressed_area", "1", "fraction of the membrane's area where a principal tension is negative, so "
                                                           "that the membrane may wrinkle"});
  if (to.when(!particle_scene.membrane.fluid_interface())) {
    to.add(tension.area_change,
           {"local_area_change", "1", "largest relative change of area anywhere on the membrane: maximum of |J - 1|, with J the current "
                                      "area divided by the unstressed area of the same material"});
    to.add(tension.rms_area_change,
           {"rms_area_change", "1", "root mean square of the relative change of area over the unstressed membrane: of J - 1, with J the current "
                                    "area divided by the unstressed area of the same material"});
  }
  to.add(normal_velocity,
         {"normal_velocity", "1",
          "largest normal velocity |v.n| on the surface relative to the mean velocity of the particle, divided by rate x R_C, or in a tube by the "
          "mean velocity of the fluid. If the flow has neither, the rate is surface modulus/(viscosity R_C). It is zero if the shape is "
          "steady. R_C: radius of the sphere with the particle's volume"});
  to.add(shape_velocity, {"shape_velocity", "1",
                          "root mean square of the part of the normal velocity v.n that changes the shape smoothly (6.8), divided like "
                          "`normal_velocity`. The run is steady when it falls below Time/steady tolerance"});
  add_centroid(centre, to);
  add_turning(particle_scene, to);
}

void RigidRow::add_columns(const ParticleScene& particle_scene, Columns& to) const {
  add_moving(particle_scene, to);
  to.add(angular_velocity, axes_of_space, {"angular_velocity_", "1/time", "component # of the angular velocity of the rigid body"});
  to.add(quaternion, "0 1 2 3",
         {"quaternion_", "1",
          "component # of the quaternion of the rotation from the initial to the current orientation; 0 is the scalar part"});
  if (to.when(particle_scene.time.steady_tolerance.has_value()))
    to.add(shape_velocity, {"shape_velocity", "1",
                            "root mean square of the normal velocity due to the rotation of the rigid body, divided by rate x R_C, or in a "
                            "tube by the mean velocity (6.8). The run is steady when it falls below Time/steady tolerance"});
  if (particle_scene.in_system()) {
    add_size(measures, to);
    add_centroid(centre, to);
    add_drag(drag, torque, to);
  } else {
    to.add(centre, axes_of_space, {"center_", "length", "component # of the position of the rigid body's centre"});
    add_turning(particle_scene, to);
  }
}

void Together::add_columns(const Scene& scene, Columns& to) const {
  if (!scene.has_gaps()) return;
  if (scene.named() || scene.particles.front().particle.rigid()) add_energy(energy, to);
  if (!scene.named()) return;  // the columns of the only particle have the names used here
  add_stresslet(stresslet, to);
  add_points(n_points, to);
  add_velocity(velocity, to);
}

void add_points(int n_points, Columns& to) { to.add(n_points, {"n_control_points", "1", "number of control points of the surface mesh"}); }

void add_size(const surface::Measures& measures, Columns& to) {
  to.add(measures.volume, {"volume", "length^3", "volume enclosed by the particle's surface"});
  to.add(measures.area, {"area", "length^2", "area of the particle's surface"});
}

void add_stresslet(const Mat3& stresslet, Columns& to) {
  to.add(components(stresslet), "11 22 33 12 13 23", {"stresslet_", "force length", "component # of the particle's stresslet, the "
                                                                                    "symmetric force dipole by which it contributes to "
                                                                                    "the stress of a suspension, without its trace (6.7)"});
}

void add_drag(const Vec3& drag, const Vec3& torque, Columns& to) {
  to.add(drag, axes_of_space, {"drag_", "force", "component # of the force of the fluid on the particle"});
  to.add(torque, axes_of_space, {"torque_", "force length", "component # of the torque of the fluid on the particle about its centre"});
}

void add_gap(double to_wall, Columns& to) {
  to.add(to_wall, {"gap", "length", "smallest distance between the surface of a particle and the wall", {}, "; in a tube, beside a plane wall"});
}

Eigen::Vector<double, 6> components(const Mat3& tensor) {
  return Eigen::Vector<double, 6>{{tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1), tensor(0, 2), tensor(1, 2)}};
}

bool has_intrinsic_viscosity(const SharedOptions& shared) {
  if (shared.tube.present) return false;
  const stokes::AmbientFlow flow(shared.flow);
  const Mat3 gradient = flow.gradient(Vec3::Zero());
  return flow.affine() && (gradient + gradient.transpose()).norm() > 1e-10 * gradient.norm();
}

spline::Site site_ahead(const spline::Space& space, const Net& x, const Vec3& from, const FlowPlane& plane) {
  constexpr int intervals = 4;
  spline::Site best;
  double most = -2;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    const surface::ElementPoints element(space, x, e);
    const auto of = [&](const spline::Site& site) { return ahead(plane, surface::position(element.patch(), site.s, site.t) - from); };
    spline::Site start;
    double nearest = -2;
    for (int k = 0; k < intervals * intervals; ++k) {
      const spline::Site site{e, (k % intervals + 0.5) / intervals, (k / intervals + 0.5) / intervals};
      if (const double here = of(site); here > nearest + 1e-12) start = site, nearest = here;
    }
    if (nearest < 0.5) continue;  // skips elements whose points are all more than about 60 degrees off the ray (cos 60 degrees = 0.5)
    for (const spline::Site& site : {start, straight_ahead(element, start, from, plane)})
      if (const double here = of(site); here > most + 1e-12) best = site, most = here;
  }
  return best;
}

double intrinsic_viscosity(const stokes::AmbientFlow& flow, double viscosity, const ParticleRow& now) {
  if (!flow.affine()) return 0;
  const Mat3 gradient = flow.gradient(now.centre), strain = (gradient + gradient.transpose()) / 2;
  if (flow.pauses() || strain.isZero(0)) return std::numeric_limits<double>::quiet_NaN();
  return now.stresslet.cwiseProduct(strain).sum() / (2 * viscosity * now.measures.volume * strain.squaredNorm());
}

RigidRow rigid_row(const ParticleScene& particle_scene, const Body& body, const stokes::AmbientFlow& flow, const surface::Geometry& geometry,
                   const Net& x, const coupling::RigidMotion& motion, const Eigen::Quaterniond& turn, const Mat3& stresslet,
                   const coupling::Ranks& ranks) {
  RigidRow now;
  now.n_points = body.space.n_points;
  now.measures = geometry.measures(x);
  now.shape = deformation(geometry, body.plane, x, now.measures, ranks);
  now.axes = surface::principal_axes(now.measures);
  if (const auto& view = particle_scene.output.view) now.silhouette = surface::silhouette(geometry.bezier(), x, *view);
  now.stresslet = stresslet;
  now.centre = now.measures.centroid;
  now.velocity = motion.velocity, now.angular_velocity = motion.angular_velocity;
  now.quaternion << turn.w(), turn.vec();
  now.intrinsic_viscosity = intrinsic_viscosity(flow, particle_scene.flow.viscosity, now);
  if (!particle_scene.time.steady_tolerance) return now;
  const std::vector<int> elements = indices(geometry.bezier().n_elements());
  const Net v = coupling::rigid_velocity(x, motion, now.centre);
  const std::vector<double> sums = surface::shape_velocity_sums(geometry.bezier(), x, v, body.radius, elements);
  now.shape_velocity = surface::shape_velocity(sums, particle_scene.tube.present) / particle_scene.unit_speed();
  return now;
}

surface::Deformation deformation(const surface::Geometry& geometry, const FlowPlane& of_flow, const Net& x, surface::Measures measures,
                                 const coupling::Ranks& ranks) {
  FlowPlane plane = of_flow;
  bool plane_defined = true;
  if (!plane.contains_flow) {
    const surface::PrincipalAxes axes = surface::principal_axes(measures);
    plane = plane_normal_to(axes.directions.col(1));
    plane_defined = axes.longest_defined && axes.shortest_defined;
  }
  const std::vector<int> own = own_elements(geometry, ranks);
  std::array<surface::Range, surface::Geometry::n_extremes> extremes = geometry.extremes(x, measures.centroid, own);
  if (!plane.fixed()) {
    extremes[0] = surface::section_distances(surface::Patches(geometry.bezier(), plane.turned(x), own), plane.components(measures.centroid));
    measures.second_moments = plane.axes * measures.second_moments * plane.axes.transpose();
  }
  std::array<double, 2 * surface::Geometry::n_extremes> ends;
  for (size_t k = 0; k < extremes.size(); ++k) ends[2 * k] = extremes[k].smallest, ends[2 * k + 1] = extremes[k].largest;
  for (const auto& of_rank : ranks.gathered(ends))
    for (size_t k = 0; k < extremes.size(); ++k) extremes[k] = wider(extremes[k], {of_rank[2 * k], of_rank[2 * k + 1]});
  surface::Deformation result = surface::Geometry::deformation(measures, extremes);
  if (!plane_defined) result.inclination = std::numeric_limits<double>::quiet_NaN();
  return result;
}

DeformingRow deforming_row(const ParticleScene& particle_scene, const Body& body, const surface::Geometry& geometry,
                           const membrane::Membrane& membrane, const Net& x, const Net& slope, const coupling::Ranks& ranks) {
  const std::vector<int> blocks = ranks.share(geometry.n_blocks());
  const std::vector<int> elements = own_elements(geometry, ranks);
  const std::vector<int>& sites = body.symmetry.fundamental();  // fundamental collocation sites; all other sites are symmetry images of these
  std::vector<int> own;
  for (const int k : ranks.share(static_cast<int>(sites.size()))) own.push_back(sites[static_cast<size_t>(k)]);
  const membrane::ElementTensions tensions = membrane.element_tensions(x, elements, global_tension(particle_scene, body, x));
  const auto [moments, energy, area, compressed, unstressed, squared_change, shape] = ranks.of_all(std::array{
      geometry.block_moments(x, blocks), surface::block_sums(membrane.element_energies(x, elements)), surface::block_sums(tensions.area),
      surface::block_sums(tensions.compressed), surface::block_sums(tensions.unstressed), surface::block_sums(tensions.squared_change),
      surface::shape_velocity_sums(geometry.bezier(), x, slope, body.radius, elements)});
  const std::vector<Extremes> of_ranks = ranks.gathered(Extremes{elements.empty() ? std::numeric_limits<double>::infinity() : tensions.smallest,
                                                                 tensions.area_change,
                                                                 normal_velocity(particle_scene, body, geometry, x, slope, own)});
  const auto value = [](std::size_t k) { return [k](const Extremes& one) { return one[k]; }; };
  const auto largest = [&](std::size_t k) { return std::ranges::max(of_ranks, {}, value(k))[k]; };
  DeformingRow now;
  now.n_points = body.space.n_points;
  now.measures = surface::Geometry::measures(x, moments);
  now.shape = deformation(geometry, body.plane, x, now.measures, ranks);
  now.axes = surface::principal_axes(now.measures);
  if (const auto& view = particle_scene.output.view) now.silhouette = surface::silhouette(geometry.bezier(), x, *view);
  now.refit_error = body.refit_error;
  now.energy = sum(energy);
  now.tension = {std::ranges::min(of_ranks, {}, value(0))[0], sum(compressed) / sum(area), largest(1),
                 std::sqrt(sum(squared_change) / sum(unstressed))};
  now.normal_velocity = largest(2);
  now.shape_velocity = surface::shape_velocity(shape, particle_scene.tube.present) / particle_scene.unit_speed();
  now.centre = now.measures.centroid;
  return now;
}

void add_treading(const ParticleScene& particle_scene, const Body& body, const surface::Geometry& geometry, const Net& x, const Net& v,
                  ParticleRow& now) {
  const FlowPlane& plane = body.plane;
  now.velocity = surface::centroid_velocity(geometry.bezier(), x, v);
  const bool elastic = !particle_scene.membrane.fluid_interface();
  now.treading = surface::tank_treading(geometry.bezier(), plane.turned(x), plane.turned(v), elastic ? &body.unstressed : nullptr,
                                        plane.components(now.centre), plane.components(now.velocity));
}

double normal_velocity(const ParticleScene& particle_scene, const Body& body, const surface::Geometry& geometry, const Net& x, const Net& slope,
                       std::span<const int> sites) {
  double largest = 0;
  const Vec3 frame = surface::centroid_velocity(geometry.bezier(), x, slope);
  const surface::BezierMap& map = geometry.bezier();
  constexpr int most = 3 * (spline::most_polynomial_degree + 1) * (spline::most_polynomial_degree + 1);
  double points[most], velocities[most];
  for (const int i : sites) {
    const auto& [element, s, t] = body.space.collocation[static_cast<size_t>(i)].front();
    map.points(element, x, points);
    map.points(element, slope, velocities);
    const surface::Jet at = surface::jet({map.degree(element), points}, s, t);
    const Vec3 v = surface::position({map.degree(element), velocities}, s, t) - frame;
    largest = std::max(largest, std::abs(v.dot(at.s.cross(at.t).normalized())));
  }
  return largest / particle_scene.unit_speed();
}

}  // namespace tanktread
