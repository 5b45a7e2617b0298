// Layer integrals compared with an independent reference rule and with exact solutions.

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <numeric>
#include <utility>

#include "spline/extraction.hpp"
#include "spline/polar.hpp"
#include "spline/refinement.hpp"
#include "spline/transfer.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "tests/layers.hpp"
#include "tests/verify/layers_reference.hpp"

namespace tanktread {
namespace layers_test {

/// Strongly deformed, S-shaped surface of the cube mesh with a smooth load on it.
struct Scene {
  spline::Space space;
  Net unstressed, x, f;
  std::vector<int> all;

  explicit Scene(int n) {
    const spline::TMesh mesh = spline::cube(n);
    space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    deform(surface::unit_sphere(mesh, surface::LeastSquaresFit(space)));
  }

  Scene(spline::Space on, const Net& sphere) : space(std::move(on)) { deform(sphere); }

  void deform(const Net& sphere) {
    unstressed = sphere;
    const surface::LeastSquaresFit fit(space);
    x = fit.fit_image(unstressed, [](const Vec3& p) {
      return Vec3(1.4 * p[0] + 0.35 * p[2] + 0.1 * p[1] * p[2], 0.85 * p[1] + 0.08 * p[0] * p[0], 0.7 * p[2] - 0.15 * p[0] * p[0] * p[0]);
    });
    f = fit.fit_image(unstressed,
                      [](const Vec3& p) { return Vec3(std::sin(2 * p[0]) + p[1], p[2] * p[0] + 0.3, std::cos(p[1] + p[2]) - p[0]); });
    all.resize(space.n_points);
    std::iota(all.begin(), all.end(), 0);
  }

  /// Returns (H v)_i of (2.2) with v = f.
  Net double_reference() const {
    return by_brute_force([](const Vec3& r, const Vec3& n) { return stokes::stresslet(r, n); }, true);
  }

  Net reference() const {
    return by_brute_force([](const Vec3& r, const Vec3&) { return stokes::stokeslet(r); }, false);
  }

 private:
  /// Returns (1 / 8 pi) int kernel(x - x_i, n) f dGamma at every collocation point x_i. If `less_its_own`, f(x_i) is subtracted from f.
  Net by_brute_force(const std::function<Mat3(const Vec3& r, const Vec3& n)>& kernel, bool less_its_own) const {
    const verify::BruteForce surface(space, x);
    std::vector<verify::Casteljau> field;
    for (const spline::Element& e : space.elements) field.emplace_back(e, f);
    Net u(space.n_points, 3);
    for (int i = 0; i < space.n_points; ++i) {
      const auto& sites = space.collocation[i];
      const Vec3 x0 = surface.point(sites.front()), own = field[sites.front().element](sites.front().s, sites.front().t)[0];
      const Vec3 f0 = less_its_own ? own : Vec3(Vec3::Zero());
      u.row(i) = surface.integrate(x0, sites, [&](const verify::SurfacePoint& p) -> Vec3 {
        return kernel(p.x - x0, p.normal) * (field[p.element](p.s, p.t)[0] - f0);
      }) / (8 * std::numbers::pi);
    }
    return u;
  }
};

double largest_error(const Net& u, const Net& reference) {
  return (u - reference).rowwise().norm().maxCoeff() / reference.rowwise().norm().maxCoeff();
}

/// Returns the relative root mean square error over the targets. The largest error would only be of order 2.7, because of the extraordinary points.
double mean_error(const Net& u, const Net& reference) { return (u - reference).norm() / reference.norm(); }

/// Checks that the error is below the tolerance at every target. Prints the kernel evaluations.
void keeps_its_tolerance(bool single, const char* name, const Scene& scene, double finest = 1e-10) {
  const Net reference = single ? scene.reference() : scene.double_reference();
  Net u = Net::Zero(scene.space.n_points, 3);
  for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-8, 1e-10}) {
    if (tolerance < finest) continue;
    stokes::SingleLayer single_layer(scene.space, {.tolerance = tolerance});
    stokes::DoubleLayer double_layer(scene.space, {.tolerance = tolerance});
    if (single)
      single_layer.apply(scene.x, scene.f, stokes::Measure::current, scene.all, u);
    else
      double_layer.apply(scene.x, scene.f, scene.all, u);
    const double error = largest_error(u, reference);
    const auto& done = single ? single_layer.evaluations() : double_layer.evaluations();
    std::printf("%s layer, %-34s %6d targets  requested %.0e  error %.1e  kernel evaluations: far %9lld  near %8lld  self %8lld\n",
                single ? "single" : "double", name, scene.space.n_points, tolerance, error, done.far, done.near, done.self);
    EXPECT_LT(error, tolerance) << name;
  }
}

TEST(SingleLayer, KeepsTheRequestedToleranceAtTheCollocationPointsOfADeformedSurface) {
  keeps_its_tolerance(true, "deformed, n = 3", Scene(3));
  keeps_its_tolerance(true, "deformed, n = 6", Scene(6));
}

/// Returns a scene with targets in the middle of elements, near an edge and near a corner.
Scene with_targets_inside_elements(int n) {
  Scene scene(n);
  const double place[3][2] = {{0.5, 0.5}, {0.05, 0.4}, {0.9, 0.95}};
  for (int i = 0; i < scene.space.n_points; ++i) {
    const int e = i % static_cast<int>(scene.space.elements.size());
    scene.space.collocation[i] = {{e, place[i % 3][0], place[i % 3][1]}};
  }
  return scene;
}

TEST(SingleLayer, KeepsTheRequestedToleranceAtPointsInsideElements) {
  keeps_its_tolerance(true, "n = 4, targets inside elements", with_targets_inside_elements(4));
}

TEST(DoubleLayer, KeepsTheRequestedToleranceAtTheCollocationPointsOfADeformedSurface) {
  keeps_its_tolerance(false, "deformed, n = 3", Scene(3));
  keeps_its_tolerance(false, "deformed, n = 6", Scene(6));
}

TEST(DoubleLayer, KeepsTheRequestedToleranceAtPointsInsideElements) {
  keeps_its_tolerance(false, "n = 4, targets inside elements", with_targets_inside_elements(4));
}

/// The meshes have elements of different sizes, T-junctions, and the tiny pieces at extraordinary points of Catmull-Clark surfaces.
TEST(Layers, KeepTheRequestedToleranceOnLocallyRefinedMeshes) {
  constexpr auto rule = spline::ExtraordinaryRule::catmull_clark;
  const spline::TMesh coarse = spline::cube(4, 2);
  const spline::TMesh fine = spline::refine(coarse, {{5, true, true}, {6, true, false}, {37, false, true}}).mesh;
  const spline::Space from = spline::space(coarse, rule), to = spline::space(fine, rule);
  const Scene scene(to, spline::transfer(from, to)(surface::unit_sphere(coarse, surface::LeastSquaresFit(from))).net);
  keeps_its_tolerance(true, "refined locally", scene);
  keeps_its_tolerance(false, "refined locally", scene);
}

/// The elements have one side collapsed to a point, or are strongly sheared around it.
TEST(Layers, KeepTheRequestedToleranceAtPoles) {
  for (const auto poles : {spline::PoleRule::plain, spline::PoleRule::c1, spline::PoleRule::bezier_transform}) {
    const spline::PolarMesh mesh{12, 6, poles, 1};
    const spline::Space space = spline::space(mesh);
    surface::ParticleShape unit;
    unit.radius = 1;
    const Scene scene(space, surface::resting_shape(space, mesh, 2, unit));
    const char* const name = poles == spline::PoleRule::plain ? "plain poles"
                             : poles == spline::PoleRule::c1  ? "C1 poles"
                                                              : "transformed poles";
    const double finest = poles == spline::PoleRule::bezier_transform ? 1e-8 : 1e-10;  // the shear of the pieces limits the error to 3e-10
    keeps_its_tolerance(true, name, scene, finest);
    keeps_its_tolerance(false, name, scene, finest);
  }
}

/// Sphere of the cube mesh with n elements per side, and the error of a layer of a vector spherical harmonic.
struct Sphere {
  spline::Space space;
  Net x;
  std::vector<int> all;

  explicit Sphere(int n) {
    const spline::TMesh mesh = spline::cube(n);
    space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    x = surface::unit_sphere(mesh, surface::LeastSquaresFit(space), 10);
    all.resize(space.n_points);
    std::iota(all.begin(), all.end(), 0);
  }

  Net points() const {
    Net at(space.n_points, 3);
    for (int i = 0; i < space.n_points; ++i) at.row(i) = surface::value(space, x, space.collocation[i].front());
    return at;
  }

  double error(bool single, const std::function<Vec3(const Vec3&)>& field, double eigenvalue) const {
    const Net f = surface::LeastSquaresFit(space).fit_image(x, [&](const Vec3&p) { return field(p.normalized()); }), at = points();
    Net u = Net::Zero(space.n_points, 3), exact = u;
    if (single)
      stokes::SingleLayer(space, {.tolerance = 1e-8}).apply(x, f, stokes::Measure::current, all, u);
    else
      stokes::DoubleLayer(space, {.tolerance = 1e-8}).apply(x, f, all, u);
    for (int i = 0; i < space.n_points; ++i) exact.row(i) = eigenvalue * field(at.row(i).transpose().normalized());
    return mean_error(u, exact);
  }
};

/// Vector spherical harmonics of the solid harmonic H = x1^2 - x2^2 + x1 x3 (n = 2); grad_s Y = grad H - n Y e_r on the unit sphere.
struct Harmonic {
  static constexpr int n = 2;
  static double y(const Vec3& e) { return e[0] * e[0] - e[1] * e[1] + e[0] * e[2]; }
  static Vec3 slope(const Vec3& e) { return Vec3(2 * e[0] + e[2], -2 * e[1], e[0]) - n * y(e) * e; }
  static Vec3 v(const Vec3& e) { return slope(e) - (n + 1) * y(e) * e; }
  static Vec3 w(const Vec3& e) { return slope(e) + n * y(e) * e; }
  static Vec3 x(const Vec3& e) { return e.cross(slope(e)); }
};

/// The eigenvalues of V, W, X under the single layer are n / ((2n+1)(2n+3)), (n+1) / ((2n+1)(2n-1)), 1 / (2n+1). Under the principal value of the
/// double layer they are 3/2 / ((2n+1)(2n+3)), -3/2 / ((2n+1)(2n-1)), -3/2 / (2n+1). H is the principal value plus 1/2.
TEST(Layers, HaveTheEigenvaluesOfTheSphereToTheOrderOfTheSpace) {
  constexpr double n = Harmonic::n, up = (2 * n + 1) * (2 * n + 3), down = (2 * n + 1) * (2 * n - 1);
  const struct {
    bool single;
    const char* name;
    Vec3 (*field)(const Vec3&);
    double eigenvalue;
  } modes[] = {{true, "V", Harmonic::v, n / up},
               {true, "W", Harmonic::w, (n + 1) / down},
               {true, "X", Harmonic::x, 1 / (2 * n + 1)},
               {false, "V", Harmonic::v, 0.5 + 1.5 / up},
               {false, "W", Harmonic::w, 0.5 - 1.5 / down},
               {false, "X", Harmonic::x, 0.5 - 1.5 / (2 * n + 1)}};
  const Sphere coarse(6), fine(12);
  for (const auto& mode : modes) {
    const double at_6 = coarse.error(mode.single, mode.field, mode.eigenvalue),
                 at_12 = fine.error(mode.single, mode.field, mode.eigenvalue);
    const double order = std::log2(at_6 / at_12);
    std::printf("%s layer, %s_2: error %.2e (n = 6), %.2e (n = 12), order %.2f\n", mode.single ? "single" : "double", mode.name, at_6,
                at_12, order);
    EXPECT_LT(at_12, mode.single ? 2e-5 : 5e-5) << mode.name;
    EXPECT_GT(order, 3.2) << mode.name;  // h^4, except near extraordinary points, where the error of the normal is of order h^2.7
  }
}

/// The traction on a prolate spheroid (semi-axes a, a, c) that moves at U is f_i = F_i h / (4 pi a^2 c) with h = n.x; its single layer is U.
TEST(SingleLayer, OfTheTractionOnAMovingSpheroidIsItsVelocity) {
  const double a = 0.8, c = 1.2, e = std::sqrt(1 - a * a / (c * c)), l = std::log((1 + e) / (1 - e));
  const double along = 16 * std::numbers::pi * c * e * e * e / (-2 * e + (1 + e * e) * l);
  const double across = 32 * std::numbers::pi * c * e * e * e / (2 * e + (3 * e * e - 1) * l);
  const Vec3 velocity(0.6, 0, 0.8), force(across * velocity[0], 0, along * velocity[2]);
  double error[2];
  for (const int k : {0, 1}) {
    const spline::TMesh mesh = spline::cube(k ? 12 : 6);
    const spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    const surface::LeastSquaresFit fit(space);
    const Net sphere = surface::unit_sphere(mesh, fit, 10);
    const Net x = fit.fit_image(sphere, [&](const Vec3& p) -> Vec3 { return p.normalized().cwiseProduct(Vec3(a, a, c)); });
    const Net f = fit.fit_image(sphere, [&](const Vec3& p) -> Vec3 {
      const Vec3 unit = p.normalized();
      return force / (4 * std::numbers::pi * a * a * c) / unit.cwiseQuotient(Vec3(a, a, c)).norm();
    });
    std::vector<int> all(space.n_points);
    std::iota(all.begin(), all.end(), 0);
    Net u = Net::Zero(space.n_points, 3);
    stokes::SingleLayer layer(space, {.tolerance = 1e-8});
    layer.apply(x, f, stokes::Measure::current, all, u);
    error[k] = mean_error(u, velocity.transpose().replicate(space.n_points, 1));
  }
  std::printf("spheroid 1 : 1.5: error of the velocity %.2e (n = 6), %.2e (n = 12)\n", error[0], error[1]);
  EXPECT_LT(error[1], 1e-5);
  EXPECT_GT(std::log2(error[0] / error[1]), 3.5);
}

/// Points on both sides of the surface at the distance d/h from generic points of some elements. `v`: density at the closest point. `inside`: whether
/// the point is inside.
struct Beside {
  Net at, v;
  std::vector<bool> inside;

  Beside(const Scene& scene, double distance) : at(12, 3), v(12, 3) {
    const double place[3][2] = {{0.5, 0.5}, {0.02, 0.4}, {0, 0}};
    for (int k = 0; k < 12; ++k) {
      const spline::Site site{17 * k % static_cast<int>(scene.space.elements.size()), place[k % 3][0], place[k % 3][1]};
      const surface::Point p = surface::point(scene.space, scene.x, site);
      inside.push_back(k % 2 == 1);
      at.row(k) = p.x + (inside[k] ? -1 : 1) * distance * std::sqrt(p.jacobian) * p.n;
      v.row(k) = surface::value(scene.space, scene.f, site);
    }
  }
};

/// Returns the double layer of v, evaluated with v - v0, where v0 is the density nearby. The contribution of the constant v0 is known (2.3).
Net double_layer(stokes::CrossLayer& layer, const Net& v, const Net& v0, const Beside& points, const std::vector<int>& all) {
  Net u(points.at.rows(), 3);
  layer.apply(v, v0, points.at, all, u);
  for (Eigen::Index k = 0; k < u.rows(); ++k)
    if (points.inside[static_cast<std::size_t>(k)]) u.row(k) -= v0.row(k);
  return u;
}

TEST(CrossLayer, KeepsTheRequestedToleranceAsATargetApproachesTheSurface) {
  const Scene scene(4);
  const verify::BruteForce surface(scene.space, scene.x);
  std::vector<verify::Casteljau> field;
  for (const spline::Element& e : scene.space.elements) field.emplace_back(e, scene.f);
  using Kernel = stokes::CrossLayer::Kernel;
  const Net none = Net::Zero(12, 3);
  std::vector<int> all(12);
  std::iota(all.begin(), all.end(), 0);
  for (const double distance : {1., 0.3, 0.1, 1e-2, 1e-3, 1e-4}) {
    const Beside points(scene, distance);
    Net one(12, 3), two(12, 3);
    for (int k = 0; k < 12; ++k) {
      const Vec3 y = points.at.row(k).transpose();
      one.row(k) = surface.integrate(y, {}, [&](const verify::SurfacePoint& p) -> Vec3 {
        return stokes::stokeslet(p.x - y) * field[p.element](p.s, p.t)[0];
      }) / (8 * std::numbers::pi);
      two.row(k) = surface.integrate(y, {}, [&](const verify::SurfacePoint& p) -> Vec3 {
        return stokes::stresslet(p.x - y, p.normal) * field[p.element](p.s, p.t)[0];
      }) / (8 * std::numbers::pi);
    }
    for (const double tolerance : {1e-5, 1e-8}) {
      stokes::CrossLayer forces(scene.space, {.tolerance = tolerance}, Kernel::single_layer),
          stresses(scene.space, {.tolerance = tolerance}, Kernel::double_layer);
      forces.set_shape(scene.x), stresses.set_shape(scene.x);
      Net u(12, 3);
      forces.apply(scene.f, points.at, all, u);
      const double single = largest_error(u, one), twofold = largest_error(double_layer(stresses, scene.f, points.v, points, all), two);
      double angle = 0;
      for (int j = 0; j < 3; ++j) {
        const Net constant = Vec3::Unit(j).transpose().replicate(scene.space.n_points, 1);
        stresses.apply(constant, none, points.at, all, u);
        for (int k = 0; k < 12; ++k) angle = std::max(angle, (u.row(k) + points.inside[k] * Vec3::Unit(j).transpose()).cwiseAbs().maxCoeff());
      }
      std::printf("d/h = %.0e  requested %.0e  errors: single %.1e  double %.1e  int T n %.1e  kernel evaluations: near %lld\n", distance,
                  tolerance, single, twofold, angle, forces.evaluations().near + stresses.evaluations().near);
      EXPECT_LT(single, 2 * tolerance) << distance;  // the rule of each panel is chosen separately, and their errors add up
      EXPECT_LT(twofold, tolerance) << distance;
      EXPECT_LT(angle, 10 * tolerance) << distance;  // the constant is not subtracted, so this integral is nearly singular of second order
    }
  }
}

}  // namespace layers_test
}  // namespace tanktread
