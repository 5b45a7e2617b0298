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
#include "surface/geometry.hpp"
#include "surface/patch.hpp"
#include "surface/transport.hpp"

namespace tanktread {

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
  std::vector<double> change = slots(ranks, tensions.area_change);
  std::vector<double> fastest = slots(ranks, normal_velocity(scene, body, geometry, x, slope, own));
  std::vector<double> shape = surface::shape_velocity_sums(geometry.bezier(), x, slope, body.radius, elements);
  ranks.add_all({moments, energy, area, compressed, smallest, change, fastest, shape});
  return {surface::Geometry::measures(x, moments),
          {least(smallest, ranks, geometry.n_blocks()), sum(compressed) / sum(area), std::ranges::max(change)},
          sum(energy),
          std::ranges::max(fastest),
          surface::shape_velocity(shape, scene.tube.present) / unit_speed(scene, body)};
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

double intrinsic_viscosity(const Body& body, double viscosity, const Moment& now) {
  if (!body.flow.affine()) return 0;
  const Mat3 gradient = body.flow.gradient(now.centre), strain = (gradient + gradient.transpose()) / 2;
  return now.stresslet.cwiseProduct(strain).sum() / (2 * viscosity * now.measures.volume * strain.squaredNorm());
}

Moment rigid_moment(const Scene& scene, const Body& body, const surface::Geometry& geometry, const Net& x, const coupling::RigidMotion& motion,
                    const Eigen::Quaterniond& turn, const Mat3& stresslet, const coupling::Ranks& ranks) {
  Moment now;
  now.n_points = body.space.n_points;
  now.measures = geometry.measures(x);
  now.shape = deformation(geometry, body.plane, x, now.measures, ranks);
  now.axes = surface::principal_axes(now.measures);
  now.stresslet = stresslet;
  now.centre = now.measures.centroid;
  now.velocity = motion.velocity, now.angular_velocity = motion.angular_velocity;
  now.quaternion << turn.w(), turn.vec();
  now.intrinsic_viscosity = intrinsic_viscosity(body, scene.flow.viscosity, now);
  return now;
}

surface::Deformation deformation(const surface::Geometry& geometry, const FlowPlane& of_flow, const Net& x, surface::Measures measures,
                                 const coupling::Ranks& ranks) {
  FlowPlane plane = of_flow;
  bool plane_defined = true;
  if (!plane.holds_flow) {
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
  for (const auto& of_rank : gathered(ranks, ends))
    for (size_t k = 0; k < extremes.size(); ++k) extremes[k] = wider(extremes[k], {of_rank[2 * k], of_rank[2 * k + 1]});
  surface::Deformation result = surface::Geometry::deformation(measures, extremes);
  if (!plane_defined) result.inclination = std::numeric_limits<double>::quiet_NaN();
  return result;
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
