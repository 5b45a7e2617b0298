#include "base/timing.hpp"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace tanktread {
namespace {

void work(int milliseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds)); }

TEST(Phases, AnInnerScopePausesTheOuterOne) {
  Phases phases;
  const auto begin = std::chrono::steady_clock::now();
  {
    const auto step = phases.time("step");
    work(2);
    const auto solve = phases.time("solve");
    work(20);
  }
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_GE(phases.seconds("step"), 0.002);
  EXPECT_GE(phases.seconds("solve"), 0.020);
  EXPECT_LE(phases.total(), elapsed);  // the total would be 20 ms larger than the elapsed time if the inner phase were counted twice
}

TEST(Phases, CountsCallsAndKeepsTheOrderOfFirstEntry) {
  Phases phases;
  for (int k = 0; k < 3; ++k) {
    const auto a = phases.time("b comes first");
    const auto b = phases.time("a comes second");
  }
  ASSERT_EQ(phases.all().size(), 2u);
  EXPECT_EQ(phases.all()[0].name, "b comes first");
  EXPECT_EQ(phases.all()[1].calls, 3);
}

TEST(Phases, AScopeMayStartAtAnEarlierTime) {
  Phases phases;
  const auto begin = Phases::Clock::now();
  work(20);
  {
    const Phases::Scope scope(phases, "set-up", begin);
    const auto inner = phases.time("inner");
  }
  const double elapsed = std::chrono::duration<double>(Phases::Clock::now() - begin).count();
  EXPECT_GE(phases.seconds("set-up"), 0.020);
  EXPECT_LE(phases.total(), elapsed);
  EXPECT_GE(started().seconds("start"), elapsed);
}

TEST(Phases, APhaseThatNeverRanHasNoSeconds) { EXPECT_EQ(Phases().seconds("absent"), 0); }

TEST(Phases, SecondsOutsideEveryScopeAreNotCounted) {
  Phases phases;
  { const auto a = phases.time("a"); }
  work(20);
  { const auto a = phases.time("a"); }
  EXPECT_LT(phases.seconds("a"), 0.020);
}

}  // namespace
}  // namespace tanktread
