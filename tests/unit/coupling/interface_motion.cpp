// Control points of a drop: what moves across the interface is physics, what moves along it is a choice.

#include <cmath>

#include <gtest/gtest.h>

#include "coupling/collocation.hpp"
#include "tests/unit/coupling/sphere_in_flow.hpp"

namespace tanktread::coupling {
namespace {

struct Drop : SphereInFlow {
  Drop() : SphereInFlow(3, "planar hyperbolic") {
    parameters.law = membrane::SurfaceTension{5};
    parameters.measure = stokes::Measure::current;
    parameters.interface_speed = 1;
  }
  Net velocity(const std::string& motion, const Net& x) {
    parameters.interface_motion = motion;
    return capsule().velocity(x);
  }
  /// Largest normal and tangential component at the sites.
  std::pair<double, double> components(const Net& x, const Net& v) const {
    double across = 0, along = 0;
    for (const auto& sites : space.collocation) {
      const Vec3 n = surface::point(space, x, sites.front()).n, u = surface::value(space, v, sites.front());
      across = std::max(across, std::abs(n.dot(u)));
      along = std::max(along, (u - n * n.dot(u)).norm());
    }
    return {across, along};
  }
};

TEST(InterfaceMotion, AllMotionsCrossTheInterfaceAlike) {
  Drop drop;
  drop.parameters.volume.constraint = "none";
  Net x = drop.sphere;
  x.col(0) *= 1.2, x.col(2) *= 0.9;
  const Net material = drop.velocity("material", x);
  for (const char* motion : {"normal", "relaxed"}) {
    const Net difference = drop.velocity(motion, x) - material;
    const auto [across, along] = drop.components(x, difference);
    EXPECT_LT(across, 1e-13) << motion;  // projected and interpolated at the very sites that are looked at
    EXPECT_GT(along, 1e-2) << motion;
  }
}

TEST(InterfaceMotion, NormalMotionHasNoPartAlongTheInterface) {
  Drop drop;
  drop.parameters.volume.constraint = "none";
  const Net v = drop.velocity("normal", drop.sphere);
  const auto [across, along] = drop.components(drop.sphere, v);
  EXPECT_GT(across, 0.1);
  EXPECT_LT(along, 1e-13);
}

TEST(InterfaceMotion, RelaxedMeshGoesBackToItsShape) {
  Drop drop;
  drop.flow.type = "quiescent";
  // Slide the control points of a sphere along it: the surface is a sphere still, and the fluid at rest but for the error of the mesh.
  Net x = drop.sphere;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double turn = 0.2 * drop.sphere(i, 2);
    x.row(i) << std::cos(turn) * drop.sphere(i, 0) - std::sin(turn) * drop.sphere(i, 1),
        std::sin(turn) * drop.sphere(i, 0) + std::cos(turn) * drop.sphere(i, 1), drop.sphere(i, 2);
  }
  const membrane::Membrane mesh(drop.space, drop.sphere, membrane::NeoHookean{1});
  EXPECT_LT(mesh.load(x).cwiseProduct(drop.velocity("relaxed", x)).sum(), 0);  // the mesh's energy falls
}

}  // namespace
}  // namespace tanktread::coupling
