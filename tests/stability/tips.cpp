// Planar hyperbolic flow at Ca = 0.8, in which a capsule's tips are sharper than the elements of a coarse mesh: valleys next to the tips and a
// compression appear that are not physical. On the paper's 218 control points (section 4.3, Figures 17 and 18) the shape is right and the traction is
// not. See the maps `hyperbolic` and `tip-traction` of tests/benchmark/atlas.py.

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "surface/geometry.hpp"
#include "surface/patch.hpp"
#include "tests/evolution.hpp"
#include "tests/membrane_totals.hpp"
#include "tests/shape_measures.hpp"

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
  for (const auto& sites : run.body().space.collocation)
    curvature = std::min(curvature, surface::mean_curvature(run.body().space, run.x(), sites.front()));
  return {tension_summary(run.capsule->membrane(), run.x()).smallest, curvature};
}

TEST(Tips, OnACoarseMeshAreCompressedAlthoughTheMembraneIsNot) {
  const Tip coarse = tip(4, 0.8), fine = tip(6, 0.8);
  EXPECT_LT(coarse.smallest_tension, -0.1);  // measured: -0.25
  EXPECT_GT(fine.smallest_tension, 0);       // measured: 0.05
}

TEST(Tips, OfAWeakerFlowNeedNoFinerMesh) { EXPECT_GT(tip(4, 0.45).smallest_tension, -0.03); }  // measured: -0.01

struct Steady {
  double traction, taylor;
};

/// Returns the traction per current area at the tip, where four elements meet, and the Taylor parameter.
Steady steady(int n, const std::vector<std::string>& settings) {
  std::vector<std::string> all{"Flow/type=planar hyperbolic", "Membrane/law=Skalak", "Membrane/area dilatation=1", "Membrane/capillary number=0.8",
                               "Surface/elements per side=" + std::to_string(n), "Time/tolerance=1e-3"};
  all.insert(all.end(), settings.begin(), settings.end());
  Evolution run(all);
  run.to(8);
  const spline::Space& space = run.body().space;
  const auto reach = [&](const auto& sites) { return surface::value(space, run.x(), sites.front())[0]; };
  const spline::Site site = std::ranges::max_element(space.collocation, {}, reach)->front();
  const auto area = [&](const Net& net) {
    return surface::jacobian(surface::jet(surface::ElementPoints(space, net, site.element).patch(), site.s, site.t));
  };
  double traction = surface::value(space, run.capsule->evaluate(run.x())->load(), site).norm();
  if (run.capsule->solver().membranes().measure() == stokes::Measure::reference) traction *= area(run.body().unstressed) / area(run.x());
  return {traction, run.deformation().taylor_inertia};
}

TEST(Tips, OnThePapersMeshHaveTheRightShapeAndTheWrongTraction) {
  const Steady fine = steady(12, {}), present = steady(6, {"Membrane/load measure=current", "Volume/constraint=flux"}), unstressed = steady(6, {});
  EXPECT_LT(present.traction, 0.93 * fine.traction);  // measured: 0.89; in the paper: 0.83
  EXPECT_GT(unstressed.traction, present.traction);   // measured: 0.94 of the fine mesh's traction
  EXPECT_NEAR(present.taylor, fine.taylor, 0.005);    // measured: 0.0025
}

}  // namespace
}  // namespace tanktread
