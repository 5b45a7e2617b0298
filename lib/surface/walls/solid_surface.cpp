#include "surface/walls/solid_surface.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "base/formatted.hpp"
#include "surface/walls/outline.hpp"
#include "surface/spline_lines.hpp"

namespace tanktread::surface {

namespace {

/// Splines on equal elements over a period of unit length, and the control values of the coordinate along the period.
struct Unit {
  RepeatingLine line;
  std::vector<double> coordinate;
};

/// Returns splines of period 1 with `elements` equal periodic elements, on one period around 0. The seam, where this period begins and ends, divides
/// a periodic element at a quarter of its length.
Unit unit_period(int elements) {
  std::vector<double> knots;
  for (int k = 0; k < elements; ++k) knots.push_back((k + 0.5) / elements - 0.5);
  const double start = -0.5 - 0.25 / elements;
  Unit unit{repeating(knots, {start, start + 1}), {}};
  const auto knot = [&](int i) { return i < 0 ? start : i >= elements ? start + 1 : knots[static_cast<std::size_t>(i)]; };
  for (int i = 0; i < unit.line.open.n; ++i) unit.coordinate.push_back((knot(i - 3) + knot(i - 2) + knot(i - 1)) / 3);
  return unit;
}

}  // namespace

SolidSurface plate(const Vec3& middle, const Vec3& first, const Vec3& second, const std::array<int, 2>& elements) {
  const Unit s = unit_period(elements[0]), t = unit_period(elements[1]);
  SolidSurface plate{product(s.line.open, t.line.open), {}, sites_of(s.line.open, t.line.open),
                     kronecker(s.line.open_from_periodic, t.line.open_from_periodic), elements};
  plate.space.description = formatted("plate of %d x %d cubic elements", elements[0], elements[1]);
  plate.net.resize(plate.space.n_points, 3);
  Eigen::Index row = 0;
  for (const double u : s.coordinate)
    for (const double v : t.coordinate) plate.net.row(row++) = (middle + u * first + v * second).transpose();
  return plate;
}

SolidSurface cylinder(const Vec3& middle, const Vec3& period, double radius, int around, int along) {
  const Outline circle = Outline({Ellipse{Vec2::Zero(), Vec2::Constant(radius)}}).spline(around);
  const CubicCurve& curve = std::get<CubicCurve>(circle.side(0));
  const double wider = radius / circle.radius();  // scales the spline cross-section to the exact area of the circle
  const Vec3 axis = period.normalized(), a = axis.unitOrthogonal(), b = axis.cross(a);
  Line ring;
  add(ring, curve.breaks, true, false);
  const Unit t = unit_period(along);
  SolidSurface cylinder{product(ring, t.line.open), {}, sites_of(ring, t.line.open),
                        kronecker(Eigen::MatrixXd::Identity(ring.n, ring.n), t.line.open_from_periodic), {0, 0}};
  cylinder.space.description = formatted("cylinder of %d x %d cubic elements", around, along);
  cylinder.net.resize(cylinder.space.n_points, 3);
  Eigen::Index row = 0;
  for (const Vec2& point : control_points(curve))
    for (const double u : t.coordinate) cylinder.net.row(row++) = (middle + wider * (point[0] * a + point[1] * b) + u * period).transpose();
  return cylinder;
}

SolidSurface stacked(const std::vector<SolidSurface>& surfaces) {
  std::vector<const spline::Space*> spaces;
  for (const SolidSurface& one : surfaces) spaces.push_back(&one.space);
  SolidSurface all{spline::stacked(spaces), {}, {}, {}, {0, 0}};
  all.net.resize(all.space.n_points, 3);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::Index row = 0, column = 0;
  int element = 0;
  for (const SolidSurface& one : surfaces) {
    all.net.middleRows(row, one.net.rows()) = one.net;
    for (std::vector<spline::Site> of_point : one.sites) {
      for (spline::Site& site : of_point) site.element += element;
      all.sites.push_back(std::move(of_point));
    }
    for (int j = 0; j < one.open_from_periodic.outerSize(); ++j)
      for (Eigen::SparseMatrix<double>::InnerIterator it(one.open_from_periodic, j); it; ++it)
        entries.emplace_back(row + it.row(), column + it.col(), it.value());
    row += one.net.rows(), column += one.n_points(), element += static_cast<int>(one.space.elements.size());
  }
  all.open_from_periodic.resize(row, column);
  all.open_from_periodic.setFromTriplets(entries.begin(), entries.end());
  return all;
}

}  // namespace tanktread::surface
