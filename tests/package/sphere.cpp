// The volume of a unit sphere of 218 control points, over that of the exact one.

#include <cstdio>
#include <numbers>

#include "spline/extraction.hpp"
#include "surface/fit.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"

int main() {
  using namespace tanktread;
  const spline::TMesh mesh = spline::cube(6);
  const spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  const surface::LeastSquaresFit fit(space);
  const Net sphere = surface::unit_sphere(mesh, fit);
  std::printf("%.6f\n", surface::volume(space, sphere) / (4 * std::numbers::pi / 3));
}
