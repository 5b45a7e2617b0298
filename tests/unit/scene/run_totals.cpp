// Tests that the totals of a run are written to a checkpoint and read from it without change.

#include "scene/series/run_totals.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "deck/document.hpp"

namespace tanktread {
namespace {

TEST(RunTotals, IsRestoredFromACheckpoint) {
  RunTotals totals;
  totals.step = 7;
  totals.wall_seconds = 1. / 3;
  totals.counts = {1, 2, 3, 4, 5, 6, 7, 8};
  totals.refinements = 9;
  totals.coarsenings = 10;
  totals.kernel = {1LL << 40, 12, 13};
  totals.warnings = {0.1, 14, {{"gap", "at time 1 the gap: narrow"}, {"fold", "at time 2 it folds"}}};
  totals.phase_angle = {{370, 0.5}, {-10, 0.25}};
  totals.seconds = {{"far field", 0.5}, {"output", 0.25}};
  output::Checkpoint checkpoint;
  store(totals, checkpoint);
  output::Checkpoint again;
  store(stored_totals(checkpoint), again);
  EXPECT_EQ(again.numbers, checkpoint.numbers);
  EXPECT_EQ(again.texts, checkpoint.texts);
  EXPECT_EQ(again.arrays.at("phase and tank-treading frequency"), checkpoint.arrays.at("phase and tank-treading frequency"));
  EXPECT_EQ(checkpoint.numbers.size(), 15u + 2 + 2);
  EXPECT_EQ(stored_totals(checkpoint).kernel.far, 1LL << 40);
  EXPECT_EQ(stored_totals(checkpoint).warnings.shown.at(1).sentence, "at time 2 it folds");
}

TEST(RunTotals, OfAnotherVersionIsMissing) {
  output::Checkpoint checkpoint;
  store(RunTotals(), checkpoint);
  checkpoint.numbers.erase("tangents");
  EXPECT_THROW(stored_totals(checkpoint), std::out_of_range);
}

/// Returns the warnings of one step with a compression that lets waves grow.
std::vector<Warning> look(Warnings& warnings) {
  StepFindings signs;
  signs.step = 0.1;
  signs.smallest_tension = {-0.2}, signs.compressed_area = {0.5};
  signs.element = 0.1;
  return warnings.of_step(signs);
}

TEST(RunTotals, WarningsContinueAfterResumption) {
  Scene scene;
  deck::Document deck = deck::read({}, {"Membrane/capillary number=0.1"});
  deck.declare(scene);
  Warnings whole(scene);
  int steps = 0;
  while (whole.memory().shown.empty() && steps < 100) look(whole), ++steps;
  ASSERT_GT(steps, 3);
  Warnings first(scene), second(scene);
  for (int k = 1; k < steps; ++k) EXPECT_TRUE(look(first).empty());
  second.remember(first.memory());
  EXPECT_EQ(look(second).size(), 1u);
  Warnings third(scene);
  third.remember(second.memory());
  for (int k = 0; k < steps; ++k) EXPECT_TRUE(look(third).empty());  // the warning was shown already
}

}  // namespace
}  // namespace tanktread
