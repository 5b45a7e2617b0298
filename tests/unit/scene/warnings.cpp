#include "scene/particles/warnings.hpp"

#include <optional>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "deck/document.hpp"

namespace tanktread {
namespace {

struct Told {
  Scene whole;
  std::optional<Warnings> of_run;
  explicit Told(const std::vector<std::string>& settings) {
    deck::Document deck = deck::read({}, settings, "Tanktread: {Time: {final time: 1}}\n");
    deck.declare(whole);
    whole.check();
    of_run.emplace(whole);
  }
  std::string first(const StepFindings& signs) {
    const auto all = of_run->of_step(signs);
    return all.empty() ? std::string() : all.front().sentence;
  }
};

bool names(const std::string& sentence, const char* what) { return sentence.find(what) != std::string::npos; }

StepFindings at(double step, double tension, double element = 0.13) {
  StepFindings signs;
  signs.time = 1;
  signs.step = step;
  signs.smallest_tension = {tension};
  signs.compressed_area = {tension < 0 ? 0.5 : 0};
  signs.element = element;
  return signs;
}

TEST(Warnings, AreNotGivenInANormalRun) {
  Told run({"Membrane/capillary number=0.3"});
  for (int k = 0; k < 100; ++k)
    EXPECT_EQ(run.first(at(0.1, k < 10 ? -0.19 : -0.05)), "");  // tensions at the start and in the steady state of a run
                                                                // that agrees with other methods to five digits
}

TEST(Warnings, ReportOmittedSnapshots) {
  Told often({"Time/fixed step=0.2", "Output/interval=0.1"}), seldom({"Time/fixed step=0.1", "Output/interval=0.1"});
  EXPECT_TRUE(names(first_warnings(often.whole).at(0).sentence, "Output/interval"));
  EXPECT_TRUE(first_warnings(seldom.whole).empty());
}

TEST(Warnings, ReportSurfaceFieldsOfAnEarlierRun) {
  const std::vector<std::string> clean{"Membrane/law=surface tension", "Particle/initial shape/run=."};
  std::vector<std::string> covered = clean;
  covered.emplace_back("Interface/surfactant/elasticity number=0.2");
  EXPECT_TRUE(names(first_warnings(Told(covered).whole).at(0).sentence, "surfactant"));
  EXPECT_TRUE(first_warnings(Told(clean).whole).empty());
}

TEST(Warnings, ReportCompressionWithoutBendingOnce) {
  Told run({"Membrane/capillary number=0.1"});
  for (int k = 0; k < 10; ++k) EXPECT_EQ(run.first(at(0.1, -0.13)), "");  // the waves need time to grow
  for (int k = 0; k < 10; ++k) run.first(at(0.1, -0.13));
  ASSERT_EQ(run.of_run->memory().shown.size(), 1u);
  const std::string sentence = run.of_run->memory().shown.front().sentence;
  EXPECT_TRUE(names(sentence, "Membrane/bending modulus") && names(sentence, "at time 1 ")) << sentence;
  for (int k = 0; k < 50; ++k) EXPECT_EQ(run.first(at(0.1, -0.14)), "");
  EXPECT_EQ(run.of_run->memory().shown.size(), 1u);
}

TEST(Warnings, ReportCompressionOnlyIfTheMeshAndNotBendingDeterminesTheWavelength) {
  Told stiff({"Membrane/capillary number=0.1", "Membrane/bending modulus=0.02"});
  for (int k = 0; k < 50; ++k) EXPECT_EQ(stiff.first(at(0.1, -0.13)), "");  // the fastest wave has k = 4.7, and the mesh resolves k = 24
  Told soft({"Membrane/capillary number=0.1", "Membrane/bending modulus=1e-5"});
  for (int k = 0; k < 50; ++k) soft.first(at(0.1, -0.13));
  EXPECT_TRUE(names(soft.of_run->memory().shown.at(0).sentence, "too little resistance"));
}

TEST(Warnings, ReportCompressionOfAnyOfSeveralParticles) {
  Told run({"Particles/drop/Membrane/law=surface tension", "Particles/stiff/Membrane/bending modulus=0.02", "Particles/stiff/center=[4, 0, 0]",
            "Particles/soft/Membrane/capillary number=0.1", "Particles/soft/center=[-4, 0, 0]"});
  StepFindings signs = at(0.1, 0);
  signs.smallest_tension = {0.9, -0.001, -0.13}, signs.compressed_area = {0, 0.1, 0.4};
  for (int k = 0; k < 20; ++k) run.first(signs);
  ASSERT_EQ(run.of_run->memory().shown.size(), 1u);
  EXPECT_TRUE(names(run.of_run->memory().shown.front().sentence, "40 % of the membrane"));
}

/// Returns the only warning about the choices of a deck, or "" if there is none.
std::string at_start(const std::vector<std::string>& settings) {
  const std::vector<Warning> all = first_warnings(Told(settings).whole);
  EXPECT_LE(all.size(), 1u);
  return all.empty() ? "" : all.front().sentence;
}

// The choices of the second and the third particle cause one warning, too.
TEST(Warnings, ReportChoicesOfAnyParticle) {
  EXPECT_TRUE(names(at_start({"Particles/one/center=[4, 0, 0]", "Particles/two/center=[-4, 0, 0]", "Particles/three/center=[0, 0, 9]",
                              "Particles/two/Membrane/global area dilatation=1e7", "Particles/three/Membrane/global area dilatation=1e7"}),
                    "total area"));
}

TEST(Warnings, ReportAStiffAreaThatLocksTheMesh) {
  const std::string skalak = "Membrane/law=Skalak", evans = "Membrane/law=Evans-Skalak", stiff = "Membrane/area dilatation=1000";
  for (const std::string& law : {skalak, evans})
    for (const char* points : {"0", "4"})
      EXPECT_TRUE(names(at_start({law, stiff, std::string("Membrane/area points=") + points}), "set Membrane/area points to 1")) << law << points;
  EXPECT_EQ(at_start({skalak, stiff, "Membrane/area points=1"}), "");
  EXPECT_EQ(at_start({skalak, "Membrane/area dilatation=10"}), "");
  const std::string energy = "Membrane/energy=(I1^2 + 2*I1 - 2*I2 + c*I2^2)/4", c = "Membrane/constants/c/value=";
  EXPECT_TRUE(names(at_start({"Membrane/law=expression", energy, c + "1000"}), "Evans-Skalak"));
  EXPECT_EQ(at_start({"Membrane/law=expression", energy, c + "1"}), "");
}

TEST(Warnings, ReportAVesicleInAFlow) {
  const std::vector<std::string> vesicle{"Membrane/law=surface tension", "Membrane/surface tension=1", "Membrane/bending modulus=0.1",
                                         "Membrane/global area dilatation=1000"};
  std::vector<std::string> resting = vesicle, drop = vesicle;
  resting.emplace_back("Flow/type=quiescent"), drop.back() = "Particle/viscosity ratio=2";
  EXPECT_TRUE(names(at_start(vesicle), "Membrane/area points to 1"));
  EXPECT_EQ(at_start(resting), "");
  EXPECT_EQ(at_start(drop), "");
}

// The remedy of a compressed membrane: first what makes the mesh fit the membrane, then what changes the membrane.
TEST(Warnings, AdviseAreaPointsOrAFinerMeshBeforeAnotherMembrane) {
  const auto advice = [](const std::vector<std::string>& settings) {
    Told run(settings);
    for (int k = 0; k < 50; ++k) run.first(at(0.1, -2));
    return run.of_run->memory().shown.at(0).sentence;
  };
  const std::string bending = "Membrane/bending modulus=1e-3", skalak = "Membrane/law=Skalak", c = "Membrane/area dilatation=10";
  const std::string locks = advice({skalak, c, bending}), coarse = advice({skalak, c, bending, "Membrane/area points=1"});
  EXPECT_TRUE(names(locks, "Membrane/area points") && !names(locks, "Membrane/bending modulus")) << locks;
  EXPECT_LT(coarse.find("set a finer mesh"), coarse.find("Membrane/bending modulus")) << coarse;
  EXPECT_NE(coarse.find("Membrane/bending modulus"), std::string::npos);
}

TEST(Warnings, ReportAFixedStepBeyondTheStabilityLimit) {
  Told run({"Time/scheme=bs3", "Time/fixed step=0.2"});  // rho is 80 on these elements at Ca = 0.3
  EXPECT_TRUE(names(run.first(at(0.2, 0)), "Time/scheme"));
  Told implicit({"Time/scheme=tr-bdf2", "Time/fixed step=0.2"});
  EXPECT_EQ(implicit.first(at(0.2, 0)), "");
}

TEST(Warnings, ReportStepsLimitedByStability) {
  Told run({"Time/scheme=bs3"});
  for (int k = 0; k < 9; ++k) EXPECT_EQ(run.first(at(0.03, 0)), "");
  EXPECT_TRUE(names(run.first(at(0.03, 0)), "Time/tolerance"));
}

TEST(Warnings, ReportAFoldedElementWithAdviceForTheScene) {
  StepFindings signs = at(0.1, 0);
  signs.jacobian_ratio = 0.01;
  EXPECT_TRUE(names(Told({"Flow/type=simple shear"}).first(signs), "Adaptation/enabled"));
  EXPECT_TRUE(names(Told({"Membrane/law=surface tension", "Interface/motion=material"}).first(signs), "Interface/motion"));
}

TEST(Warnings, ReportADropThatTheFlowMayElongateWithoutLimit) {
  StepFindings signs = at(0.1, 0);
  signs.jacobian_ratio = 0.01;
  EXPECT_TRUE(names(Told({"Flow/type=uniaxial extension", "Membrane/law=surface tension"}).first(signs), "no steady shape"));
  EXPECT_FALSE(names(Told({"Flow/type=uniaxial extension"}).first(signs), "no steady shape"));
}

TEST(Warnings, ReportVolumeErrorsGapsAndSlenderElements) {
  StepFindings lost = at(0.1, 0), slim = lost, narrow = lost, sharp = lost;
  sharp.tilt = 0.75;
  lost.volume_error = -0.01;
  slim.aspect_ratio = 12;
  narrow.gap = 0.02;
  EXPECT_TRUE(names(Told({"Volume/constraint=flux"}).first(lost), "Volume/constraint"));
  EXPECT_TRUE(names(Told({"Flow/type=simple shear"}).first(slim), "Adaptation/enabled"));
  EXPECT_TRUE(names(Told({"Flow/type=simple shear"}).first(sharp), "turns by 86 degrees"));
  EXPECT_TRUE(names(Told({"Flow/type=simple shear"}).first(narrow), "gap"));
}

TEST(Warnings, ReportChoicesThatAreKnownToFailAtTheStart) {
  EXPECT_TRUE(names(at_start({"Membrane/load=strong"}), "Membrane/load"));
  EXPECT_TRUE(names(at_start({"Surface/mesh=polar", "Surface/poles=plain", "Quadrature/rule=fixed"}), "poles"));
}

TEST(Soundness, EndsARunWithAFoldedElement) {
  Scene scene;
  deck::Document deck = deck::read({}, {"Surface/elements per side=4"});
  deck.declare(scene);
  const Body sphere = make_body(scene.first());
  const surface::BezierMap map(sphere.space);
  const coupling::Ranks ranks;
  EXPECT_GT(soundness(map, sphere.rest, ranks).jacobian_ratio, 0.4);
  Net folded = sphere.rest;
  const std::vector<int>& points = sphere.space.elements[14].points;
  folded.row(points[5]) += 3 * (folded.row(points[6]) - folded.row(points[5]));  // control point moved past its neighbour
  EXPECT_THROW(soundness(map, folded, ranks), RunFailure);
}

}  // namespace
}  // namespace tanktread
