#include "app/diagnostics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "spline/bernstein.hpp"
#include "surface/extremes.hpp"
#include "surface/geometry.hpp"
#include "surface/patch.hpp"
#include "surface/shape_velocity.hpp"
#include "surface/transport.hpp"

namespace tanktread {

namespace {

/// Every series of every kind of particle, once.
constexpr Series table[] = {
    {"time", "time", "simulated time; 0 of a steady problem", [](const Moment& m) { return m.time; }},
    {"time_step", "time", "size of the step that ended here", [](const Moment& m) { return m.step.step; }},
    {"taylor_inertia", "1", "Taylor parameter (6.2) of the ellipsoid with the same second moments, in the plane of the flow",
     [](const Moment& m) { return m.shape.taylor_inertia; }},
    {"taylor_surface", "1", "Taylor parameter (6.2) of the longest and shortest distance from the centroid, in the plane of the flow",
     [](const Moment& m) { return m.shape.taylor_surface; }},
    {"inclination", "degree", "angle of the long axis of inertia with the first direction of the plane of the flow (x1), towards the second (x3)",
     [](const Moment& m) { return m.shape.inclination; }},
    {"volume", "length^3", "enclosed volume (P-43)", [](const Moment& m) { return m.measures.volume; }},
    {"volume_error", "1", "V/V0 - 1", [](const Moment& m) { return m.volume_error; }},
    {"refit_error", "1", "sum of what changes of the mesh have moved the present and the unstressed surface by so far, over R_C",
     [](const Moment& m) { return m.refit_error; }},
    {"area", "length^2", "area of the surface", [](const Moment& m) { return m.measures.area; }},
    {"energy", "force length", "energy stored in the membrane", [](const Moment& m) { return m.energy; }},
    {"smallest_tension", "1", "smallest principal tension over G_s", [](const Moment& m) { return m.tension.smallest; }},
    {"compressed_area", "1", "share of the area with a negative principal tension",
     [](const Moment& m) { return m.tension.compressed_area; }},
    {"stresslet_11", "force length", "particle stresslet (6.7), component 11", [](const Moment& m) { return m.stresslet(0, 0); }},
    {"stresslet_22", "force length", "particle stresslet (6.7), component 22", [](const Moment& m) { return m.stresslet(1, 1); }},
    {"stresslet_33", "force length", "particle stresslet (6.7), component 33", [](const Moment& m) { return m.stresslet(2, 2); }},
    {"stresslet_12", "force length", "particle stresslet (6.7), component 12", [](const Moment& m) { return m.stresslet(0, 1); }},
    {"stresslet_13", "force length", "particle stresslet (6.7), component 13", [](const Moment& m) { return m.stresslet(0, 2); }},
    {"stresslet_23", "force length", "particle stresslet (6.7), component 23", [](const Moment& m) { return m.stresslet(1, 2); }},
    {"length_x1", "length", "extent along x1", [](const Moment& m) { return m.shape.lengths[0]; }},
    {"length_x2", "length", "extent along x2", [](const Moment& m) { return m.shape.lengths[1]; }},
    {"length_x3", "length", "extent along x3", [](const Moment& m) { return m.shape.lengths[2]; }},
    {"normal_velocity", "1",
     "largest |v.n| over rate x R_C (in a tube over the mean velocity; there and in parabolic flow in the particle's frame): "
     "zero when the shape is steady",
     [](const Moment& m) { return m.normal_velocity; }},
    {"shape_velocity", "1", "what smooth changes of shape have of it, root mean square (6.8): `Time/steady tolerance` is held against this",
     [](const Moment& m) { return m.shape_velocity; }},
    {"n_control_points", "1", "control points of the surface", [](const Moment& m) { return static_cast<double>(m.n_points); }},
    {"step_error", "1", "estimated error of the step, in the norm of Time/tolerance", [](const Moment& m) { return m.step.error; }},
    {"rejected_steps", "1", "attempts given up in this step", [](const Moment& m) { return static_cast<double>(m.step.rejected); }},
    {"iterations", "1", "nonlinear iterations or sub-iterations in this step",
     [](const Moment& m) { return static_cast<double>(m.step.iterations); }},
    {"evaluations", "1", "velocity evaluations so far", [](const Moment& m) { return static_cast<double>(m.work.evaluations); }},
    {"assemblies", "1", "assemblies of the frozen layer operator so far",
     [](const Moment& m) { return static_cast<double>(m.work.assemblies); }},
    {"solver_iterations", "1", "iterations of the linear solver so far",
     [](const Moment& m) { return static_cast<double>(m.work.solver_iterations); }},
    {"velocity_iterations", "1", "iterations of the systems that velocities come from so far (viscosity ratio other than 1)",
     [](const Moment& m) { return static_cast<double>(m.work.velocity_iterations); }},
    {"wall_seconds", "s", "time since the run was started, earlier parts of a resumed run included",
     [](const Moment& m) { return m.wall_seconds; }},
    {"centroid_x1", "length", "centroid (P-42), component 1; in a tube what the frame has travelled",
     [](const Moment& m) { return m.centre[0]; }},
    {"centroid_x2", "length", "centroid (P-42), component 2", [](const Moment& m) { return m.centre[1]; }},
    {"centroid_x3", "length", "centroid (P-42), component 3", [](const Moment& m) { return m.centre[2]; }},
    {"center_x1", "length", "centre of the rigid body, component 1", [](const Moment& m) { return m.centre[0]; }},
    {"center_x2", "length", "centre of the rigid body, component 2", [](const Moment& m) { return m.centre[1]; }},
    {"center_x3", "length", "centre of the rigid body, component 3", [](const Moment& m) { return m.centre[2]; }},
    {"velocity_x1", "length/time", "of the centroid (6.4), or of the centre of a rigid body, component 1",
     [](const Moment& m) { return m.velocity[0]; }},
    {"velocity_x2", "length/time", "of the centroid (6.4), or of the centre of a rigid body, component 2",
     [](const Moment& m) { return m.velocity[1]; }},
    {"velocity_x3", "length/time", "of the centroid (6.4), or of the centre of a rigid body, component 3",
     [](const Moment& m) { return m.velocity[2]; }},
    {"angular_velocity_x1", "1/time", "of the rigid body, component 1", [](const Moment& m) { return m.angular_velocity[0]; }},
    {"angular_velocity_x2", "1/time", "of the rigid body, component 2", [](const Moment& m) { return m.angular_velocity[1]; }},
    {"angular_velocity_x3", "1/time", "of the rigid body, component 3", [](const Moment& m) { return m.angular_velocity[2]; }},
    {"quaternion_0", "1", "scalar part of the turn from the initial place", [](const Moment& m) { return m.quaternion[0]; }},
    {"quaternion_1", "1", "vector part, component 1", [](const Moment& m) { return m.quaternion[1]; }},
    {"quaternion_2", "1", "vector part, component 2", [](const Moment& m) { return m.quaternion[2]; }},
    {"quaternion_3", "1", "vector part, component 3", [](const Moment& m) { return m.quaternion[3]; }},
    {"axis_1", "length", "longest semi-axis of the ellipsoid with the same second moments (6.1)",
     [](const Moment& m) { return m.axes.lengths[0]; }},
    {"axis_2", "length", "the middle one", [](const Moment& m) { return m.axes.lengths[1]; }},
    {"axis_3", "length", "the shortest one", [](const Moment& m) { return m.axes.lengths[2]; }},
    {"axis_1_x1", "1", "direction of the longest one, component 1; the first component that is not zero is positive. Any where two are longest",
     [](const Moment& m) { return m.axes.directions(0, 0); }},
    {"axis_1_x2", "1", "direction of the longest one, component 2", [](const Moment& m) { return m.axes.directions(1, 0); }},
    {"axis_1_x3", "1", "direction of the longest one, component 3", [](const Moment& m) { return m.axes.directions(2, 0); }},
    {"tank_treading_velocity", "length/time",
     "mean tangential velocity relative to the centroid on the curve that the plane of the flow through it cuts out (6.5); positive where the side "
     "of larger x3 moves along x1, clockwise with x1 to the right and x3 up",
     [](const Moment& m) { return m.treading.velocity; }},
    {"tank_treading_frequency", "1/time",
     "mean angular velocity of the material points of that curve about the centroid (6.6), in radians over time and of the same sense: 2 pi over "
     "the period of a steady motion; of a rigid body its angular velocity",
     [](const Moment& m) { return m.treading.frequency; }},
    {"phase", "degree",
     "angle about the centroid, in the plane of the flow and of the same sense, of the material point that starts at the angle 0, on the side of "
     "x1, counted on past whole turns; of a drop whose mesh slides the integral of tank_treading_frequency",
     [](const Moment& m) { return m.phase; }},
    {"intrinsic_viscosity", "1", "S:E/(2 mu V E:E) with the stresslet S (6.7) and the rate of strain E of the flow: 5/2 of a rigid sphere",
     [](const Moment& m) { return m.intrinsic_viscosity; }},
    {"migration_velocity", "length/time", "speed of the centroid in the x2 x3 plane, positive towards the axis of the tube",
     [](const Moment& m) { return m.velocity.tail<2>().norm() * (m.centre.tail<2>().dot(m.velocity.tail<2>()) > 0 ? -1 : 1); }},
    {"disturbed_pressure_drop", "force/length^2", "pressure drop that the particle adds (2.7)",
     [](const Moment& m) { return m.pressure_drop; }},
    {"gap", "length", "smallest distance between particle and wall", [](const Moment& m) { return m.gap; }},
    {"smallest_gap", "length", "smallest distance between two of several particles", [](const Moment& m) { return m.nearest.gap; }},
    {"first_of_gap", "1", "number of the first of these two, from 1 in the order of the deck",
     [](const Moment& m) { return double(m.nearest.first); }},
    {"second_of_gap", "1", "number of the second one", [](const Moment& m) { return double(m.nearest.second); }},
    {"gap_x1", "length", "place between their nearest points, component 1", [](const Moment& m) { return m.nearest.place[0]; }},
    {"gap_x2", "length", "place between their nearest points, component 2", [](const Moment& m) { return m.nearest.place[1]; }},
    {"gap_x3", "length", "place between their nearest points, component 3", [](const Moment& m) { return m.nearest.place[2]; }},
    {"disturbance_flux", "1", "flow rate of the disturbance through the inlet, over the duct's: should vanish (2.14)",
     [](const Moment& m) { return m.tube.flux; }},
    {"force_imbalance", "1",
     "axial force of the disturbance on caps, wall and particle, over the duct's own on the length R_T: should vanish (2.14)",
     [](const Moment& m) { return m.tube.force; }},
    {"cap_velocity", "1", "largest disturbance velocity left on the caps, over the mean velocity",
     [](const Moment& m) { return m.tube.cap_velocity; }},
    {"pressure_drop_by_flux", "force/length^2", "disturbed pressure drop for which the flux of the disturbance vanishes",
     [](const Moment& m) { return m.tube.pressure_by_flux; }},
    {"pressure_drop_by_force", "force/length^2", "disturbed pressure drop for which the axial forces balance",
     [](const Moment& m) { return m.tube.pressure_by_force; }},
    {"drag_x1", "force", "force on the particle, component 1", [](const Moment& m) { return m.drag[0]; }},
    {"drag_x2", "force", "force on the particle, component 2", [](const Moment& m) { return m.drag[1]; }},
    {"drag_x3", "force", "force on the particle, component 3", [](const Moment& m) { return m.drag[2]; }},
    {"torque_x1", "force length", "torque on the particle about its centre, component 1", [](const Moment& m) { return m.torque[0]; }},
    {"torque_x2", "force length", "torque on the particle about its centre, component 2", [](const Moment& m) { return m.torque[1]; }},
    {"torque_x3", "force length", "torque on the particle about its centre, component 3", [](const Moment& m) { return m.torque[2]; }},
    {"drag_error", "1", "|F - F_exact|/|F_exact|, where the exact force is known and not zero",
     [](const Moment& m) { return m.drag_error; }},
    {"drag_error_of_traction", "1", "the same, of the integral of the traction alone",
     [](const Moment& m) { return m.drag_error_of_traction; }},
    {"torque_error", "1", "|T - T_exact|/|T_exact|, where the exact torque is known and not zero",
     [](const Moment& m) { return m.torque_error; }},
    {"pressure_l2_error", "1", "L2 norm of p - p_exact over that of p_exact, p = -t.n (6.3), where that is known",
     [](const Moment& m) { return m.pressure_error; }},
    {"normal_l2_error", "1", "L2 norm of n_h - n over that of n (6.3), where that is known",
     [](const Moment& m) { return m.normal_error; }},
    {"kernel_evaluations", "1", "of the layer operator, all rules together", [](const Moment& m) { return m.kernel_evaluations; }},
};

}  // namespace

std::span<const Series> all_series() { return table; }

std::vector<Series> series(std::initializer_list<std::string_view> names) {
  std::vector<Series> found;
  for (const std::string_view name : names) {
    const auto* const one = std::ranges::find(table, name, &Series::name);
    if (one == std::end(table)) throw std::logic_error("no series " + std::string(name));
    found.push_back(*one);
  }
  return found;
}

std::vector<Column> columns(std::span<const Series> of) {
  std::vector<Column> all;
  for (const Series& one : of) all.push_back({std::string(one.name), one.unit, one.description});
  return all;
}

std::vector<double> row(std::span<const Series> of, const Moment& moment) {
  std::vector<double> values;
  for (const Series& one : of) {
    values.push_back(one.value(moment));
    if (std::isnan(values.back())) throw RunFailure("the series " + std::string(one.name) + " is not a number");
  }
  return values;
}

double angle_in(const FlowPlane& plane, const Vec3& y) {
  const Vec3 at = plane.components(y);
  return std::atan2(-at[2], at[0]) * 180 / std::numbers::pi;
}

namespace {

/// How far along the plane's first direction a place lies, seen from another: the cosine of the angle between.
double ahead(const FlowPlane& plane, const Vec3& y) { return plane.components(y).normalized()[0]; }

/// The site of one element nearest to being ahead, by Newton's method from a start.
spline::Site straight_ahead(const surface::ElementPoints& element, spline::Site site, const Vec3& from, const FlowPlane& plane) {
  const auto stepped = [](double at, double step) { return std::clamp(at + step, 0.1 * at, 1 - 0.1 * (1 - at)); };  // a pole has no way out
  for (int iteration = 0; iteration < 20; ++iteration) {
    const surface::Jet at = surface::jet(element.patch(), site.s, site.t);
    const Vec3 y = plane.components(at.x - from), ds = plane.components(at.s), dt = plane.components(at.t);
    const double determinant = ds[1] * dt[2] - ds[2] * dt[1];
    if (!(std::abs(determinant) > 1e-9 * ds.norm() * dt.norm())) break;  // a pole, where one of them may be exactly zero
    site.s = stepped(site.s, -(y[1] * dt[2] - y[2] * dt[1]) / determinant);
    site.t = stepped(site.t, -(ds[1] * y[2] - ds[2] * y[1]) / determinant);
  }
  return site;
}

}  // namespace

spline::Site site_ahead(const spline::Space& space, const Net& x, const Vec3& from, const FlowPlane& plane) {
  constexpr int intervals = 4;
  spline::Site best;
  double most = -2;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    const surface::ElementPoints element(space, x, e);
    const auto of = [&](const spline::Site& site) { return ahead(plane, surface::place(element.patch(), site.s, site.t) - from); };
    spline::Site start;
    double nearest = -2;
    for (int k = 0; k < intervals * intervals; ++k) {
      const spline::Site site{e, (k % intervals + 0.5) / intervals, (k / intervals + 0.5) / intervals};
      if (const double here = of(site); here > nearest + 1e-12) start = site, nearest = here;
    }
    if (nearest < 0.5) continue;  // no element of a closed surface is seen at so wide an angle
    for (const spline::Site& site : {start, straight_ahead(element, start, from, plane)})
      if (const double here = of(site); here > most + 1e-12) best = site, most = here;
  }
  return best;
}

double intrinsic_viscosity(const Mat3& stresslet, const Mat3& gradient, double viscosity, double volume) {
  const Mat3 strain = (gradient + gradient.transpose()) / 2;
  return stresslet.cwiseProduct(strain).sum() / (2 * viscosity * volume * strain.squaredNorm());
}

bool strains(const Scene& scene) {
  if (scene.tube.present) return false;
  const stokes::AmbientFlow flow(scene.flow);
  const Mat3 gradient = flow.gradient(Vec3::Zero());
  return flow.affine() && (gradient + gradient.transpose()).norm() > 1e-10 * gradient.norm();
}

std::vector<double> entries_of_particles(const std::vector<Column>& columns, const std::vector<double>& row, std::string_view name) {
  std::vector<double> found;
  for (size_t k = 0; k < columns.size(); ++k)
    if (columns[k].name.ends_with("/" + std::string(name))) found.push_back(row.at(k));
  if (const auto own = std::ranges::find(columns, name, &Column::name); found.empty() && own != columns.end())
    found.push_back(row.at(static_cast<size_t>(own - columns.begin())));
  return found;
}

double entry(const std::vector<Column>& columns, const std::vector<double>& row, std::string_view name) {
  const auto at = std::ranges::find(columns, name, &Column::name);
  if (at == columns.end()) throw std::out_of_range("there is no series '" + std::string(name) + "'");
  return row.at(static_cast<size_t>(at - columns.begin()));
}

namespace {

/// Rate x R_C, or the mean velocity in a tube; of a fluid at rest R_C per unit of time.
double unit_speed(const Scene& scene, const Body& body) { return scene.speed() > 0 ? scene.speed() : body.radius; }

/// What is summed over elements, or sought on them and at sites.
struct Whole {
  surface::Measures measures;
  membrane::TensionSummary tension;
  double energy, normal_velocity, shape_velocity;  // the velocities over `unit_speed`
};

/// One number a rank, of which only this rank's is known yet.
std::vector<double> slots(const coupling::Ranks& ranks, double mine) {
  std::vector<double> all(static_cast<size_t>(ranks.size()), 0);
  all[static_cast<size_t>(ranks.rank())] = mine;
  return all;
}

/// Of the ranks that have blocks.
double least(const std::vector<double>& all, const coupling::Ranks& ranks, int n_blocks) {
  double result = std::numeric_limits<double>::infinity();
  for (int k = 0; k < n_blocks; ++k) result = std::min(result, all[static_cast<size_t>(ranks.owner(k, n_blocks))]);
  return result;
}

double sum(const std::vector<double>& all) { return std::accumulate(all.begin(), all.end(), 0.); }

/// The elements of this rank: whole blocks.
std::vector<int> own_elements(const surface::Geometry& geometry, const coupling::Ranks& ranks) {
  return surface::elements_of(ranks.share(geometry.n_blocks()), geometry.bezier().n_elements());
}

/// Ranks share blocks of elements, and sites.
Whole whole(const Scene& scene, const Body& body, const surface::Geometry& geometry, const membrane::Membrane& membrane, const Net& x,
            const Net& slope, const coupling::Ranks& ranks) {
  const std::vector<int> blocks = ranks.share(geometry.n_blocks());
  const std::vector<int> elements = own_elements(geometry, ranks);
  const std::vector<int>& sites = body.symmetry.fundamental();  // the others are images of these
  std::vector<int> own;
  for (const int k : ranks.share(static_cast<int>(sites.size()))) own.push_back(sites[static_cast<size_t>(k)]);
  const membrane::ElementTensions tensions = membrane.element_tensions(x, elements);
  std::vector<double> moments = geometry.block_moments(x, blocks);
  std::vector<double> energy = surface::block_sums(membrane.element_energies(x, elements));
  std::vector<double> area = surface::block_sums(tensions.area), compressed = surface::block_sums(tensions.compressed);
  std::vector<double> smallest = slots(ranks, elements.empty() ? 0 : tensions.smallest);
  std::vector<double> fastest = slots(ranks, normal_velocity(scene, body, geometry, x, slope, own));
  std::vector<double> shape = surface::shape_velocity_sums(geometry.bezier(), x, slope, body.radius, elements);
  ranks.add_all({moments, energy, area, compressed, smallest, fastest, shape});
  return {surface::Geometry::measures(x, moments),
          {least(smallest, ranks, geometry.n_blocks()), sum(compressed) / sum(area)},
          sum(energy),
          std::ranges::max(fastest),
          surface::shape_velocity(shape, scene.tube.present) / unit_speed(scene, body)};
}

}  // namespace

surface::Deformation deformation(const surface::Geometry& geometry, const FlowPlane& of_flow, const Net& x, surface::Measures measures,
                                 const coupling::Ranks& ranks) {
  const FlowPlane plane = of_flow.holds_flow ? of_flow : plane_normal_to(surface::principal_axes(measures).directions.col(1));
  const std::vector<int> own = own_elements(geometry, ranks);
  std::array<surface::Range, surface::Geometry::n_extremes> extremes = geometry.extremes(x, measures.centroid, own);
  if (!plane.fixed()) {
    extremes[0] = surface::section_distances(surface::Patches(geometry.bezier(), plane.turned(x), own), plane.components(measures.centroid));
    measures.second_moments = plane.axes * measures.second_moments * plane.axes.transpose();
  }
  const size_t n = 2 * extremes.size();
  std::vector<double> ends(n * static_cast<size_t>(ranks.size()), 0.);  // of all ranks, one after another
  for (size_t k = 0; k < extremes.size(); ++k) {
    double* const mine = &ends[n * static_cast<size_t>(ranks.rank()) + 2 * k];
    mine[0] = extremes[k].smallest, mine[1] = extremes[k].largest;
  }
  ranks.add(ends);
  for (size_t k = 0; k < ends.size(); k += 2) {
    surface::Range& range = extremes[k % n / 2];
    range = wider(range, {ends[k], ends[k + 1]});
  }
  return surface::Geometry::deformation(measures, extremes);
}

Moment moment(const Scene& scene, const Body& body, const surface::Geometry& geometry, const membrane::Membrane& membrane, const Net& x,
              const Net& slope, const coupling::Ranks& ranks) {
  const auto [measures, tension, energy, normal_velocity, shape_velocity] = whole(scene, body, geometry, membrane, x, slope, ranks);
  Moment now;
  now.n_points = body.space.n_points;
  now.measures = measures;
  now.shape = deformation(geometry, body.plane, x, measures, ranks);
  now.axes = surface::principal_axes(measures);
  now.refit_error = body.refit_error;
  now.energy = energy;
  now.tension = tension;
  now.normal_velocity = normal_velocity;
  now.shape_velocity = shape_velocity;
  now.centre = measures.centroid;
  return now;
}

void add_treading(const Scene& scene, const Body& body, const surface::Geometry& geometry, const Net& x, const Net& v, Moment& now) {
  const FlowPlane& plane = body.plane;
  now.velocity = surface::centroid_velocity(geometry.bezier(), x, v);
  const bool elastic = scene.membrane.law != "surface tension";
  now.treading = surface::tank_treading(geometry.bezier(), plane.turned(x), plane.turned(v), elastic ? &body.unstressed : nullptr,
                                        plane.components(now.centre), plane.components(now.velocity));
}

double normal_velocity(const Scene& scene, const Body& body, const surface::Geometry& geometry, const Net& x, const Net& slope,
                       std::span<const int> sites) {
  double largest = 0;
  Vec3 frame = Vec3::Zero();
  if (!body.flow.affine() || scene.tube.present) frame[0] = surface::centroid_velocity(geometry.bezier(), x, slope)[0];
  const surface::BezierMap& map = geometry.bezier();
  constexpr int most = 3 * (spline::max_degree + 1) * (spline::max_degree + 1);
  double points[most], velocities[most];
  for (const int i : sites) {
    const auto& [element, s, t] = body.space.collocation[static_cast<size_t>(i)].front();
    map.points(element, x, points);
    map.points(element, slope, velocities);
    const surface::Jet at = surface::jet({map.degree(element), points}, s, t);
    const Vec3 v = surface::place({map.degree(element), velocities}, s, t) - frame;
    largest = std::max(largest, std::abs(v.dot(at.s.cross(at.t).normalized())));
  }
  return largest / unit_speed(scene, body);
}

}  // namespace tanktread
