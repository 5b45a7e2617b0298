#include "record/files/progress.hpp"

#include <gtest/gtest.h>

#include "scratch.hpp"

namespace tanktread::output {
namespace {

TEST(Progress, ALineContainsTimeStepIterationsDeformationAndTimeLeft) {
  EXPECT_EQ(progress_line({3, 24, 9, 0.39871}, 0, 7.5, 12, 20),
            "[########------------]  40 %  t 3/7.5  step 24  9 iterations  D 0.3987  18 s left");
  EXPECT_EQ(progress_line({7.5, 60, 1, 0.4}, 0, 7.5, 12, 0), "100 %  t 7.5/7.5  step 60  1 iteration  D 0.4000");
}

TEST(Progress, AResumedRunCountsFromItsResumption) {
  EXPECT_NE(progress_line({6, 1, 1, 0}, 5, 7, 10, 0).find(" 50 %"), std::string::npos);
  EXPECT_NE(progress_line({6, 1, 1, 0}, 5, 7, 10, 0).find("10 s left"), std::string::npos);
}

/// Returns the text that a run of many short steps writes to a file.
std::string said(bool quiet) {
  const Scratch scratch;
  std::FILE* file = std::fopen((scratch / "log").c_str(), "w");
  {
    Progress progress(0, 1, quiet, file);
    for (int k = 1; k <= 1000; ++k) progress.show({k / 1000., k, 3, 0.1});
  }
  std::fclose(file);
  return contents(scratch / "log");
}

TEST(Progress, WithoutATerminalAShortRunIsOnePlainLine) { EXPECT_EQ(said(false), "100 %  t 1/1  step 1000  3 iterations  D 0.1000\n"); }

TEST(Progress, QuietIsSilent) { EXPECT_EQ(said(true), ""); }

TEST(ClosingTable, NamesEveryPhaseAndCount) {
  Phases phases;
  { const auto scope = phases.time("far field"); }
  const std::string table = closing_table(phases, {{"velocity evaluations", 123}}, "results/shear");
  for (const char* word : {"far field", "velocity evaluations", "123", "total", "results/shear"})
    EXPECT_NE(table.find(word), std::string::npos) << word;
}

}  // namespace
}  // namespace tanktread::output
