// What a run has done, in a checkpoint and out of it.

#include "app/standing.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "app/series.hpp"
#include "deck/document.hpp"

namespace tanktread {
namespace {

TEST(Standing, ComesBackFromACheckpoint) {
  Standing standing;
  standing.step = 7;
  standing.wall_seconds = 1. / 3;
  standing.work = {1, 2, 3, 4, 5, 6, 7, 8};
  standing.refinements = 9;
  standing.coarsenings = 10;
  standing.kernel = {1LL << 40, 12, 13};
  standing.warnings = {0.1, 14, {{"gap", "at time 1 the gap: narrow"}, {"fold", "at time 2 it folds"}}};
  standing.turning = {{370, 0.5}, {-10, 0.25}};
  standing.seconds = {{"far field", 0.5}, {"output", 0.25}};
  output::Checkpoint checkpoint;
  store(standing, checkpoint);
  output::Checkpoint again;
  store(stored_standing(checkpoint), again);
  EXPECT_EQ(again.numbers, checkpoint.numbers);
  EXPECT_EQ(again.texts, checkpoint.texts);
  EXPECT_EQ(again.arrays.at("phase and tank-treading frequency"), checkpoint.arrays.at("phase and tank-treading frequency"));
  EXPECT_EQ(checkpoint.numbers.size(), 15u + 2 + 2);
  EXPECT_EQ(stored_standing(checkpoint).kernel.far, 1LL << 40);
  EXPECT_EQ(stored_standing(checkpoint).warnings.said.at(1).sentence, "at time 2 it folds");
}

TEST(Standing, OfAnotherVersionIsLacking) {
  output::Checkpoint checkpoint;
  store(Standing(), checkpoint);
  checkpoint.numbers.erase("tangents");
  EXPECT_THROW(stored_standing(checkpoint), std::out_of_range);
}

/// Compression that lets waves grow, a step at a time.
std::vector<std::string> look(Warnings& warnings) {
  Signs signs;
  signs.step = 0.1;
  signs.smallest_tension = -0.2;
  signs.element = 0.1;
  return warnings.look(signs);
}

TEST(Standing, WarningsGoOnWhereTheyWere) {
  Scene scene;
  deck::Document deck = deck::read({}, {"Membrane/capillary number=0.1"});
  deck.declare(scene);
  Warnings whole(scene);
  int steps = 0;
  while (whole.memory().said.empty() && steps < 100) look(whole), ++steps;
  ASSERT_GT(steps, 3);
  Warnings first(scene), second(scene);
  for (int k = 1; k < steps; ++k) EXPECT_TRUE(look(first).empty());
  second.remember(first.memory());
  EXPECT_EQ(look(second).size(), 1u);
  Warnings third(scene);
  third.remember(second.memory());
  for (int k = 0; k < steps; ++k) EXPECT_TRUE(look(third).empty());  // it is said already
}

TEST(Series, AnUnknownNameIsAnError) {
  const std::vector<Series>& all = all_series();
  const std::vector<double> row(all.size(), 2.5);
  EXPECT_EQ(entry(all, row, "area"), 2.5);
  EXPECT_THROW(entry(all, row, "taylor"), std::out_of_range);
}

}  // namespace
}  // namespace tanktread
