#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "accuracy/ladder.hpp"
#include "accuracy/levels.hpp"
#include "base/errors.hpp"

namespace tanktread::accuracy {
namespace {

const Values plain{{"Surface/mesh", "cube"}, {"Surface/elements per side", "6"}, {"Time/tolerance", "1e-4"}, {"Quadrature/rule", "adaptive"},
                   {"Solvers/tolerance", "1e-8"}};

bool sets(const Values& deck, const Level& level, const std::string& setting) {
  const std::vector<std::string> all = settings(deck, level);
  return std::ranges::find(all, setting) != all.end();
}

Values with(Values deck, const Values& more) {
  for (const auto& [path, value] : more) deck[path] = value;
  return deck;
}

TEST(Levels, RefineMeshAndTolerancesTogether) {
  EXPECT_TRUE(sets(plain, {0, 0, 0}, "Surface/elements per side=3"));
  EXPECT_TRUE(sets(plain, {0, 0, 0}, "Time/tolerance=0.002"));
  EXPECT_TRUE(sets(plain, {5, 5, 5}, "Surface/elements per side=12"));
  EXPECT_TRUE(sets(plain, {1, 1, 1}, "Quadrature/tolerance=5e-04"));
  EXPECT_TRUE(sets(plain, {9, 9, 9}, "Quadrature/tolerance=1e-06"));
  EXPECT_FALSE(sets(plain, {0, 0, 0}, "Solvers/tolerance=1e-08"));  // tight enough
}

TEST(Levels, SearchesForSteadyShapesAreAsAccurateAsTheLevelExceptOnBranches) {
  const Values search = with(plain, {{"Steady/tolerance", "1e-8"}}), branch = with(search, {{"Continuation/to", "0.1"}});
  EXPECT_TRUE(sets(search, {0, 0, 0}, "Steady/tolerance=2e-05"));
  EXPECT_TRUE(sets(search, {4, 4, 2}, "Steady/tolerance=1.25e-06"));  // the quadrature of level 2 allows no smaller corrections
  EXPECT_TRUE(sets(search, {9, 9, 9}, "Steady/tolerance=1e-08"));
  for (const std::string& setting : settings(branch, {0, 0, 0})) EXPECT_FALSE(setting.starts_with("Steady/"));  // tight enough
  EXPECT_TRUE(sets(branch, {7, 7, 7}, "Steady/tolerance=1.220703125e-09"));
}

TEST(Levels, AreExpectedToHaveTheErrorsOfTheirMeshes) {
  EXPECT_DOUBLE_EQ(expected_error({}), 1);
  EXPECT_NEAR(expected_error({5, 3, 7}), std::pow(4, -4.25), 1e-15);  // twelve elements per side instead of three
}

TEST(Levels, ChangeOnePartOnly) {
  EXPECT_TRUE(sets(plain, {1, 3, 1}, "Surface/elements per side=4"));
  EXPECT_TRUE(sets(plain, {1, 3, 1}, "Time/tolerance=3.125e-05"));
  EXPECT_TRUE(sets(plain, {1, 3, 1}, "Quadrature/tolerance=5e-04"));
}

TEST(Levels, DifferInOnePartToMeasureItsError) {
  EXPECT_EQ(same_but_looser(2, &Level::time), (Level{2, 1, 2}));
  EXPECT_EQ(same_but_looser(2, &Level::quadrature), (Level{2, 2, 1}));
}

TEST(Levels, KeepTheRatiosOfSeveralMeshes) {
  const Values deck{{"Particles/a/Surface/mesh", "cube"},       {"Particles/a/Surface/elements per side", "12"},
                    {"Particles/b/Surface/mesh", "cube"},       {"Particles/b/Surface/elements per side", "6"},
                    {"Quadrature/rule", "adaptive"}};
  EXPECT_TRUE(sets(deck, {4, 4, 4}, "Particles/a/Surface/elements per side=18"));
  EXPECT_TRUE(sets(deck, {4, 4, 4}, "Particles/b/Surface/elements per side=9"));
  EXPECT_TRUE(sets(deck, {0, 0, 0}, "Particles/b/Surface/elements per side=3"));
}

TEST(Levels, RefineEveryMeshFromEachLevelToTheNext) {
  Values deck{{"Quadrature/rule", "adaptive"}};
  const std::vector<std::string> keys{"Particles/a/Surface/elements per side", "Particles/b/Surface/elements per side", "Tube/azimuthal elements",
                                      "Tube/axial elements", "Wall/elements per period", "Particles/post/Surface/axial elements"};
  for (const std::string& key : keys) deck[key] = "4";
  deck["Particles/a/Surface/elements per side"] = "12", deck["Tube/azimuthal elements"] = deck["Tube/axial elements"] = "8";
  deck["Particles/post/shape"] = "cylinder";
  std::map<std::string, double> before;
  for (int k = 0; k < 6; ++k)
    for (const std::string& one : settings(deck, {k, k, k}))
      for (const std::string& key : keys)
        if (one.starts_with(key + "=")) {
          const double value = std::stod(one.substr(key.size() + 1));
          EXPECT_GT(value, before[key]) << one << " at level " << k;
          before[key] = value;
        }
  EXPECT_EQ(before.size(), keys.size());
}

TEST(Levels, RefinePolarMeshes) {
  const Values deck{{"Surface/mesh", "polar"}, {"Surface/azimuthal elements", "32"}, {"Surface/meridional elements", "16"}};
  EXPECT_TRUE(sets(deck, {5, 5, 5}, "Surface/meridional elements=24"));
  EXPECT_TRUE(sets(deck, {5, 5, 5}, "Surface/azimuthal elements=48"));
}

TEST(Levels, ScaleTheTolerancesOfAdaptiveMeshesAsTheErrorOfAMesh) {
  const Values deck = with(plain, {{"Adaptation/enabled", "true"}, {"Adaptation/surface tolerance", "4e-4"}});
  EXPECT_TRUE(sets(deck, {5, 5, 5}, "Adaptation/surface tolerance=2.5e-05"));
  EXPECT_FALSE(sets(plain, {5, 5, 5}, "Adaptation/surface tolerance=2.5e-05"));
}

TEST(Levels, ScaleTheResolutionOfFilmsThatTheDeckDoesNotGive) {
  const Values adaptive = with(plain, {{"Adaptation/enabled", "true"}}), in_tube = with(adaptive, {{"Tube/section", "circle"}});
  EXPECT_TRUE(sets(in_tube, {5, 5, 5}, "Adaptation/film resolution=0.35"));
  EXPECT_TRUE(sets(with(in_tube, {{"Adaptation/film resolution", "0.5"}}), {5, 5, 5}, "Adaptation/film resolution=0.25"));
  const std::vector<std::string> unbounded = settings(adaptive, {5, 5, 5});
  EXPECT_TRUE(std::ranges::none_of(unbounded, [](const std::string& one) { return one.starts_with("Adaptation/film resolution"); }));
}

TEST(Levels, RefineWalls) {
  const Values deck = with(plain, {{"Tube/azimuthal elements", "24"}});
  EXPECT_TRUE(sets(deck, {5, 5, 5}, "Tube/azimuthal elements=48"));
}

TEST(Levels, RefinePlatesAndPosts) {
  const Values posts = with(plain, {{"Wall/elements per period", "12"},
                                    {"Particles/post/shape", "cylinder"},
                                    {"Particles/post/Surface/axial elements", "8"},
                                    {"Particles/ball/shape", "sphere"}});
  for (const char* finer : {"Wall/elements per period=24", "Particles/post/Surface/azimuthal elements=48", "Particles/post/Surface/axial elements=16",
                            "Particles/ball/Surface/elements per side=12"})
    EXPECT_TRUE(sets(posts, {5, 5, 5}, finer)) << finer;
  EXPECT_FALSE(sets(posts, {5, 5, 5}, "Particles/post/Surface/elements per side=12"));
  EXPECT_TRUE(sets(with(posts, {{"Wall/elements per period", "10"}}), {1, 1, 1}, "Wall/elements per period=7"));  // a whole number
  EXPECT_TRUE(sets(with(posts, {{"Wall/elements per period", "6"}}), {0, 0, 0}, "Wall/elements per period=4"));   // the smallest that the key allows
  EXPECT_THROW(check_levels(with(plain, {{"Wall/normal", "[0, 0, 1]"}, {"Domain/side lengths", "[4, 4, 4]"}})), UserError);  // default not known
}

TEST(Levels, HalveFixedSteps) {
  const Values deck = with(plain, {{"Time/fixed step", "0.01"}});
  EXPECT_TRUE(sets(deck, {3, 3, 3}, "Time/fixed step=0.005"));
  EXPECT_FALSE(sets(deck, {3, 3, 3}, "Time/tolerance=3.125e-05"));
}

TEST(Levels, RejectShapesOfOneMesh) {
  EXPECT_NO_THROW(check_levels(plain));
  for (const char* key : {"Particle/initial shape/run", "Membrane/stress-free file", "Particles/one/initial shape/file",
                          "Particles/one/Membrane/stress-free file"})
    EXPECT_THROW(check_levels(with(plain, {{key, "results/a"}})), UserError) << key;
}

TEST(Levels, AreBalancedByTheSharesOfTheirParts) {
  EXPECT_EQ(balanced(2, 0.25, 0.25), (Level{2, 2, 2}));
  EXPECT_EQ(balanced(3, 0, 0), (Level{3, 2, 2}));  // no looser than level 2
  EXPECT_EQ(balanced(4, 0.03, 0.03), (Level{4, 3, 3}));
  EXPECT_EQ(balanced(4, 0, 1e-6), (Level{4, 2, 2}));
  EXPECT_EQ(balanced(4, 1, 1), (Level{4, 6, 5}));  // per level, the time error falls more slowly than the mesh error
}

TEST(Levels, LeaveOutASectionOfADeck) {
  const std::string deck = "Tanktread:\n  Flow:\n    type: duct\n  Expect:\n    a:\n      value: 1\n  Output:\n    interval: 1\n";
  EXPECT_EQ(without_section(deck, "Expect"), "Tanktread:\n  Flow:\n    type: duct\n  Output:\n    interval: 1\n");
}

TEST(Ladder, PredictsTheNextLevelFromTheGrowth) {
  EXPECT_DOUBLE_EQ(predicted_seconds({}), 0);
  EXPECT_DOUBLE_EQ(predicted_seconds({2}), 5);
  EXPECT_DOUBLE_EQ(predicted_seconds({2, 6}), 18);
  EXPECT_DOUBLE_EQ(predicted_seconds({1, 100}), 500);  // limited growth
}

}  // namespace
}  // namespace tanktread::accuracy
