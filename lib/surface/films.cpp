#include "surface/films.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace tanktread::surface {

namespace {

/// n x n places of an element with normals, and a box around its Bezier points.
struct Sampled {
  std::vector<Vec3> place, normal;
  Eigen::AlignedBox3d box;

  Sampled(const Patch& patch, int n) {
    for (int k = 0; k < n * n; ++k) {
      const Jet at = jet(patch, k % n / (n - 1.), k / n / (n - 1.));
      place.push_back(at.x);
      normal.push_back(at.s.cross(at.t).normalized());
    }
    const int n_bezier = (patch.degree + 1) * (patch.degree + 1);
    for (int b = 0; b < n_bezier; ++b) box.extend(Vec3(patch.points[b], patch.points[n_bezier + b], patch.points[2 * n_bezier + b]));
  }
};

std::vector<Sampled> sampled(const Patches& surface, int n) {
  std::vector<Sampled> all;
  for (int e = 0; e < surface.size(); ++e) all.emplace_back(surface[e], n);
  return all;
}

double distance(const Vec3& x, const Sampled& element) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < element.place.size(); ++k)
    if (const double squared = (element.place[k] - x).squaredNorm(); squared < least) least = squared, nearest = k;
  // Beyond the element's edge the plane of another one is nearer.
  const double across = (x - element.place[nearest]).dot(element.normal[nearest]), along = std::sqrt(std::max(0., least - across * across));
  return along > element.box.diagonal().norm() / 4 ? std::sqrt(least) : std::max(across, 0.);
}

}  // namespace

std::vector<double> film_widths(const Patches& surface, std::span<const Patches* const> others, double reach) {
  const std::vector<Sampled> own = sampled(surface, 3);
  Eigen::AlignedBox3d around;
  for (const Sampled& element : own) around.extend(element.box);
  std::vector<double> widths(own.size(), std::numeric_limits<double>::infinity());
  for (const Patches* other : others)
    for (const Sampled& across : sampled(*other, 5)) {
      if (around.exteriorDistance(across.box) > reach) continue;
      for (std::size_t e = 0; e < own.size(); ++e) {
        if (own[e].box.exteriorDistance(across.box) > std::min(reach, widths[e])) continue;
        for (const Vec3& x : own[e].place)
          if (const double width = distance(x, across); width <= reach) widths[e] = std::min(widths[e], width);
      }
    }
  return widths;
}

}  // namespace tanktread::surface
