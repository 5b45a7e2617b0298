#include "spline/closed_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "spline/basis.hpp"

namespace tanktread::spline {

namespace {

struct Frame {
  Vec3 x, s, t;
};
Frame frame(const Space& space, const Net& net, const Site& site) {
  const Element& e = space.elements[site.element];
  const Basis b = basis(e, site.s, site.t, 1);
  Frame f{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (std::size_t i = 0; i < e.points.size(); ++i) {
    const Vec3 p = net.row(e.points[i]);
    f.x += b.value[Eigen::Index(i)] * p;
    f.s += b.s[Eigen::Index(i)] * p;
    f.t += b.t[Eigen::Index(i)] * p;
  }
  return f;
}

/// Edge 0 (t = 0), 1 (s = 1), 2 (t = 1), 3 (s = 0), run through with the element on the left.
Site on_edge(int element, int edge, double x) {
  const double at[4][2] = {{x, 0}, {1, x}, {1 - x, 1}, {0, 1 - x}};
  return {element, at[edge][0], at[edge][1]};
}

double extent(const Net& net) { return (net.colwise().maxCoeff() - net.colwise().minCoeff()).norm(); }

/// Places in space, equal within a tolerance.
using Key = std::array<long long, 3>;
Key key(const Vec3& x, double tolerance) {
  Key k;
  for (int d = 0; d < 3; ++d) k[d] = std::llround(x[d] / tolerance);
  return k;
}

/// Numbers points so that those within the tolerance of each other share a number.
class Places {
 public:
  explicit Places(double tolerance) : tolerance_(tolerance) {}
  int operator()(const Vec3& x) {
    const Key k = key(x, 2 * tolerance_);
    for (int a = -1; a <= 1; ++a)
      for (int b = -1; b <= 1; ++b)
        for (int c = -1; c <= 1; ++c)
          if (const auto found = cells_.find({k[0] + a, k[1] + b, k[2] + c}); found != cells_.end())
            for (int i : found->second)
              if ((points_[i] - x).norm() < tolerance_) return i;
    cells_[k].push_back(int(points_.size()));
    points_.push_back(x);
    return int(points_.size()) - 1;
  }
  int size() const { return int(points_.size()); }

 private:
  double tolerance_;
  std::vector<Vec3> points_;
  std::map<Key, std::vector<int>> cells_;
};

// Gauss points and weights of order five on [0, 1].
constexpr double gauss_x[5] = {0.046910077030668004, 0.230765344947158454, 0.5, 0.769234655052841546, 0.953089922969331996};
constexpr double gauss_w[5] = {0.118463442528094544, 0.239314335249683234, 0.284444444444444444, 0.239314335249683234,
                               0.118463442528094544};

}  // namespace

std::string fault_of_closed_surface(const Space& space, const Net& net) {
  const double size = extent(net), tolerance = 1e-7 * size;
  Places places(tolerance);
  // Each side by its ends and its middle; the partner runs the other way.
  std::map<std::array<int, 3>, std::pair<int, int>> open;
  int once = -1, twice = -1;
  for (int k = 0; k < int(space.elements.size()); ++k)
    for (int e = 0; e < 4; ++e) {
      const int a = places(frame(space, net, on_edge(k, e, 0)).x), m = places(frame(space, net, on_edge(k, e, 0.5)).x),
                b = places(frame(space, net, on_edge(k, e, 1)).x);
      if (a == m && m == b) continue;  // collapsed: a pole
      if (open.erase({b, m, a})) continue;
      const auto [side, is_new] = open.try_emplace({a, m, b}, k, e);
      if (!is_new && twice < 0) once = side->second.first, twice = k;
    }
  if (twice >= 0)
    return "element " + std::to_string(twice) + " runs along one of its sides the same way as element " + std::to_string(once) +
           ", so one of them is inverted.";

  // Sides without partner: integrals of cos(k_i . x) dx and sin(k_i . x) dx over all of them.
  Eigen::Matrix<double, 3, 6> sum = Eigen::Matrix<double, 3, 6>::Zero();
  double length = 0;
  const Vec3 wave[3] = {Vec3(1.3, 0.7, -0.4) / size, Vec3(-0.5, 1.9, 1.1) / size, Vec3(2.1, -1.7, 2.3) / size};
  for (const auto& [ends, side] : open)
    for (int g = 0; g < 5; ++g) {
      const Frame f = frame(space, net, on_edge(side.first, side.second, gauss_x[g]));
      const Vec3 dx = gauss_w[g] * (side.second == 0 ? f.s : side.second == 1 ? f.t : side.second == 2 ? Vec3(-f.s) : Vec3(-f.t));
      length += dx.norm();
      for (int i = 0; i < 3; ++i) {
        sum.col(2 * i) += std::cos(wave[i].dot(f.x)) * dx;
        sum.col(2 * i + 1) += std::sin(wave[i].dot(f.x)) * dx;
      }
    }
  if (!open.empty() && sum.cwiseAbs().maxCoeff() > 1e-5 * length)
    return "the surface is not closed: element " + std::to_string(open.begin()->second.first) + " is among those beside a hole.";

  double volume = 0;
  for (int k = 0; k < int(space.elements.size()); ++k)
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 5; ++i) {
        const Frame f = frame(space, net, {k, gauss_x[i], gauss_x[j]});
        volume += gauss_w[i] * gauss_w[j] * f.x.dot(f.s.cross(f.t)) / 3;
      }
  if (!(volume > 0)) return "the surface is inside out: all its elements must be seen counter-clockwise from outside.";
  return {};
}

std::vector<std::vector<Site>> largest_value_sites(const Space& space, const Net& net) {
  Places places(1e-7 * extent(net));
  std::vector<std::vector<Site>> at_place;
  struct Candidate {
    double value;
    int point, place;
  };
  std::vector<Candidate> candidates;
  for (int k = 0; k < int(space.elements.size()); ++k)
    for (double t : {0.0, 0.5, 1.0})
      for (double s : {0.0, 0.5, 1.0}) {
        const Site site{k, s, t};
        const int place = places(frame(space, net, site).x);
        at_place.resize(places.size());
        auto& sites = at_place[place];
        if (std::any_of(sites.begin(), sites.end(), [&](const Site& other) { return other.element == k; })) continue;
        sites.push_back(site);
        if (sites.size() > 1) continue;
        const Element& e = space.elements[k];
        const Basis b = basis(e, s, t, 0);
        for (std::size_t i = 0; i < e.points.size(); ++i)
          if (b.value[Eigen::Index(i)] > 0.02) candidates.push_back({b.value[Eigen::Index(i)], e.points[i], place});
      }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return std::llround(a.value * 1e10) > std::llround(b.value * 1e10); });
  std::vector<int> place_of(space.n_points, -1);
  std::vector<char> taken(at_place.size(), 0);
  for (const Candidate& c : candidates) {
    if (place_of[c.point] >= 0 || taken[c.place]) continue;
    place_of[c.point] = c.place;
    taken[c.place] = 1;
  }
  std::vector<std::vector<Site>> out(space.n_points);
  for (int i = 0; i < space.n_points; ++i) {
    if (place_of[i] < 0)
      throw UserError("Control point " + std::to_string(i) + " of the surface has no place where its function is large.");
    out[i] = at_place[place_of[i]];
  }
  return out;
}

}  // namespace tanktread::spline
