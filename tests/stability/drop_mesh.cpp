// Mesh of a drop in an extensional flow. If the mesh is convected with the fluid, its elements are stretched until they fold. If it only moves across
// the interface, or is relaxed along it, they are not. See the map `drop-mesh` of tests/benchmark/atlas.py.

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "base/indices.hpp"
#include "surface/bezier_points.hpp"
#include "surface/quality.hpp"
#include "tests/evolution.hpp"

namespace tanktread {
namespace {

/// Returns the quality of the mesh at a time, or when the run fails.
surface::Quality mesh_at(const std::string& motion, double time) {
  Evolution run({"Flow/type=uniaxial extension", "Membrane/law=surface tension", "Membrane/capillary number=0.1",
                 "Surface/elements per side=4", "Time/tolerance=1e-3", "Interface/motion=" + motion});
  const surface::BezierMap map(run.body().space);
  try {
    run.to(time);
  } catch (const RunFailure&) {
  }
  return surface::quality(map, run.x(), indices(map.n_elements()));
}

TEST(MeshOfADrop, ConvectedWithTheFluidIsDistortedAndOtherMeshesAreNot) {
  const double carried = mesh_at("material", 2).aspect_ratio;
  for (const char* motion : {"normal", "relaxed"}) {
    const surface::Quality quality = mesh_at(motion, 2);
    EXPECT_LT(quality.aspect_ratio, carried / 2) << motion;
    EXPECT_GT(quality.jacobian_ratio, 0.2) << motion;
  }
  EXPECT_LT(mesh_at("material", 1).aspect_ratio, carried / 1.5);  // stretching continues in time
}

}  // namespace
}  // namespace tanktread
