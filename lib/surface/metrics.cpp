#include "surface/metrics.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>
#include <unordered_map>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "quadrature/gauss.hpp"
#include "spline/locate.hpp"
#include "surface/geometry.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

namespace {

/// Part of an element's mid-line that lies inside one Bezier element.
struct LinePiece {
  spline::Site first, last;
};

/// Divides the mid-line of a mesh element at the borders of Bezier elements, and returns its parts. The line begins at `start` and is straight in the
/// plane of its macro face (face of the cube). `direction`: 0 if the line is parallel to x of this face, 1 if parallel to y.
std::vector<LinePiece> pieces(const spline::Space& space, const spline::Locator& locate, spline::ParametricPoint start, int direction,
                              double length) {
  std::vector<LinePiece> result;
  const double end = (direction == 0 ? start.x : start.y) + length;
  double at = end - length;
  while (at < end - 1e-9 * length) {
    spline::ParametricPoint inside = start;
    (direction == 0 ? inside.x : inside.y) = at + 1e-7 * length;  // moves the point just past the border between two Bezier elements
    spline::Site site = locate(inside);
    const spline::Element& element = space.elements[site.element];
    const double from = element.origin[direction], size = element.size[direction], to = std::min(from + size, end);
    double spline::Site::*coordinate = direction == 0 ? &spline::Site::s : &spline::Site::t;
    LinePiece piece{site, site};
    piece.first.*coordinate = std::max(0., (at - from) / size);
    piece.last.*coordinate = std::min(1., (to - from) / size);
    result.push_back(piece);
    at = to;
  }
  return result;
}

double arc_length(const Patches& patches, const LinePiece& piece) {
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

MidLine mid_line(const std::vector<LinePiece>& parts, const Patches& patches, const MetricFields& fields, bool meets_pole) {
  const spline::Site &start = parts.front().first, &end = parts.back().last;
  MidLine result;
  for (const LinePiece& part : parts) result.length += arc_length(patches, part);
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

namespace {

using spline::Lattice;
using spline::Ray;

struct Sample {
  Vec3 rest, now, load;
  Eigen::VectorXd fields;
};

/// Returns whether a vertex is at a pole, where the sides of elements along the azimuth have zero length.
bool on_pole(const Lattice& lattice, int vertex) {
  if (lattice.pad == 0) return false;
  const int height = lattice.height(vertex / lattice.units);
  return height == 0 || height == lattice.height(lattice.rows);
}

/// Returns whether a mesh line cannot be continued along a ray. This is so at a pole, where edges have zero length, and at the border of the lattice,
/// which exists only on meshes with poles (polar_lattice).
bool ends(const Lattice& lattice, Ray ray) { return lattice.ends(ray.vertex, ray.slot) || lattice.length(ray.vertex, ray.slot, 1) == 0; }

/// Evaluates the unstressed and the current surface, the load and the fields at lattice vertices, each vertex only once.
class Samples {
 public:
  Samples(const spline::TMesh& mesh, const spline::Space& space, const Net& rest, const Net& net, const FieldAt& load, const FieldsAt& fields)
      : lattice_(*mesh.lattice), locate_(space), map_(space), rest_(map_, rest), now_(map_, net), load_(load), fields_(fields) {}

  const Sample& at(int vertex) {
    const auto [found, fresh] = known_.try_emplace(vertex);
    if (fresh) {
      spline::Site site = locate_(spline::place(lattice_, vertex));
      const auto on = [&](const Patches& patches) { return position(patches[site.element], site.s, site.t); };
      found->second = {on(rest_), on(now_), Vec3::Zero(), {}};
      // At a pole, moves the site off the pole, because a load per area is defined there only as a limit.
      if (on_pole(lattice_, vertex)) site.t = std::clamp(site.t, 1e-5, 1 - 1e-5);
      if (load_) found->second.load = load_(site);
      if (fields_) found->second.fields = fields_(site);
    }
    return found->second;
  }

  /// Returns the matrix F of (1.5) at a parametric point, which maps the tangents and the normal of the unstressed surface to the current surface.
  Mat3 gradient(const spline::ParametricPoint& p) const {
    const spline::Site site = locate_(p);
    return frame(now_, site) * frame(rest_, site).inverse();
  }

 private:
  static Mat3 frame(const Patches& patches, const spline::Site& site) {
    const Jet at = jet(patches[site.element], site.s, site.t);
    Mat3 columns;
    const Vec3 normal = at.s.cross(at.t);
    columns << at.s, at.t, normal / std::sqrt(normal.norm());
    return columns;
  }

  const Lattice& lattice_;
  spline::Locator locate_;
  BezierMap map_;
  Patches rest_, now_;
  const FieldAt& load_;
  const FieldsAt& fields_;
  std::unordered_map<int, Sample> known_;
};

/// Returns the vertices along a ray, `stride` lattice units apart: `most` of them, or fewer if the ray arrives at an extraordinary point or a pole.
std::vector<int> vertices_along(const Lattice& lattice, Ray ray, int stride, int most) {
  std::vector<int> found;
  while (static_cast<int>(found.size()) < most) {
    for (int k = 0; k < stride; ++k) {
      if (k > 0 && lattice.is_extraordinary[ray.vertex]) return found;
      if (ends(lattice, ray)) return found;
      ray = spline::step(lattice, ray);
    }
    found.push_back(ray.vertex);
    if (lattice.is_extraordinary[ray.vertex]) return found;
  }
  return found;
}

/// Vertices on the mesh line of an edge, one edge length apart: up to three before the edge, its two ends, up to three after it. `start`: index of
/// the first end of the edge.
struct EdgeLine {
  std::vector<int> vertices;
  int start = 0;
};

EdgeLine line(const Lattice& lattice, Ray edge, int length) {
  EdgeLine result;
  if (!lattice.is_extraordinary[edge.vertex]) {
    const std::vector<int> before = vertices_along(lattice, {edge.vertex, (edge.slot + 2) & 3}, length, 3);
    result.vertices.assign(before.rbegin(), before.rend());
  }
  result.start = static_cast<int>(result.vertices.size());
  result.vertices.push_back(edge.vertex);
  const std::vector<int> beyond = vertices_along(lattice, edge, length, 4);
  result.vertices.insert(result.vertices.end(), beyond.begin(), beyond.end());
  return result;
}

Sample fourth_difference(Samples& samples, const EdgeLine& line, int first) {
  static constexpr double weight[5] = {1, -4, 6, -4, 1};
  Sample sum{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Eigen::VectorXd::Zero(samples.at(line.vertices[first]).fields.size())};
  for (int k = 0; k < 5; ++k) {
    const Sample& s = samples.at(line.vertices[first + k]);
    sum.rest += weight[k] * s.rest;
    sum.now += weight[k] * s.now;
    sum.load += weight[k] * s.load;
    sum.fields += weight[k] * s.fields;
  }
  return sum;
}

/// Returns the gradient of the fields along the surface on a mesh element, shape (m, 3) for m components, from differences between the corners.
Eigen::MatrixX3d slopes(Samples& samples, const std::array<Ray, 4>& side) {
  const auto differences = [&](auto Sample::*what) {
    const auto at = [&](int k) -> const auto& { return samples.at(side[k].vertex).*what; };
    Eigen::MatrixX2d along(at(0).size(), 2);
    along << at(1) + at(2) - at(0) - at(3), at(2) + at(3) - at(0) - at(1);
    return along;
  };
  const Eigen::MatrixX2d x = differences(&Sample::now);
  return differences(&Sample::fields) * (x.transpose() * x).inverse() * x.transpose();
}

/// Deformation gradient F of the surface, and gradient G of the fields along the surface, at the centre of a mesh element, for the errors (1.5).
struct Gradients {
  Mat3 f;
  Eigen::MatrixX3d fields;
};

/// Returns the norm of the corrected fourth difference of a criterion, which is 384 times its estimated error (1.5).
double norm(Criterion criterion, const Sample& d4, const Gradients& g) {
  switch (criterion) {
    case Criterion::surface: return (d4.now - g.f * d4.rest).norm();
    case Criterion::load: return d4.load.norm();
    case Criterion::fields: return (d4.fields - g.fields * d4.now).norm();
  }
  throw std::logic_error("no criterion of refinement has the number " + std::to_string(static_cast<int>(criterion)));
}

Resolution along_edge(const Lattice& lattice, Samples& samples, Ray edge, int length, const Gradients& g) {
  const EdgeLine found = line(lattice, edge, length);
  Resolution result;
  if (static_cast<int>(found.vertices.size()) > found.start + 1)
    result.length = (samples.at(found.vertices[found.start + 1]).now - samples.at(edge.vertex).now).norm();
  const int last = static_cast<int>(found.vertices.size()) - 5;
  // A fourth difference needs five successive vertices (a window). Uses the two windows in which the edge touches the middle vertex. If the line is
  // too short for both, uses the windows in which the edge is the first or the last edge.
  std::vector<int> windows;
  for (const int first : {found.start - 2, found.start - 1})
    if (first >= 0 && first <= last) windows.push_back(first);
  if (windows.empty())
    for (const int first : {found.start - 3, found.start})
      if (first >= 0 && first <= last) windows.push_back(first);
  for (const int first : windows) {
    const Sample d4 = fourth_difference(samples, found, first);
    Errors norms;
    for (std::size_t k = 0; k < n_criteria; ++k) norms.of[k] = norm(static_cast<Criterion>(k), d4, g);
    result.errors = result.errors + norms * (1 / 384. / static_cast<double>(windows.size()));
  }
  return result;
}

Resolution mean(const Resolution& a, const Resolution& b) {
  return {(a.length + b.length) / 2, (a.errors + b.errors) * 0.5, {}};
}

/// Returns the rectangle that contains the mesh element r, has twice its width (twice its height if `in_height`) and results from repeated bisection
/// of the initial mesh. Returns r if there is no such rectangle.
spline::Rectangle doubled(const Lattice& lattice, const spline::Rectangle& r, bool in_height) {
  spline::Rectangle out = r;
  int &at = in_height ? out.y : out.x, &size = in_height ? out.height : out.width;
  const int first = in_height ? lattice.pad : 0, end = at + size;
  size = 2 * static_cast<int>(std::bit_floor(static_cast<unsigned>(size)));
  at = first + (at - first) / size * size;
  return size <= lattice.base && end <= at + size ? out : r;
}

/// Returns the estimated errors of a mesh element along s and along t.
std::array<Resolution, 2> on_tile(const Lattice& l, Samples& samples, const spline::Rectangle& r) {
  const std::array<Ray, 4> side = spline::sides(l, r);
  const Gradients g{samples.gradient({r.face, (r.x + 0.5 * r.width) / l.units, (l.height(r.y) + 0.5 * r.height) / l.height(l.rows)}),
                    slopes(samples, side)};
  const auto edge = [&](int k) { return along_edge(l, samples, side[k], k % 2 == 0 ? r.width : r.height, g); };
  const auto along_s = [&] {
    if (on_pole(l, side[0].vertex)) return edge(2);
    return on_pole(l, side[3].vertex) ? edge(0) : mean(edge(0), edge(2));
  };
  return {along_s(), mean(edge(1), edge(3))};
}

}  // namespace

std::vector<std::array<Resolution, 2>> resolution(const spline::TMesh& mesh, const spline::Space& space, const Net& rest, const Net& net,
                                                  const FieldAt& load, const FieldsAt& fields) {
  const Lattice& l = *mesh.lattice;
  Samples samples(mesh, space, rest, net, load, fields);
  std::vector<std::array<Resolution, 2>> result;
  for (const spline::Rectangle& r : spline::elements(mesh).tiles) {
    auto own = on_tile(l, samples, r);
    for (const bool along_t : {false, true}) {
      const spline::Rectangle whole = doubled(l, r, along_t);
      const bool larger = whole.width != r.width || whole.height != r.height;
      own[along_t].merged = larger ? on_tile(l, samples, whole)[along_t].errors : own[along_t].errors * 16;
    }
    result.push_back(own);
  }
  return result;
}

}  // namespace tanktread::surface
