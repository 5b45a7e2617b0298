#include "surface/resolution.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "spline/locate.hpp"
#include "surface/geometry.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {
namespace {

using spline::Lattice;
using spline::Ray;

struct Sample {
  Vec3 rest, now, load;
};

/// Where the sides of elements of a polar mesh have no length.
bool on_pole(const Lattice& lattice, int vertex) {
  if (lattice.pad == 0) return false;
  const int height = lattice.height(vertex / lattice.units);
  return height == 0 || height == lattice.height(lattice.rows);
}

/// Whether there is no way on: at the border of an open face, or at a pole.
bool ends(const Lattice& lattice, Ray ray) { return lattice.ends(ray.vertex, ray.slot) || lattice.length(ray.vertex, ray.slot, 1) == 0; }

/// Both surfaces and the load at lattice vertices, each evaluated once.
class Samples {
 public:
  Samples(const spline::TMesh& mesh, const spline::Space& space, const Net& rest, const Net& net, const FieldAt& load)
      : lattice_(*mesh.lattice), locate_(space), map_(space), rest_(map_, rest), now_(map_, net), load_(load) {}

  const Sample& at(int vertex) {
    const auto [found, fresh] = known_.try_emplace(vertex);
    if (fresh) {
      spline::Site site = locate_(spline::place(lattice_, vertex));
      const auto on = [&](const Patches& patches) { return place(patches[site.element], site.s, site.t); };
      found->second = {on(rest_), on(now_), Vec3::Zero()};
      if (on_pole(lattice_, vertex)) site.t = std::clamp(site.t, 1e-5, 1 - 1e-5);  // a load per area has only a limit there
      if (load_) found->second.load = load_(site);
    }
    return found->second;
  }

  /// F at a place.
  Mat3 gradient(const spline::Place& p) const {
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
  std::unordered_map<int, Sample> known_;
};

/// Vertices `stride` units apart along a ray, at most `most` of them, up to an extraordinary point or a pole.
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

/// Vertices one edge apart: up to three before its start, the two ends, up to three beyond its end; `start`: position of the start among them.
struct Line {
  std::vector<int> vertices;
  int start = 0;
};

Line line(const Lattice& lattice, Ray edge, int length) {
  Line result;
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

Sample fourth_difference(Samples& samples, const Line& line, int first) {
  static constexpr double weight[5] = {1, -4, 6, -4, 1};
  Sample sum{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int k = 0; k < 5; ++k) {
    const Sample& s = samples.at(line.vertices[static_cast<std::size_t>(first + k)]);
    sum.rest += weight[k] * s.rest;
    sum.now += weight[k] * s.now;
    sum.load += weight[k] * s.load;
  }
  return sum;
}

Resolution along_edge(const Lattice& lattice, Samples& samples, Ray edge, int length, const Mat3& f) {
  const Line found = line(lattice, edge, length);
  Resolution result;
  if (static_cast<int>(found.vertices.size()) > found.start + 1)
    result.length = (samples.at(found.vertices[static_cast<std::size_t>(found.start) + 1]).now - samples.at(edge.vertex).now).norm();
  const int last = static_cast<int>(found.vertices.size()) - 5;
  // The two windows with the edge in the middle, or else the nearest that there is.
  std::vector<int> windows;
  for (const int first : {found.start - 2, found.start - 1})
    if (first >= 0 && first <= last) windows.push_back(first);
  if (windows.empty())
    for (const int first : {found.start - 3, found.start})
      if (first >= 0 && first <= last) windows.push_back(first);
  for (const int first : windows) {
    const Sample d4 = fourth_difference(samples, found, first);
    result.errors.surface += (d4.now - f * d4.rest).norm() / 384 / static_cast<double>(windows.size());
    result.errors.load += d4.load.norm() / 384 / static_cast<double>(windows.size());
  }
  return result;
}

Resolution mean(const Resolution& a, const Resolution& b) {
  return {(a.length + b.length) / 2, {(a.errors.surface + b.errors.surface) / 2, (a.errors.load + b.errors.load) / 2}, {}};
}

/// What a tile becomes when its width (or height) doubles on the grid of the first mesh; itself if that is no tile around it.
spline::Rectangle doubled(const Lattice& lattice, const spline::Rectangle& r, bool in_height) {
  spline::Rectangle out = r;
  int &at = in_height ? out.y : out.x, &size = in_height ? out.height : out.width;
  const int first = in_height ? lattice.pad : 0, end = at + size;
  size = 2 * static_cast<int>(std::bit_floor(static_cast<unsigned>(size)));
  at = first + (at - first) / size * size;
  return size <= lattice.base && end <= at + size ? out : r;
}

/// Along s and t of a tile.
std::array<Resolution, 2> on_tile(const Lattice& l, Samples& samples, const spline::Rectangle& r) {
  const int right = r.x + r.width - 1, top = r.y + r.height - 1;
  const Mat3 f = samples.gradient({r.face, (r.x + 0.5 * r.width) / l.units, (l.height(r.y) + 0.5 * r.height) / l.height(l.rows)});
  // Edge k runs from corner k to corner k + 1.
  const int cells[4] = {l.cell_at(r.face, r.x, r.y), l.cell_at(r.face, right, r.y), l.cell_at(r.face, right, top),
                        l.cell_at(r.face, r.x, top)};
  const auto edge = [&](int k) {
    return along_edge(l, samples, {l.corners[cells[k]][k], l.slot[cells[k]][k]}, k % 2 == 0 ? r.width : r.height, f);
  };
  const auto along_s = [&] {
    if (on_pole(l, l.corners[cells[0]][0])) return edge(2);
    return on_pole(l, l.corners[cells[3]][3]) ? edge(0) : mean(edge(0), edge(2));
  };
  return {along_s(), mean(edge(1), edge(3))};
}

}  // namespace

std::vector<std::array<Resolution, 2>> resolution(const spline::TMesh& mesh, const spline::Space& space, const Net& rest, const Net& net,
                                                  const FieldAt& load) {
  const Lattice& l = *mesh.lattice;
  Samples samples(mesh, space, rest, net, load);
  std::vector<std::array<Resolution, 2>> result;
  for (const spline::Rectangle& r : spline::elements(mesh).tiles) {
    auto own = on_tile(l, samples, r);
    for (const bool along_t : {false, true}) {
      const spline::Rectangle whole = doubled(l, r, along_t);
      const auto& [surface, traction] = own[along_t].errors;
      const bool larger = whole.width != r.width || whole.height != r.height;
      own[along_t].merged = larger ? on_tile(l, samples, whole)[along_t].errors : Errors{16 * surface, 16 * traction};
    }
    result.push_back(own);
  }
  return result;
}

}  // namespace tanktread::surface
