// Layer integrals on difficult surfaces: thin and long shapes, and surfaces that almost touch. Errors at every tolerance are compared with an
// independent reference rule. The allowed error is the tolerance times a factor, about twice the largest ratio measured.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "spline/extraction.hpp"
#include "spline/space.hpp"
#include "spline/t_mesh.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "tests/layers.hpp"
#include "tests/verify/layers_reference.hpp"

namespace tanktread {
namespace {

using stokes::CrossLayer;

Vec3 density(const Vec3& p) { return {1 + std::sin(p[0]) + p[1], p[2] * p[0] - 0.3, std::cos(p[1] + p[2])}; }

/// Particle on the cube mesh of n elements per side, with a smooth density on it.
struct Particle {
  spline::Space space;
  Net x, f;
  std::vector<int> all;

  Particle(int n, const surface::ParticleShape& shape) {
    const spline::TMesh mesh = spline::cube(n);
    space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    x = surface::resting_shape(space, mesh, shape);
    f = Net(x.rows(), 3);
    for (Eigen::Index i = 0; i < f.rows(); ++i) f.row(i) = density(x.row(i).transpose() - shape.center).transpose();
    all.resize(static_cast<std::size_t>(space.n_points));
    std::iota(all.begin(), all.end(), 0);
  }
};

surface::ParticleShape spheroid(double across, double along) {
  surface::ParticleShape shape;
  shape.shape = "spheroid";
  shape.semi_axes = Vec3(across, across, along);
  return shape;
}

surface::ParticleShape sphere(double radius, const Vec3& centre = Vec3::Zero()) {
  surface::ParticleShape shape;
  shape.radius = radius, shape.center = centre;
  return shape;
}

surface::ParticleShape red_cell() {
  surface::ParticleShape shape;
  shape.shape = "red cell", shape.radius = 1;
  return shape;
}

/// Computes (1 / 8 pi) int kernel(x - y, n) (f - f(y)) dGamma by brute force. f(y) is only subtracted in the double layer and if the target y lies on
/// the surface.
class Reference {
 public:
  explicit Reference(const Particle& p) : particle_(p), surface_(p.space, p.x) {
    for (const spline::Element& e : p.space.elements) field_.emplace_back(e, p.f);
  }

  Vec3 layer(bool single, const Vec3& y, const std::vector<spline::Site>& sites) const {
    const Vec3 own = single || sites.empty() ? Vec3(Vec3::Zero()) : field_[sites[0].element](sites[0].s, sites[0].t)[0];
    return surface_.integrate(y, sites, [&](const verify::SurfacePoint& p) -> Vec3 {
      const Mat3 kernel = single ? stokes::stokeslet(p.x - y) : stokes::stresslet(p.x - y, p.normal);
      return kernel * (field_[p.element](p.s, p.t)[0] - own);
    }) / (8 * std::numbers::pi);
  }

  Net at_collocation_points(bool single) const {
    Net u(particle_.space.n_points, 3);
    for (int i = 0; i < particle_.space.n_points; ++i) {
      const auto& sites = particle_.space.collocation[static_cast<std::size_t>(i)];
      u.row(i) = layer(single, surface_.point(sites.front()), sites);
    }
    return u;
  }

 private:
  const Particle& particle_;
  verify::BruteForce surface_;
  std::vector<verify::Casteljau> field_;
};

double largest_error(const Net& u, const Net& exact) { return (u - exact).rowwise().norm().maxCoeff() / exact.rowwise().norm().maxCoeff(); }

void keeps_tolerances(const char* name, const Particle& p, double allowed, std::initializer_list<double> tolerances) {
  const Reference reference(p);
  for (const bool single : {true, false}) {
    const Net exact = reference.at_collocation_points(single);
    Net u = Net::Zero(p.space.n_points, 3);
    for (const double tolerance : tolerances) {
      if (single)
        stokes::SingleLayer(p.space, {.tolerance = tolerance}).apply(p.x, p.f, stokes::Measure::current, p.all, u);
      else
        stokes::DoubleLayer(p.space, {.tolerance = tolerance}).apply(p.x, p.f, p.all, u);
      const double error = largest_error(u, exact);
      std::printf("%s layer, %-20s requested %.0e  error %.1e\n", single ? "single" : "double", name, tolerance, error);
      EXPECT_LT(error, allowed * tolerance) << name << (single ? ", single layer" : ", double layer");
    }
  }
}

TEST(LayersOfThinShapes, KeepTheRequestedTolerance) {
  // Elements of the two spheroids are longer than the spheroids are thick, and the density varies within them.
  keeps_tolerances("spheroid 1 : 5", Particle(4, spheroid(1, 0.2)), 5, {1e-3, 1e-5, 1e-8});
  keeps_tolerances("spheroid 5 : 1", Particle(4, spheroid(0.5, 2.5)), 5, {1e-3, 1e-5, 1e-8});
  keeps_tolerances("red cell", Particle(4, red_cell()), 6, {1e-3, 1e-5, 1e-8});
}

TEST(LayersOfThinShapesLong, KeepTheRequestedTolerance) {
  const auto tolerances = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  for (const int n : {4, 6, 8}) {
    keeps_tolerances("spheroid 1 : 10", Particle(n, spheroid(1, 0.1)), 15, tolerances);
    keeps_tolerances("spheroid 10 : 1", Particle(n, spheroid(0.3, 3)), 15, tolerances);
    keeps_tolerances("red cell", Particle(n, red_cell()), 6, tolerances);
  }
}

/// Returns points on a unit sphere above the unit sphere on the x3 axis, at the distance `gap`, around the point of closest approach.
Net beside(double gap) {
  const double angles[] = {0, 1e-3, 0.01, 0.03, 0.1, 0.3, 1};
  Net at(7, 3);
  for (int k = 0; k < 7; ++k) at.row(k) << 0.8 * std::sin(angles[k]), 0.6 * std::sin(angles[k]), 2 + gap - std::cos(angles[k]);
  return at;
}

/// Returns the density close to a point of the surface. Subtracting this constant does not change the double layer outside of the surface.
Vec3 value_nearby(const Particle& p, const Vec3& at) {
  Vec3 value;
  double least = HUGE_VAL;
  for (const auto& sites : p.space.collocation) {
    const double distance = (surface::value(p.space, p.x, sites.front()) - at).norm();
    if (distance < least) least = distance, value = surface::value(p.space, p.f, sites.front());
  }
  return value;
}

void keeps_tolerances_across_gaps(const Particle& p, double single_allowed, double double_allowed,
                                  std::initializer_list<double> tolerances) {
  const Reference reference(p);
  const Net nearby = value_nearby(p, Vec3(0, 0, 1)).transpose().replicate(7, 1);
  for (const double gap : {0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3}) {
    const Net at = beside(gap);
    std::vector<int> all(static_cast<std::size_t>(at.rows()));
    std::iota(all.begin(), all.end(), 0);
    for (const bool single : {true, false}) {
      Net exact(at.rows(), 3), u = exact;
      for (Eigen::Index k = 0; k < at.rows(); ++k) exact.row(k) = reference.layer(single, at.row(k).transpose(), {});
      for (const double tolerance : tolerances) {
        CrossLayer layer(p.space, {.tolerance = tolerance}, single ? CrossLayer::Kernel::single_layer : CrossLayer::Kernel::double_layer);
        layer.set_shape(p.x);
        single ? layer.apply(p.f, at, all, u) : layer.apply(p.f, nearby, at, all, u);
        const double error = largest_error(u, exact);
        std::printf("%s layer across a gap of %.0e, requested %.0e  error %.1e\n", single ? "single" : "double", gap, tolerance, error);
        EXPECT_LT(error, (single ? single_allowed : double_allowed) * tolerance) << gap << (single ? ", single layer" : ", double layer");
      }
    }
  }
}

TEST(LayersAcrossGaps, KeepTheRequestedTolerance) { keeps_tolerances_across_gaps(Particle(4, sphere(1)), 1.5, 2, {1e-3, 1e-5, 1e-8}); }

TEST(LayersAcrossGapsLong, KeepTheRequestedTolerance) {
  const auto tolerances = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  for (const int n : {3, 6, 8}) keeps_tolerances_across_gaps(Particle(n, sphere(1)), 2, 3, tolerances);
}

/// Two surfaces p and q in one common space, a gap apart. A collocation point of q faces a point of p. The layers are those of p only.
struct Film {
  spline::Space space;
  Net x, v;
  std::vector<int> targets;  ///< collocation points on q closest to p, and some around them
  Net exact[2];              ///< single and double layer of p at these targets

  Film(const Particle& p, const Particle& q, const Reference& reference, const spline::Site& contact, int facing, double gap,
       bool continuous) {
    const spline::Space* const both[] = {&p.space, &q.space};
    space = spline::stacked(both);
    const surface::Point place = surface::point(p.space, p.x, contact);
    const Vec3 nearest = surface::value(q.space, q.x, q.space.collocation[facing].front());
    const Mat3 turn = Eigen::Quaterniond::FromTwoVectors(nearest, -place.n).toRotationMatrix();
    const Vec3 centre = place.x + gap * place.n - turn * nearest;
    const Net xq = (q.x * turn.transpose()).rowwise() + centre.transpose();
    x = Net(space.n_points, 3), v = Net(space.n_points, 3);
    x << p.x, xq;
    v.topRows(p.space.n_points) = p.f;
    for (Eigen::Index i = 0; i < xq.rows(); ++i) {
      const Vec3 at = xq.row(i).transpose();
      v.row(p.space.n_points + i) = (continuous ? density(at) : Vec3(std::cos(2 * at[0]) - 1, at[1] * at[2] + 0.7, -1)).transpose();
    }
    const auto point = [&](int i) -> Vec3 { return surface::value(q.space, xq, q.space.collocation[i].front()); };
    std::vector<int> order = q.all;
    std::ranges::sort(order, {}, [&](int i) { return (point(i) - place.x).norm(); });
    for (const int k : {0, 1, 2, 3, 4, 6, 8, 10, 15, 20, 25}) targets.push_back(order[k]);
    for (const bool single : {true, false}) {
      exact[!single].resize(static_cast<Eigen::Index>(targets.size()), 3);
      for (std::size_t k = 0; k < targets.size(); ++k)
        exact[!single].row(static_cast<Eigen::Index>(k)) = reference.layer(single, point(targets[k]), {}).transpose();
    }
    for (int& i : targets) i += p.space.n_points;
  }

  Net layer(bool single, const quadrature::Options& options) const {
    Net u = Net::Zero(space.n_points, 3), f = v;
    if (single) {
      f.bottomRows(f.rows() / 2).setZero();
      stokes::SingleLayer(space, options).apply(x, f, stokes::Measure::current, targets, u);
    } else {
      std::vector<double> factor(space.elements.size(), 0.);
      std::fill_n(factor.begin(), factor.size() / 2, 1.);
      stokes::DoubleLayer(space, options, factor).apply(x, v, targets, u);
    }
    return u(targets, Eigen::all);
  }
};

/// Checks the largest errors, relative to the largest value of the layer and to the tolerance, for several contacts.
void keeps_tolerances_across_films(const char* name, const Particle& p, int n, double single_allowed, double double_allowed,
                                   std::initializer_list<double> tolerances) {
  const Particle q(n, sphere(1));
  const Reference reference(p);
  const int side = n * n;  // number of elements per face
  const std::pair<spline::Site, int> contacts[] = {
      {{7, 0.37, 0.61}, q.space.n_points / 3}, {{side + n + 1, 0.5, 0.5}, q.space.n_points / 2}, {{3 * side, 0, 0}, 5}};
  for (const double gap : {0.3, 0.1, 0.03, 0.01, 1e-3})
    for (const bool continuous : {true, false}) {
      std::vector<Film> films;
      for (const auto& [contact, facing] : contacts) films.emplace_back(p, q, reference, contact, facing, gap, continuous);
      for (const bool single : {true, false}) {
        if (single && !continuous) continue;
        double scale = 0;
        for (const Film& film : films) scale = std::max(scale, film.exact[!single].rowwise().norm().maxCoeff());
        for (const double tolerance : tolerances) {
          double error = 0;
          for (const Film& film : films)
            error =
                std::max(error, (film.layer(single, {.tolerance = tolerance}) - film.exact[!single]).rowwise().norm().maxCoeff() / scale);
          const char* const kind = single ? "single layer" : continuous ? "double layer, continuous" : "double layer, independent";
          std::printf("%-26s %-16s n = %d  film of %.0e, requested %.0e  error over tolerance %.2f\n", kind, name, n, gap, tolerance,
                      error / tolerance);
          EXPECT_LT(error, (single ? single_allowed : double_allowed) * tolerance) << name << ", " << kind << ", " << gap;
        }
      }
    }
}

TEST(LayersAcrossFilms, KeepTheRequestedTolerance) {
  keeps_tolerances_across_films("sphere", Particle(4, sphere(1)), 4, 1.5, 2, {1e-3, 1e-4, 1e-6, 1e-8});
}

TEST(LayersAcrossFilmsLong, KeepTheRequestedTolerance) {
  const auto tolerances = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  for (const int n : {3, 6}) keeps_tolerances_across_films("sphere", Particle(n, sphere(1)), n, 2, 4, tolerances);
  keeps_tolerances_across_films("spheroid 1 : 4", Particle(4, spheroid(0.5, 2)), 4, 2, 4, tolerances);
  keeps_tolerances_across_films("red cell", Particle(4, red_cell()), 4, 2, 4, tolerances);
}

}  // namespace
}  // namespace tanktread
