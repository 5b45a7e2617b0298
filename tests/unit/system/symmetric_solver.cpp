// Tests that the solver of the fundamental part of a symmetric system gives the solution of the whole system.

#include "membrane/symmetric_solver.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "membrane/mass.hpp"
#include "spline/extraction.hpp"
#include "spline/refinement.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "system/targets/collocation.hpp"

namespace tanktread::coupling {
namespace {

using Keeps = std::function<bool(const surface::Image&)>;

struct Surface {
  spline::TMesh mesh;
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  Net net = surface::resting_shape(space, mesh, ellipsoid());

  explicit Surface(spline::TMesh m) : mesh(std::move(m)) {}

  static surface::ParticleShape ellipsoid() {
    surface::ParticleShape shape;
    shape.shape = "ellipsoid";
    shape.semi_axes = Vec3(1.3, 1, 0.8);
    return shape;
  }

  surface::Symmetry symmetry(const Keeps& keeps) const {
    const Net* nets[] = {&net};
    return surface::symmetry(space, nets, keeps);
  }
};

/// Returns a mesh refined around both poles of x1, whose elements are images of each other under every reflection.
spline::TMesh refined() {
  const Surface coarse(spline::cube(6, 1));
  std::vector<spline::Mark> marks;
  for (int e = 0; e < static_cast<int>(coarse.space.elements.size()); ++e)
    if (std::abs(surface::value(coarse.space, coarse.net, {e, 0.5, 0.5})[0]) > 1.15) marks.push_back({e, true, true});
  return spline::refine(coarse.mesh, marks).mesh;
}

void expect_the_same(const Surface& s, const Keeps& keeps, const std::string& description) {
  const surface::Symmetry symmetry = s.symmetry(keeps);
  ASSERT_EQ(symmetry.description(), description);
  Net field = Net::Random(s.space.n_points, 3);
  symmetry.complete(field);
  for (const Eigen::SparseMatrix<double>& a : {collocation_matrix(s.space), membrane::MassMatrix(s.space).update(s.net)}) {
    membrane::SymmetricSolver reduced({}, symmetry), whole;
    reduced.factor(a);
    whole.factor(a);
    const Net b = a * field, x = whole.solve(b);
    EXPECT_LT((reduced.solve(b) - x).norm(), 1e-13 * x.norm()) << description;
    Net other_rows = b;  // only fundamental rows of the right-hand side are used
    symmetry.complete(other_rows);
    EXPECT_EQ((reduced.solve(other_rows) - reduced.solve(b)).norm(), 0);
  }
}

const Keeps all = [](const surface::Image&) { return true; };
const Keeps shear = [](const surface::Image& image) { return image.signs[0] == image.signs[2]; };
const Keeps mirror = [](const surface::Image& image) { return image.signs == Vec3(1, -1, 1); };
const Keeps point = [](const surface::Image& image) { return image.signs == Vec3(-1, -1, -1); };
const Keeps turns = [](const surface::Image& image) { return image.signs.prod() > 0; };

TEST(SymmetricSolver, EqualsTheFullSolverOnSymmetricFields) {
  const Surface s(spline::cube(4));
  expect_the_same(s, all, "mirror x1, mirror x2 and mirror x3");
  expect_the_same(s, shear, "mirror x2 and point symmetry");
  expect_the_same(s, mirror, "mirror x2");
  expect_the_same(s, point, "point symmetry");
  expect_the_same(s, turns, "half turn about x1 and half turn about x2");
  expect_the_same(s, [](const surface::Image&) { return false; }, "none");
}

TEST(SymmetricSolver, EqualsTheFullSolverOnRefinedSurfaces) {
  const Surface s(refined());
  ASSERT_GT(s.space.n_points, Surface(spline::cube(6)).space.n_points);
  expect_the_same(s, all, "mirror x1, mirror x2 and mirror x3");
  expect_the_same(s, shear, "mirror x2 and point symmetry");
}

}  // namespace
}  // namespace tanktread::coupling
