#include "surface/metrics.hpp"

#include <algorithm>
#include <cmath>

#include "quadrature/gauss.hpp"
#include "spline/locate.hpp"
#include "surface/geometry.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {
namespace {

/// Part of a mid-line inside one Bezier element.
struct Piece {
  spline::Site first, last;
};

/// A mid-line in the plane of its macro face, cut where Bezier elements end. `direction` 0: along x.
std::vector<Piece> pieces(const spline::Space& space, const spline::Locator& locate, spline::Place start, int direction, double length) {
  std::vector<Piece> result;
  const double end = (direction == 0 ? start.x : start.y) + length;
  double at = end - length;
  while (at < end - 1e-9 * length) {
    spline::Place inside = start;
    (direction == 0 ? inside.x : inside.y) = at + 1e-7 * length;  // beyond the element that ends here
    spline::Site site = locate(inside);
    const spline::Element& element = space.elements[site.element];
    const double from = element.origin[direction], size = element.size[direction], to = std::min(from + size, end);
    double spline::Site::*coordinate = direction == 0 ? &spline::Site::s : &spline::Site::t;
    Piece piece{site, site};
    piece.first.*coordinate = std::max(0., (at - from) / size);
    piece.last.*coordinate = std::min(1., (to - from) / size);
    result.push_back(piece);
    at = to;
  }
  return result;
}

double arc_length(const Patches& patches, const Piece& piece) {
  const quadrature::GaussRule& rule = quadrature::gauss(6);
  const double ds = piece.last.s - piece.first.s, dt = piece.last.t - piece.first.t;
  double sum = 0;
  for (int q = 0; q < rule.size(); ++q) {
    const Jet at = jet(patches[piece.first.element], piece.first.s + rule.nodes[q] * ds, piece.first.t + rule.nodes[q] * dt);
    sum += rule.weights[q] * (ds * at.s + dt * at.t).norm();
  }
  return sum;
}

double curvature(const Patches& patches, const spline::Site& site) { return mean_curvature(jet(patches[site.element], site.s, site.t)); }

MidLine mid_line(const std::vector<Piece>& parts, const Patches& patches, const MetricFields& fields, bool meets_pole) {
  const spline::Site &start = parts.front().first, &end = parts.back().last;
  MidLine result;
  for (const Piece& part : parts) result.length += arc_length(patches, part);
  if (meets_pole) return result;
  if (fields.traction) result.traction = (fields.traction(end) - fields.traction(start)).norm() / result.length;
  if (fields.velocity) result.velocity = (fields.velocity(end) - fields.velocity(start)).norm() / result.length;
  result.curvature = std::abs(curvature(patches, end) - curvature(patches, start)) / result.length;
  return result;
}

}  // namespace

std::vector<ElementMetrics> element_metrics(const spline::TMesh& mesh, const spline::Space& space, const Net& net,
                                            const MetricFields& fields) {
  const BezierMap map(space);
  const Patches patches(map, net);
  const spline::Locator locate(space);
  const spline::Lattice& l = *mesh.lattice;
  const double unit = 1. / l.units, vertical_unit = 1. / l.height(l.rows);
  std::vector<ElementMetrics> result;
  for (const spline::Rectangle& r : spline::elements(mesh).tiles) {
    const double x = r.x * unit, y = l.height(r.y) * vertical_unit, width = r.width * unit, height = r.height * vertical_unit;
    const auto along_s = pieces(space, locate, {r.face, x, y + height / 2}, 0, width);
    const auto along_t = pieces(space, locate, {r.face, x + width / 2, y}, 1, height);
    result.push_back({{mid_line(along_s, patches, fields, false), mid_line(along_t, patches, fields, spline::is_degenerate(l, r))}});
  }
  return result;
}

FieldAt per_current_area(const spline::Space& space, const Net& rest, const Net& net, const Net& load) {
  return [&](const spline::Site& site) -> Vec3 {
    return point(space, rest, site).jacobian / point(space, net, site).jacobian * value(space, load, site);
  };
}

FieldAt field_of_net(const spline::Space& space, const Net& net) {
  return [&](const spline::Site& site) { return value(space, net, site); };
}

}  // namespace tanktread::surface
