#include "membrane/patch_forces.hpp"

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/shapes.hpp"

namespace tanktread::membrane {
namespace patch_forces_test {

struct Sphere {
  spline::TMesh mesh;
  spline::Space space;
  Net net;

  explicit Sphere(int elements_per_side)
      : mesh(spline::cube(elements_per_side)),
        space(spline::space(mesh, spline::ExtraordinaryRule::catmull_clark)),
        net(surface::resting_shape(space, mesh, {})) {}

  Net work(std::vector<PatchForce> forces) const { return PatchForces{std::move(forces)}.virtual_work(space, net); }
};

TEST(PatchForces, AddUpToTheForcesAndTheirTorque) {
  const Sphere sphere(4);
  const Vec3 direction(1, 2, -1), force(0.3, -1, 2);
  for (const double radius : {0.05, 0.4}) {
    const Net work = sphere.work({{"one", direction, radius, force}});
    EXPECT_LT((work.colwise().sum().transpose() - force).norm(), 1e-14);
    Vec3 torque = Vec3::Zero();
    for (Eigen::Index a = 0; a < work.rows(); ++a) torque += Vec3(sphere.net.row(a)).cross(Vec3(work.row(a)));
    // The force is axisymmetric about the ray. Mean of cos = sqrt(1 - radius^2 u) with the weight (1 - u)^2 du, for which the mean of u is 1/4.
    const Vec3 lever = (1 - radius * radius / 8) * direction.normalized();
    EXPECT_LT((torque - lever.cross(force)).norm(), 2e-3 * torque.norm()) << radius;
  }
}

/// The moments are equal for a small patch on a coarse mesh and for a large patch on a fine mesh: the quadrature resolves both.
TEST(PatchForces, HaveTheSameMomentsOnEveryMesh) {
  std::vector<Mat3> moments;
  for (const int n : {4, 8}) {
    const Sphere sphere(n);
    const Net work = sphere.work({{"one", {1, 0.3, 0.2}, 0.3, {0, 0, 1}}, {"other", {-1, 0, 0}, 0.1, {1, 0, 0}}});
    moments.push_back(work.transpose() * sphere.net);
  }
  EXPECT_LT((moments[0] - moments[1]).norm(), 2e-4 * moments[0].norm());
}

TEST(PatchForces, MustHaveDifferentDirections) {
  EXPECT_THROW(PatchForces({{{"one", {1, 0, 0}, 0.1, {}}, {"other", {2, 0, 0}, 0.3, {}}}}).check(), UserError);
  EXPECT_THROW(PatchForces({{{"one", {0, 0, 0}, 0.1, {}}}}).check(), UserError);
  EXPECT_NO_THROW(PatchForces({{{"one", {1, 0, 0}, 0.1, {}}, {"other", {-2, 0, 0}, 0.3, {}}}}).check());
}

}  // namespace patch_forces_test
}  // namespace tanktread::membrane
