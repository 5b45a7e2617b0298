#include "surface/transport.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "surface/patch.hpp"

namespace tanktread::surface {

namespace {

constexpr int intervals = 6;  // of an element, a direction

/// Volume and first moment about the origin.
Eigen::Vector4d moments(const Geometry& geometry, const Net& x) {
  const Measures m = geometry.measures(x);
  Eigen::Vector4d result;
  result << m.volume, m.volume * m.centroid;
  return result;
}

/// A corner of the grid: place, velocity, height over the plane.
struct Corner {
  Vec3 x, v;
  double height;
};

/// Circulation and length of the curve so far.
struct Circuit {
  double circulation = 0, length = 0;

  /// The piece of the curve in a flat triangle, whose corners run counter-clockwise seen from outside.
  void cut(const Corner& a, const Corner& b, const Corner& c) {
    const std::array<const Corner*, 3> corners = {&a, &b, &c};
    std::array<Vec3, 2> x, v;
    int n = 0;
    for (size_t k = 0; k < 3; ++k) {
      const Corner &from = *corners[k], &to = *corners[(k + 1) % 3];
      if ((from.height > 0) == (to.height > 0)) continue;
      const double share = from.height / (from.height - to.height);
      x[static_cast<size_t>(n)] = from.x + share * (to.x - from.x);
      v[static_cast<size_t>(n++)] = from.v + share * (to.v - from.v);
    }
    if (n != 2) return;
    const Vec3 normal = (b.x - a.x).cross(c.x - a.x), along = x[1] - x[0];
    const double sense = along.dot(Vec3::UnitY().cross(normal)) > 0 ? 1 : -1;
    circulation += sense * along.dot(v[0] + v[1]) / 2;
    length += along.norm();
  }
};

/// Whether the plane x2 = height can meet the element: it lies in the hull of its control points, if none of its functions is negative; a
/// quarter of the hull's size stands for those that are.
bool may_meet(const spline::Element& element, const Net& x, double height) {
  double low = 1e300, high = -1e300;
  for (const int a : element.points) {
    low = std::min(low, x(a, 1));
    high = std::max(high, x(a, 1));
  }
  const double slack = (high - low) / 4;
  return low - slack <= height && height <= high + slack;
}

}  // namespace

/// Volume and first moment are polynomials of degree three and four in the net, for which this difference is the derivative.
Vec3 centroid_velocity(const Geometry& geometry, const Net& x, const Net& v) {
  const Eigen::RowVector3d mean = x.colwise().mean();
  const Net y = x.rowwise() - mean;
  const double speed = v.norm();
  if (!(speed > 0)) return Vec3::Zero();
  const double e = 0.1 * y.norm() / speed;
  const auto at = [&](double s) { return moments(geometry, y + s * e * v); };
  const Eigen::Vector4d rate = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * e), now = at(0);
  return (rate.tail<3>() - rate[0] / now[0] * now.tail<3>()) / now[0];
}

double tank_treading_velocity(const spline::Space& space, const Net& x, const Net& v, const Vec3& centre, const Vec3& of_centre) {
  Circuit circuit;
  std::array<std::array<Corner, intervals + 1>, intervals + 1> grid;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    if (!may_meet(space.elements[static_cast<size_t>(e)], x, centre[1])) continue;
    const ElementPoints places(space, x, e), velocities(space, v, e);
    for (size_t j = 0; j <= intervals; ++j)
      for (size_t i = 0; i <= intervals; ++i) {
        const double s = static_cast<double>(i) / intervals, t = static_cast<double>(j) / intervals;
        const Vec3 at = place(places.patch(), s, t);
        grid[j][i] = {at, place(velocities.patch(), s, t) - of_centre, at[1] - centre[1]};
      }
    for (size_t j = 0; j < intervals; ++j)
      for (size_t i = 0; i < intervals; ++i) {
        circuit.cut(grid[j][i], grid[j][i + 1], grid[j + 1][i + 1]);
        circuit.cut(grid[j][i], grid[j + 1][i + 1], grid[j + 1][i]);
      }
  }
  return circuit.length > 0 ? circuit.circulation / circuit.length : 0;
}

}  // namespace tanktread::surface
