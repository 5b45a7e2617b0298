// Tests of runs whose initial shape differs from the resting shape.

#include <cmath>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "surface/geometry.hpp"
#include "tests/evolution.hpp"

namespace tanktread {
namespace {

std::vector<std::string> at_rest(std::vector<std::string> more) {
  more.insert(more.end(), {"Flow/type=quiescent", "Membrane/law=Skalak", "Membrane/shear modulus=1", "Surface/elements per side=3",
                           "Surface/extraordinary points=catmull-clark", "Quadrature/tolerance=1e-5", "Time/final time=12"});
  return more;
}

TEST(InitialShape, RelaxesToTheRestingOneAndLosesEnergyInEveryStep) {
  Evolution run(at_rest({"Particle/initial shape/stretch=[1.4, 1, 0.8]"}));
  const double first = run.energy(), volume = surface::volume(run.body().space, run.body().rest);
  // semi-axes 1.4 and 0.8 times a common factor; the mesh has three elements per side
  EXPECT_NEAR(run.deformation().taylor_inertia, 0.6 / 2.2, 1e-3);
  while (run.state.time < 12) {
    const double energy = run.energy();
    run.step(12);
    EXPECT_LT(run.energy(), energy) << "at " << run.state.time;
  }
  EXPECT_LT(run.energy(), 1e-3 * first);
  EXPECT_LT(run.deformation().taylor_inertia, 0.02);
  EXPECT_NEAR(surface::volume(run.body().space, run.x()) / volume, 1, 1e-13);
}

TEST(InitialShape, ThatEqualsTheRestingShapeGivesABitwiseEqualRun) {
  const std::vector<std::string> settings = {"Surface/elements per side=3", "Particle/center=[0.1, 0.2, 0.3]", "Time/final time=1"};
  const Evolution none(settings);
  for (const char* same : {"stretch=[1, 1, 1]", "map=[1, 0, 0, 0, 1, 0, 0, 0, 1]"}) {
    std::vector<std::string> shaped = settings;
    shaped.push_back(std::string("Particle/initial shape/") + same);
    const Evolution run(shaped);
    EXPECT_EQ(run.x(), none.x());
    EXPECT_TRUE(run.state.history[0] == none.state.history[0]);
  }
}

TEST(InitialShape, HasTheRestingVolumeUnlessAnotherIsRequested) {
  const std::vector<std::string> shear = at_rest({"Particle/initial shape/map=[1.2, 0, 0.5, 0, 1, 0, 0, 0, 0.7]"});
  Evolution kept(shear);
  const double rest = surface::volume(kept.body().space, kept.body().rest);
  EXPECT_NEAR(surface::volume(kept.body().space, kept.x()) / rest, 1, 1e-14);
  std::vector<std::string> with_own = shear;
  with_own.push_back("Particle/initial shape/volume=own");
  Evolution own(with_own);
  own.to(0.1);
  EXPECT_NEAR(surface::volume(own.body().space, own.x()) / rest, 1.2 * 0.7, 1e-13) << "and keeps it";
}

TEST(InitialShape, DeterminesTheSymmetry) {
  const auto description = [](const char* shape) { return Evolution(at_rest({shape})).body().symmetry.description(); };
  EXPECT_EQ(description("Particle/initial shape/stretch=[1.4, 1, 0.8]"), "mirror x1, mirror x2 and mirror x3");
  EXPECT_EQ(description("Particle/initial shape/map=[1, 0, 0.5, 0, 1, 0, 0, 0, 1]"), "mirror x2 and point symmetry");
}

TEST(InitialShape, ThatIsWrongIsRejected) {
  const auto refusal = [](std::vector<std::string> settings) -> std::string {
    try {
      Evolution run(at_rest(std::move(settings)));
    } catch (const UserError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(refusal({"Particle/initial shape/volume=own"}),
            "Particle/initial shape needs exactly one of the keys stretch, map, file and run.");
  EXPECT_EQ(refusal({"Particle/initial shape/map=[1, 0, 0, 0, 1, 0, 0, 0, -1]"}),
            "Particle/initial shape/map must have a positive determinant, or the surface is turned inside out; it is -1.");
  EXPECT_NE(refusal({"Particle/initial shape/stretch=[1, 0, 1]"}).find("Particle/initial shape/stretch must be"), std::string::npos);
  EXPECT_EQ(refusal({"Particle/initial shape/run=nowhere"}).find("Particle/initial shape/run: "), 0u);
}

}  // namespace
}  // namespace tanktread
