#include "surface/transport.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "spline/bernstein.hpp"
#include "surface/integrals_kernel.hpp"
#include "surface/patch.hpp"
#include "surface/sampling.hpp"

namespace tanktread::surface {

namespace {

/// A corner of the grid: place, velocity, unstressed place (if there is one), height over the plane.
struct Corner {
  Vec3 x, v, unstressed;
  double height;
};

/// The curve so far: circulation and length; the weight of its points (6.6), and their mean angular velocity times it.
struct Circuit {
  Vec3 centre, of_centre;
  bool elastic;
  double circulation = 0, length = 0, weight = 0, turned = 0;
  bool onwards = false, backwards = false;  // whether a piece moves along the curve, or against it

  /// The piece of the curve in a flat triangle, whose corners run counter-clockwise seen from outside.
  void cut(const Corner& a, const Corner& b, const Corner& c) {
    const bool above[3] = {a.height >= 0, b.height >= 0, c.height >= 0};
    if (above[0] == above[1] && above[1] == above[2]) return;
    const std::array<const Corner*, 3> corners = {&a, &b, &c};
    std::array<Vec3, 2> x, v, unstressed;
    size_t n = 0;
    for (size_t k = 0; k < 3; ++k) {
      const Corner &from = *corners[k], &to = *corners[(k + 1) % 3];
      if ((from.height >= 0) == (to.height >= 0)) continue;
      const double share = from.height / (from.height - to.height);
      x[n] = from.x + share * (to.x - from.x);
      v[n] = from.v + share * (to.v - from.v) - of_centre;
      unstressed[n++] = from.unstressed + share * (to.unstressed - from.unstressed);
    }
    const Vec3 normal = (b.x - a.x).cross(c.x - a.x), along = x[1] - x[0];
    if (along.norm() < 1e-9 * (b.x - a.x).norm()) return;  // at a corner: rounding has its direction
    const double sense = along.dot(Vec3::UnitY().cross(normal)) > 0 ? 1 : -1;
    const double treads = sense * along.dot(v[0] + v[1]) / 2;
    circulation += treads;
    length += along.norm();
    (treads > 0 ? onwards : backwards) = true;
    const double passed = elastic ? (unstressed[1] - unstressed[0]).norm() : along.squaredNorm() / std::abs(treads);
    const Vec3 y = (x[0] + x[1]) / 2 - centre, moves = (v[0] + v[1]) / 2;
    weight += passed;
    turned += passed * (y[2] * moves[0] - y[0] * moves[2]) / (y[0] * y[0] + y[2] * y[2]);
  }

  Treading treading() const {
    if (!(length > 0)) return {};
    const bool turns = weight > 0 && std::isfinite(weight) && (elastic || onwards != backwards);
    return {circulation / length, turns ? turned / weight : 0};
  }
};

/// The Bezier points of one element of a net.
class Element {
 public:
  Element(const BezierMap& map, const Net& net, int element) : degree_(map.degree(element)) { map.points(element, net, points_); }
  Patch patch() const { return {degree_, points_}; }

 private:
  int degree_;
  double points_[3 * (spline::max_degree + 1) * (spline::max_degree + 1)];
};

/// The Bezier points of a register of elements of one degree; a short group repeats its last.
kernel::Lanes in_lanes(const BezierMap& map, const Net& net, std::span<const int> group) {
  kernel::Lanes packed;
  const std::size_t lanes = pack_lanes();
  for (size_t l = 0; l < lanes; ++l) {
    const Element element(map, net, group[std::min(l, group.size() - 1)]);
    for (int k = 0; k < 3 * element.patch().n_bezier(); ++k)
      packed.value[static_cast<size_t>(k) * lanes + l] = element.patch().points[k];
  }
  return packed;
}

/// Whether the element, which lies in the hull of its Bezier points, can come as near to the plane x2 = height.
bool may_meet(const Patch& patch, double height, double near) {
  const auto [low, high] = std::minmax_element(patch.points + patch.n_bezier(), patch.points + 2 * patch.n_bezier());
  return *low <= height + near && height - near <= *high;
}

}  // namespace

Vec3 centroid_velocity(const BezierMap& map, const Net& x, const Net& v) {
  const Eigen::RowVector3d mean = x.colwise().mean();
  const Net y = x.rowwise() - mean;  // about its own mean, as integrals by the divergence theorem lose digits where the origin is far away
  double volume = 0, flux = 0;
  Vec3 first = Vec3::Zero(), carried = Vec3::Zero();
  const std::size_t lanes = pack_lanes();
  for (const Block& block : map.blocks().blocks)
    for (size_t begin = 0; begin < block.elements.size(); begin += lanes) {
      const std::span group = std::span(block.elements).subspan(begin, std::min(lanes, block.elements.size() - begin));
      kernel::Transport part;
      kernel::transport(block.degree, in_lanes(map, y, group), in_lanes(map, v, group), part);
      for (size_t l = 0; l < group.size(); ++l) {
        volume += part.volume[l], flux += part.flux[l];
        for (int c = 0; c < 3; ++c) first[c] += part.first[c][l], carried[c] += part.carried[c][l];
      }
    }
  return (carried - flux / volume * first) / volume;
}

Treading tank_treading(const BezierMap& map, const Net& x, const Net& v, const Net* unstressed, const Vec3& centre, const Vec3& of_centre) {
  Circuit circuit{centre, of_centre, unstressed != nullptr};
  const double in_plane = 1e-9 * (x.rowwise() - centre.transpose()).cwiseAbs().maxCoeff();  // where rounding shall not decide on a side
  for (int e = 0; e < map.n_elements(); ++e) {
    const Element places(map, x, e);
    if (!may_meet(places.patch(), centre[1], in_plane)) continue;
    const Grid at = sample(places.patch()), moves = sample(Element(map, v, e).patch());
    const Grid before = unstressed ? sample(Element(map, *unstressed, e).patch()) : at;
    const auto corner = [&](size_t j, size_t i) {
      const double height = at[j][i][1] - centre[1];
      return Corner{at[j][i], moves[j][i], before[j][i], std::abs(height) < in_plane ? 0 : height};
    };
    for (size_t j = 0; j < cells; ++j)
      for (size_t i = 0; i < cells; ++i) {
        circuit.cut(corner(j, i), corner(j, i + 1), corner(j + 1, i + 1));
        circuit.cut(corner(j, i), corner(j + 1, i + 1), corner(j + 1, i));
      }
  }
  return circuit.treading();
}

}  // namespace tanktread::surface
