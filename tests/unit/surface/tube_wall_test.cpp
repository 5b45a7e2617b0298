// Tests of the wall as a spline surface: a regular space, a normal into the fluid, and a shape that is accurate to the order of the splines.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/errors.hpp"
#include "spline/basis.hpp"
#include "surface/geometry.hpp"
#include "surface/walls/tube_wall.hpp"

namespace tanktread::surface {
namespace {

using std::numbers::pi;

TubeOptions circle(int around, int along) {
  TubeOptions o;
  o.radius = 1;
  o.azimuthal_elements = around, o.axial_elements = along;
  return o;
}

TubeOptions square() {
  TubeOptions o = circle(12, 8);
  o.section = "rectangle", o.radius.reset();
  o.sides = Eigen::Vector2d(2, 2);
  return o;
}

TubeWall of(const TubeOptions& o) { return tube_wall(outline(o), o, 2 * pi); }

Vec3 place(const TubeWall& wall, const spline::Site& site) { return value(wall.space, wall.net, site); }

TEST(TubeWall, IsCountedAsRings) {
  const TubeWall round = of(circle(12, 8)), corners = of(square());
  EXPECT_EQ(round.n_around, 12);
  EXPECT_EQ(round.n_along, 11);
  EXPECT_EQ(round.space.n_points, 132);
  EXPECT_EQ(corners.n_around, 12 + 4 * 3);  // open knots on each side
  EXPECT_EQ(round.net.rows(), 132);
}

TEST(TubeWall, HasANormalIntoTheFluid) {
  for (const TubeWall& wall : {of(circle(12, 8)), of(square())})
    for (int e = 0; e < static_cast<int>(wall.space.elements.size()); ++e) {
      const Point p = point(wall.space, wall.net, {e, 0.3, 0.6});
      EXPECT_NEAR(p.n[0], 0, 1e-12);
      EXPECT_LT(p.n.dot(Vec3(0, p.x[1], p.x[2])), -0.5);
    }
}

TEST(TubeWall, HasAllSitesOfACollocationPointAtOnePosition) {
  for (const TubeWall& wall : {of(circle(12, 8)), of(square())})
    for (const auto& sites : wall.space.collocation)
      for (const spline::Site& site : sites) EXPECT_LT((place(wall, site) - place(wall, sites.front())).norm(), 1e-12);
}

TEST(TubeWall, HasCollocationPointsOnItsRimsWithoutDuplicates) {
  for (const TubeWall& wall : {of(circle(12, 8)), of(square())}) {
    double closest = 1;
    for (int i = 0; i < wall.space.n_points; ++i) {
      const Vec3 x = place(wall, wall.space.collocation[static_cast<std::size_t>(i)].front());
      EXPECT_EQ(i < wall.n_around, std::abs(x[0] - wall.start) < 1e-12);
      EXPECT_EQ(i >= wall.space.n_points - wall.n_around, std::abs(x[0] - wall.end) < 1e-12);
      for (int k = 0; k < i; ++k)
        closest = std::min(closest, (x - place(wall, wall.space.collocation[static_cast<std::size_t>(k)].front())).norm());
    }
    EXPECT_GT(closest, 0.04);
  }
}

TEST(TubeWall, ReproducesConstantsAndTheAxialCoordinate) {
  const TubeWall wall = of(circle(12, 8));
  for (const spline::Element& element : wall.space.elements) EXPECT_NEAR(spline::basis(element, 0.2, 0.7, 0).value.sum(), 1, 1e-14);
  const Net along = wall.net.col(0).replicate<1, 3>();
  for (int e = 0; e < static_cast<int>(wall.space.elements.size()); e += 7)
    EXPECT_NEAR(value(wall.space, along, {e, 0.2, 0.7})[1], place(wall, {e, 0.2, 0.7})[0], 1e-13);
}

TEST(TubeWall, IsRoundToFourthOrder) {
  const auto error = [](int m) {
    const TubeWall wall = of(circle(m, 4));
    double largest = 0;
    for (int e = 0; e < static_cast<int>(wall.space.elements.size()); ++e) {
      const Vec3 x = place(wall, {e, 0.5, 0.5});
      largest = std::max(largest, std::abs(std::hypot(x[1], x[2]) - 1));
    }
    return largest;
  };
  EXPECT_GT(std::log2(error(12) / error(24)), 3.8);
  EXPECT_LT(error(24), 2e-5);
}

TEST(TubeWall, IsDenserAroundTheParticle) {
  const TubeOptions o = circle(12, 21);
  const TubeWall wall = of(o);
  const auto width = [&](int i) { return place(wall, {12 * i, 1, 0})[0] - place(wall, {12 * i, 0, 0})[0]; };
  EXPECT_NEAR(width(0) / width(10), o.grading, 0.5);  // 1 + 3/(1 + pi^4) at the ends
  for (int i = 0; i < 21; ++i) EXPECT_NEAR(width(i), width(20 - i), 1e-9);
}

TEST(TubeWall, HasALengthThatSuitsTheParticle) {
  TubeOptions o = circle(12, 8);
  EXPECT_NEAR(tube_length(o, 2, 1), 4 * pi, 1e-14);
  EXPECT_NEAR(tube_length(o, 1, 3), 3 + 4.6, 1e-14);
  o.length = 5;
  EXPECT_EQ(tube_length(o, 1, 3), 5);
}

TEST(TubeWall, HasElementsAlongItInProportionToThoseAroundIt) {
  for (const int around : {12, 24, 48}) {
    TubeOptions o;
    o.section = "circle", o.radius = 1, o.azimuthal_elements = around;
    EXPECT_EQ(of(o).space.elements.size(), static_cast<std::size_t>(around * std::ceil(25. * around / 24))) << around;
    EXPECT_NEAR(elements_per_period(o, 1, 2 * pi, 1), 25. * around / 24, 1) << around;  // as many as in a tube with ends of this length
  }
}

TEST(TubeWall, IsRejectedIfItIsTooShort) {
  const TubeWall wall = of(circle(12, 8));
  EXPECT_NO_THROW(check_length(wall, -1.4, 1.4));
  try {
    check_length(wall, -1.2, 1.8);
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("Tube/length must be at least 7 "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("6.283"), std::string::npos) << error.what();
  }
}

/// Returns the largest error of cos(2 pi x1/L + angle around), interpolated by densities of a periodic wall, at points of all elements.
double error_of_wave(int around, int along, double grading) {
  TubeOptions options = circle(around, along);
  options.grading = grading;
  const double period = 2.5;
  const TubeWall wall = periodic_tube_wall(outline(options), options, period, along);
  const auto wave = [&](const Vec3& x) { return std::cos(2 * pi * x[0] / period + std::atan2(x[2], x[1])); };
  const auto n = static_cast<Eigen::Index>(wall.sites.size());
  Eigen::MatrixXd at_sites = Eigen::MatrixXd::Zero(n, wall.space.n_points);
  Eigen::VectorXd right(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const spline::Site& site = wall.sites[static_cast<std::size_t>(i)].front();
    const spline::Element& element = wall.space.elements[static_cast<std::size_t>(site.element)];
    const Eigen::VectorXd basis = spline::basis(element, site.s, site.t, 0).value;
    for (std::size_t a = 0; a < element.points.size(); ++a) at_sites(i, element.points[a]) += basis[static_cast<Eigen::Index>(a)];
    right[i] = wave(place(wall, site));
  }
  const Eigen::VectorXd density = wall.open_from_periodic * (at_sites * wall.open_from_periodic).partialPivLu().solve(right);
  double error = 0;
  for (int e = 0; e < static_cast<int>(wall.space.elements.size()); ++e)
    for (const double s : {0., 0.5, 1.}) {
      const spline::Element& element = wall.space.elements[static_cast<std::size_t>(e)];
      const Eigen::VectorXd basis = spline::basis(element, s, 0.5, 0).value;
      double value = 0;
      for (std::size_t a = 0; a < element.points.size(); ++a) value += basis[static_cast<Eigen::Index>(a)] * density[element.points[a]];
      error = std::max(error, std::abs(value - wave(place(wall, {e, s, 0.5}))));
    }
  return error;
}

TEST(PeriodicTubeWall, HasDensitiesThatRepeatToTheOrderOfTheSplines) {
  for (const double grading : {1., 4.}) {
    const double coarse = error_of_wave(10, 8, grading), fine = error_of_wave(20, 16, grading);
    EXPECT_LT(coarse, 0.03) << grading;
    EXPECT_GT(std::log2(coarse / fine), 3.5) << grading;  // expected order 4; the seam costs at most 0.5
  }
}

TEST(PeriodicTubeWall, HasNoSitesAndNoElementCentresOnTheSeam) {
  const TubeOptions options = circle(10, 7);
  const TubeWall wall = periodic_tube_wall(outline(options), options, 2.5, 7);
  EXPECT_EQ(wall.sites.size(), 70u);
  EXPECT_EQ(wall.middles.size(), 70u);
  EXPECT_DOUBLE_EQ(wall.end - wall.start, 2.5);
  const auto from_seam = [&](const spline::Site& site) {
    const double x = place(wall, site)[0];
    return std::min(x - wall.start, wall.end - x);
  };
  for (const auto& sites : wall.sites)
    for (const spline::Site& site : sites) {
      EXPECT_GT(from_seam(site), 0.05);
      EXPECT_LT((place(wall, site) - place(wall, sites.front())).norm(), 1e-12);
    }
  for (const spline::Site& site : wall.middles) EXPECT_GT(from_seam(site), 0.05);
}

}  // namespace
}  // namespace tanktread::surface
