#include "base/threads.hpp"

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "base/stop.hpp"

namespace tanktread {
namespace threads_test {

/// Sets a number of threads during the lifetime of this object.
class Threads {
 public:
  explicit Threads(int n) { set_threads(n); }
  ~Threads() { set_threads(before_); }

 private:
  int before_ = n_threads();
};

/// Takes so long that a loop over some of these items uses all threads.
void work() {
  const auto begin = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - begin < std::chrono::microseconds(50)) continue;
}

TEST(Threads, EveryItemIsDoneOnce) {
  for (const int n : {1, 2, 5}) {
    const Threads threads(n);
    for (const int items : {0, 1, 2, 100}) {
      std::vector<int> done(static_cast<std::size_t>(items), 0);
      for (int repeat = 0; repeat < 5; ++repeat)
        each_item(items, [&](int i) {
          work();
          ++done[static_cast<std::size_t>(i)];
        });
      EXPECT_EQ(done, std::vector<int>(done.size(), 5)) << n;
    }
  }
}

TEST(Threads, BlocksDoNotDependOnTheirNumber) {
  std::vector<std::vector<int>> sizes;
  for (const int n : {1, 3}) {
    const Threads threads(n);
    std::vector<int>& mine = sizes.emplace_back(7, 0);
    each_block(100, 16, [&](int first, int last) { mine[static_cast<std::size_t>(first / 16)] = last - first; });
  }
  EXPECT_EQ(sizes[0], (std::vector<int>{16, 16, 16, 16, 16, 16, 4}));
  EXPECT_EQ(sizes[1], sizes[0]);
}

TEST(Threads, SeveralWorkAtTheSameTime) {
  const Threads threads(2);
  std::atomic<int> inside = 0;
  for (const bool together : {false, true})  // the first loop shows that the items take long
    each_item(4, [&](int) {
      work();
      ++inside;
      while (together && inside < 6) continue;  // the second loop ends only if two items are begun at the same time
    });
}

TEST(Threads, TheFailureOfTheLowestItemIsThrown) {
  const Threads threads(3);
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::vector<int> done(64, 0);
    try {
      each_item(64, [&](int i) {
        work();
        if (i % 10 == 7) throw std::runtime_error(std::to_string(i));
        if (i == 63) throw std::bad_alloc();
        done[static_cast<std::size_t>(i)] = 1;
      });
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "7");
      EXPECT_EQ(std::accumulate(done.begin(), done.begin() + 7, 0), 7);  // as on one thread, the items before it are done
    }
  }
  each_item(64, [](int) {});  // later loops run
}

TEST(Threads, ALoopInALoopRunsOnItsThread) {
  const Threads threads(2);
  PerThread<int> count;
  each_item(8, [&](int) {
    work();
    const int mine = thread_number();
    each_item(8, [&](int) {
      EXPECT_EQ(thread_number(), mine);
      ++count.mine();
    });
  });
  EXPECT_EQ(count.sum(), 64);
}

TEST(Threads, OnlyTheCallingThreadMakesCallsThatDemandIt) {
  const Threads threads(2);
  PerThread<int> count;
  const auto counted = [&](int) {
    work();
    ++count.mine();
  };
  each_item(100, counted, false);
  EXPECT_EQ(count.mine(), 100);
}

TEST(Threads, TheThreadThatStartsALoopAnswersAStop) {
  const Threads threads(2);
  set_stop_request([] { return thread_number() == 0; });
  EXPECT_THROW(each_item(1000, [](int) { work(), stop_here(); }), Stopped);
  set_stop_request({});
}

}  // namespace threads_test
}  // namespace tanktread
