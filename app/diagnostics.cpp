#include "app/diagnostics.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "spline/bernstein.hpp"
#include "surface/geometry.hpp"
#include "surface/patch.hpp"
#include "surface/transport.hpp"

namespace tanktread {

const std::vector<Column>& columns() {
  static const std::vector<Column> all = {
      {"time", "time", "simulated time"},
      {"time_step", "time", "size of the step that ended here"},
      {"taylor_inertia", "1", "Taylor parameter of the ellipsoid with the same second moments, in the x1 x3 plane"},
      {"taylor_surface", "1", "Taylor parameter of the longest and shortest distance from the centroid, in the x1 x3 plane"},
      {"inclination", "degree", "angle of the long axis of inertia with x1"},
      {"volume", "length^3", "enclosed volume"},
      {"volume_error", "1", "V/V0 - 1"},
      {"area", "length^2", "area of the surface"},
      {"energy", "force length", "energy stored in the membrane"},
      {"smallest_tension", "1", "smallest principal tension over G_s"},
      {"compressed_area", "1", "share of the area with a negative principal tension"},
      {"stresslet_11", "force length", "particle stresslet, component 11"},
      {"stresslet_22", "force length", "particle stresslet, component 22"},
      {"stresslet_33", "force length", "particle stresslet, component 33"},
      {"stresslet_12", "force length", "particle stresslet, component 12"},
      {"stresslet_13", "force length", "particle stresslet, component 13"},
      {"stresslet_23", "force length", "particle stresslet, component 23"},
      {"length_x1", "length", "extent along x1"},
      {"length_x2", "length", "extent along x2"},
      {"length_x3", "length", "extent along x3"},
      {"normal_velocity", "1",
       "largest |v.n| over rate x R_C (in a tube over the mean velocity, in the particle's frame): zero when the shape is steady"},
      {"n_control_points", "1", "control points of the surface"},
      {"step_error", "1", "estimated error of the step, in the norm of Time/tolerance"},
      {"rejected_steps", "1", "attempts given up in this step"},
      {"iterations", "1", "nonlinear iterations or sub-iterations in this step"},
      {"evaluations", "1", "velocity evaluations so far"},
      {"assemblies", "1", "assemblies of the frozen layer operator so far"},
      {"solver_iterations", "1", "iterations of the linear solver so far"},
      {"velocity_iterations", "1", "iterations of the systems that velocities come from so far (viscosity ratio other than 1)"},
      {"wall_seconds", "s", "time since the run was started, earlier parts of a resumed run included"},
  };
  return all;
}

std::vector<Column> named(const std::vector<Column>& all, std::initializer_list<std::string_view> names) {
  std::vector<Column> found;
  for (const std::string_view name : names) found.push_back(*std::ranges::find(all, name, &Column::name));
  return found;
}

std::vector<double> row(const Scene& scene, const Body& body, coupling::Capsule& capsule, const motion::State& state,
                        const motion::StepReport& report, double wall_seconds) {
  const surface::Measures measures = capsule.geometry().measures(state.x);
  const surface::Deformation shape = capsule.geometry().deformation(state.x, measures);
  const membrane::TensionSummary tension = capsule.membrane().tension_summary(state.x);
  const Mat3 stresslet = capsule.stresslet(state.x, state.history.front());
  const coupling::Work& work = capsule.work();
  return {state.time,
          report.step,
          shape.taylor_inertia,
          shape.taylor_surface,
          shape.inclination,
          measures.volume,
          capsule.volume_error(state.x),
          measures.area,
          capsule.membrane().energy(state.x),
          tension.smallest,
          tension.compressed_area,
          stresslet(0, 0),
          stresslet(1, 1),
          stresslet(2, 2),
          stresslet(0, 1),
          stresslet(0, 2),
          stresslet(1, 2),
          shape.lengths[0],
          shape.lengths[1],
          shape.lengths[2],
          normal_velocity(scene, body, capsule.geometry(), state),
          static_cast<double>(body.space.n_points),
          report.error,
          static_cast<double>(report.rejected),
          static_cast<double>(report.iterations),
          static_cast<double>(work.evaluations),
          static_cast<double>(work.assemblies),
          static_cast<double>(work.solver_iterations),
          static_cast<double>(work.velocity_iterations),
          wall_seconds};
}

double normal_velocity(const Scene& scene, const Body& body, const surface::Geometry& geometry, const motion::State& state) {
  if (state.history.empty()) return 0;
  double largest = 0;
  Vec3 frame = Vec3::Zero();
  if (scene.tube.present) frame[0] = surface::centroid_velocity(geometry, state.x, state.history.front())[0];
  const surface::BezierMap& map = geometry.bezier();
  constexpr int most = 3 * (spline::max_degree + 1) * (spline::max_degree + 1);
  double points[most], velocities[most];
  for (const int i : body.symmetry.fundamental()) {  // the other sites are images of these
    const auto& [element, s, t] = body.space.collocation[static_cast<size_t>(i)].front();
    map.points(element, state.x, points);
    map.points(element, state.history.front(), velocities);
    const surface::Jet at = surface::jet({map.degree(element), points}, s, t);
    const Vec3 v = surface::place({map.degree(element), velocities}, s, t) - frame;
    largest = std::max(largest, std::abs(v.dot(at.s.cross(at.t).normalized())));
  }
  const double speed = scene.speed();
  return largest / (speed > 0 ? speed : body.radius);
}

}  // namespace tanktread
