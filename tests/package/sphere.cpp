// A program that prints the volume of a unit sphere with 218 control points, divided by 4 pi/3.

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
