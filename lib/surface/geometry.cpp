#include "surface/geometry.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "base/indices.hpp"
#include "surface/element_groups.hpp"

namespace tanktread::surface {
namespace {

/// Adds to `b` the derivative of an integral with respect to the control points. gradient(degree, x, g) computes the derivatives g of a group of
/// elements with respect to their Bezier points x.
template <class Gradient>
void add_gradient(const BezierMap& map, const Net& net, std::span<const int> elements, const Gradient& gradient, Net& b) {
  using Rows = std::array<std::vector<double>, most_lanes>;  // of each element of a group
  each_group<Rows>(
      map, elements,
      [&](int degree, std::span<const int> group, Rows& rows) {
        kernel::Lanes dual;
        gradient(degree, points_of(map, net, group), dual);
        const std::size_t lanes = pack_lanes();
        double one[3 * kernel::most_bezier];
        for (std::size_t l = 0; l < group.size(); ++l) {
          for (int k = 0; k < 3 * map.n_bezier(group[0]); ++k) one[k] = dual.value[k * lanes + l];
          map.transposed(group[l], one, rows[l]);
        }
      },
      [&](std::span<const int> group, const Rows& rows) {
        for (std::size_t l = 0; l < group.size(); ++l) map.add_rows(group[l], rows[l], b);
      });
}

/// Returns the control points relative to their mean, because integrals by the divergence theorem lose digits if the origin is far from the
/// surface.
Net about_mean(const Net& net, Vec3& mean) {
  mean = net.colwise().mean().transpose();
  return net.rowwise() - mean.transpose();
}

}  // namespace

Point point(const spline::Space& space, const Net& net, const spline::Site& site) {
  const ElementPoints element(space, net, site.element);
  const Jet at = jet(element.patch(), site.s, site.t);
  Point result{at.x, at.s, at.t, at.s.cross(at.t), 0};
  result.jacobian = result.n.norm();
  result.n /= result.jacobian;
  return result;
}

Vec3 value(const spline::Space& space, const Net& net, const spline::Site& site) {
  return position(ElementPoints(space, net, site.element).patch(), site.s, site.t);
}

Geometry::Geometry(const spline::Space& space) : map_(space), all_(indices(space.elements.size())), all_blocks_(indices(n_blocks())) {}

double Geometry::volume(const Net& net) const {
  Vec3 mean;
  const Net here = about_mean(net, mean);
  return here.cwiseProduct(volume_gradient(here)).sum() / 3;
}

void Geometry::volume_gradient(const Net& net, std::span<const int> elements, Net& b) const {
  b.setZero(map_.n_points(), 3);
  add_gradient(map_, net, elements, [](int degree, const kernel::Lanes& x, kernel::Lanes& g) { kernel::volume_gradient(degree, x, g); }, b);
}

void Geometry::add_moment_gradient(const Net& net, const Vec3& g, const Vec3& origin, std::span<const int> elements, Net& b) const {
  const Net here = net.rowwise() - origin.transpose();
  add_gradient(
      map_, here, elements, [&](int degree, const kernel::Lanes& x, kernel::Lanes& dual) { kernel::moment_gradient(degree, x, g.data(), dual); }, b);
}

Net Geometry::volume_gradient(const Net& net) const {
  Net b;
  volume_gradient(net, all_, b);
  return b;
}

Measures Geometry::measures(const Net& net) const { return measures(net, block_moments(net, all_blocks_)); }

std::vector<double> Geometry::block_moments(const Net& net, std::span<const int> blocks) const {
  Vec3 mean;
  const Net here = about_mean(net, mean);
  std::vector<double> moments(static_cast<std::size_t>(n_moments) * n_blocks(), 0.);
  each_item(blocks.size(), [&](std::size_t k) {
    double* const sum = &moments[static_cast<std::size_t>(n_moments) * blocks[k]];
    each_group<kernel::Moments>(
        map_, elements_of(blocks.subspan(k, 1), map_.n_elements()),
        [&](int degree, std::span<const int> group, kernel::Moments& part) { kernel::moments(degree, points_of(map_, here, group), part); },
        [&](std::span<const int> group, const kernel::Moments& part) {
          for (std::size_t l = 0; l < group.size(); ++l) {
            sum[0] += part.area[l];
            sum[1] += part.volume[l];
            for (int c = 0; c < 3; ++c) sum[2 + c] += part.first[c][l];
            for (int i = 0; i < 6; ++i) sum[5 + i] += part.second[i][l];
          }
        });
  });
  return moments;
}

Measures Geometry::measures(const Net& net, std::span<const double> of_blocks) {
  double all[n_moments] = {};
  for (std::size_t k = 0; k < of_blocks.size(); ++k) all[k % n_moments] += of_blocks[k];
  Measures result;
  result.area = all[0], result.volume = all[1];
  const double* const second = &all[5];
  const Vec3 centre = Vec3(all[2], all[3], all[4]) / result.volume;
  result.centroid = net.colwise().mean().transpose() + centre;
  result.second_moments << second[0], second[3], second[4], second[3], second[1], second[5], second[4], second[5], second[2];
  result.second_moments -= result.volume * centre * centre.transpose();
  return result;
}

std::array<Range, Geometry::n_extremes> Geometry::extremes(const Net& net, const Vec3& centroid, std::span<const int> elements) const {
  const Patches patches(map_, net, elements);
  return {section_distances(patches, centroid), coordinate_range(patches, 0), coordinate_range(patches, 1), coordinate_range(patches, 2)};
}

Deformation Geometry::deformation(const Measures& measures, const std::array<Range, n_extremes>& extremes) {
  if (!(extremes[0].smallest <= extremes[0].largest))
    throw RunFailure(
        "the plane x2 = const. through the centroid does not intersect the surface, which is no longer closed or contains NaN");
  Deformation result;
  const Mat3& m = measures.second_moments;
  const double mean = (m(0, 0) + m(2, 2)) / 2, difference = (m(0, 0) - m(2, 2)) / 2, radius = std::hypot(difference, m(0, 2));
  const double longest = std::sqrt(mean + radius), shortest = std::sqrt(mean - radius);
  result.taylor_inertia = (longest - shortest) / (longest + shortest);
  result.inclination = std::atan2(m(0, 2), difference) / 2 * 180 / std::numbers::pi;
  if (result.inclination < -90 + 1e-6) result.inclination += 180;  // if the axis is along x3, round-off would choose between -90 and 90 degrees
  const double to_semi_axis = std::sqrt(5 / measures.volume);
  if (!distinct(to_semi_axis * longest, to_semi_axis * shortest, measures.volume)) result.inclination = std::numeric_limits<double>::quiet_NaN();

  result.taylor_surface = (extremes[0].largest - extremes[0].smallest) / (extremes[0].largest + extremes[0].smallest);
  for (int c = 0; c < 3; ++c) result.lengths[c] = extremes[1 + c].largest - extremes[1 + c].smallest;
  return result;
}

bool distinct(double longer, double shorter, double volume) {
  return longer - shorter >= 1e-6 * std::cbrt(3 * volume / (4 * std::numbers::pi));
}

PrincipalAxes principal_axes(const Measures& measures) {
  const Eigen::SelfAdjointEigenSolver<Mat3> moments(measures.second_moments);  // ascending
  PrincipalAxes axes;
  for (int k = 0; k < 3; ++k) {
    axes.lengths[k] = std::sqrt(5 * moments.eigenvalues()[2 - k] / measures.volume);
    Vec3 direction = moments.eigenvectors().col(2 - k);
    for (double& component : direction)
      if (std::abs(component) < 1e-9) component = 0;  // treated as zero, so that round-off does not choose the sign of the axis
    for (int c = 2; c >= 0; --c)
      if (direction[c] != 0) axes.directions.col(k) = std::copysign(1.0, direction[c]) * direction;
  }
  axes.longest_defined = distinct(axes.lengths[0], axes.lengths[1], measures.volume);
  axes.shortest_defined = distinct(axes.lengths[1], axes.lengths[2], measures.volume);
  return axes;
}

Measures measures(const spline::Space& space, const Net& net) { return Geometry(space).measures(net); }
double volume(const spline::Space& space, const Net& net) { return Geometry(space).volume(net); }

Vec3 centroid_velocity(const BezierMap& map, const Net& x, const Net& v) {
  Vec3 mean, first = Vec3::Zero(), flux_moment = Vec3::Zero();
  const Net here = about_mean(x, mean);
  double volume = 0, flux = 0;
  for (const DegreeGroup& of_degree : map.groups())
    each_group<kernel::Transport>(
        map, of_degree.elements,
        [&](int degree, std::span<const int> group, kernel::Transport& part) {
          kernel::transport(degree, points_of(map, here, group), points_of(map, v, group), part);
        },
        [&](std::span<const int> group, const kernel::Transport& part) {
          for (std::size_t l = 0; l < group.size(); ++l) {
            volume += part.volume[l], flux += part.flux[l];
            for (int c = 0; c < 3; ++c) first[c] += part.first[c][l], flux_moment[c] += part.flux_moment[c][l];
          }
        });
  return (flux_moment - flux / volume * first) / volume;
}

}  // namespace tanktread::surface
