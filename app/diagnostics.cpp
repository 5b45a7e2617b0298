#include "app/diagnostics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <Eigen/Geometry>

#include "spline/bernstein.hpp"
#include "surface/geometry.hpp"
#include "surface/patch.hpp"
#include "surface/shape_velocity.hpp"
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
      {"shape_velocity", "1", "what smooth changes of shape have of it, root mean square (6.6): `Time/steady tolerance` is held against this"},
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
Whole whole(const Scene& scene, const Body& body, const coupling::Capsule& capsule, const motion::State& state, const coupling::Ranks& ranks) {
  const surface::Geometry& geometry = capsule.geometry();
  const membrane::Membrane& membrane = capsule.membrane();
  const std::vector<int> blocks = ranks.share(geometry.n_blocks());
  const std::vector<int> elements = own_elements(geometry, ranks);
  const std::vector<int>& sites = body.symmetry.fundamental();  // the others are images of these
  std::vector<int> own;
  for (const int k : ranks.share(static_cast<int>(sites.size()))) own.push_back(sites[static_cast<size_t>(k)]);
  const membrane::ElementTensions tensions = membrane.element_tensions(state.x, elements);
  std::vector<double> moments = geometry.block_moments(state.x, blocks);
  std::vector<double> energy = surface::block_sums(membrane.element_energies(state.x, elements));
  std::vector<double> area = surface::block_sums(tensions.area), compressed = surface::block_sums(tensions.compressed);
  std::vector<double> smallest = slots(ranks, elements.empty() ? 0 : tensions.smallest);
  std::vector<double> fastest = slots(ranks, normal_velocity(scene, body, geometry, state, own));
  std::vector<double> shape = surface::shape_velocity_sums(geometry.bezier(), state.x, state.history.front(), body.radius, elements);
  ranks.add_all({moments, energy, area, compressed, smallest, fastest, shape});
  return {surface::Geometry::measures(state.x, moments),
          {least(smallest, ranks, geometry.n_blocks()) / membrane::modulus(membrane.law()), sum(compressed) / sum(area)},
          sum(energy),
          std::ranges::max(fastest),
          surface::shape_velocity(shape, scene.tube.present) / unit_speed(scene, body)};
}

/// Ranks share the elements.
surface::Deformation deformation(const surface::Geometry& geometry, const Net& x, const surface::Measures& measures, const coupling::Ranks& ranks) {
  std::array<surface::Range, surface::Geometry::n_extremes> extremes = geometry.extremes(x, measures.centroid, own_elements(geometry, ranks));
  const size_t n = 2 * extremes.size();
  std::vector<double> ends(n * static_cast<size_t>(ranks.size()), 0.);  // of all ranks, one after another
  for (size_t k = 0; k < extremes.size(); ++k) {
    double* const own = &ends[n * static_cast<size_t>(ranks.rank()) + 2 * k];
    own[0] = extremes[k].smallest, own[1] = extremes[k].largest;
  }
  ranks.add(ends);
  for (size_t k = 0; k < ends.size(); k += 2) {
    surface::Range& range = extremes[k % n / 2];
    range = wider(range, {ends[k], ends[k + 1]});
  }
  return surface::Geometry::deformation(measures, extremes);
}

}  // namespace

std::vector<double> row(const Scene& scene, const Body& body, coupling::Capsule& capsule, const motion::State& state,
                        const motion::StepReport& report, double wall_seconds, const coupling::Ranks& ranks) {
  const auto [measures, tension, energy, normal_velocity, shape_velocity] = whole(scene, body, capsule, state, ranks);
  const surface::Deformation shape = deformation(capsule.geometry(), state.x, measures, ranks);
  const Mat3 stresslet = capsule.stresslet(state.x, state.history.front());
  const coupling::Work& work = capsule.work();
  return {state.time,
          report.step,
          shape.taylor_inertia,
          shape.taylor_surface,
          shape.inclination,
          measures.volume,
          capsule.volume_error(measures.volume),
          measures.area,
          energy,
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
          normal_velocity,
          shape_velocity,
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

double normal_velocity(const Scene& scene, const Body& body, const surface::Geometry& geometry, const motion::State& state,
                       std::span<const int> sites) {
  if (state.history.empty()) return 0;
  double largest = 0;
  Vec3 frame = Vec3::Zero();
  if (scene.tube.present) frame[0] = surface::centroid_velocity(geometry, state.x, state.history.front())[0];
  const surface::BezierMap& map = geometry.bezier();
  constexpr int most = 3 * (spline::max_degree + 1) * (spline::max_degree + 1);
  double points[most], velocities[most];
  for (const int i : sites) {
    const auto& [element, s, t] = body.space.collocation[static_cast<size_t>(i)].front();
    map.points(element, state.x, points);
    map.points(element, state.history.front(), velocities);
    const surface::Jet at = surface::jet({map.degree(element), points}, s, t);
    const Vec3 v = surface::place({map.degree(element), velocities}, s, t) - frame;
    largest = std::max(largest, std::abs(v.dot(at.s.cross(at.t).normalized())));
  }
  return largest / unit_speed(scene, body);
}

}  // namespace tanktread
