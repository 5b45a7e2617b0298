// Planar hyperbolic flow at Ca = 0.8, where a capsule's tips are sharper than the elements of a coarse mesh: valleys appear beside the tips and a
// compression that is not there. The paper's section 4.3 refines from 218 control points. Map hyperbolic of postproc/atlas.py.

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "surface/geometry.hpp"
#include "tests/evolution.hpp"

namespace tanktread {
namespace {

struct Tip {
  double smallest_tension, smallest_curvature;
};

Tip tip(int n, double ca) {
  Evolution run({"Flow/type=planar hyperbolic", "Membrane/law=Skalak", "Membrane/area dilatation=1",
                 "Surface/elements per side=" + std::to_string(n), "Membrane/capillary number=" + std::to_string(ca),
                 "Time/tolerance=1e-3"});
  run.to(4);
  double curvature = std::numeric_limits<double>::infinity();
  for (const auto& sites : run.body.space.collocation)
    curvature = std::min(curvature, surface::mean_curvature(run.body.space, run.state.x, sites.front()));
  return {run.capsule->membrane().tension_summary(run.state.x).smallest, curvature};
}

TEST(Tips, OnACoarseMeshAreCompressedAlthoughTheMembraneIsNot) {
  const Tip coarse = tip(4, 0.8), fine = tip(6, 0.8);
  EXPECT_LT(coarse.smallest_tension, -0.1);  // -0.25 measured
  EXPECT_GT(fine.smallest_tension, 0);       // 0.05 measured
}

TEST(Tips, OfAWeakerFlowNeedNoFinerMesh) { EXPECT_GT(tip(4, 0.45).smallest_tension, -0.03); }  // -0.01 measured

}  // namespace
}  // namespace tanktread
