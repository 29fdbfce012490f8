#include "scene/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace lightwell::parallel_test {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceInPiecesOfAtMostOneGrain) {
  for (int count : {0, 1, 7, 64, 1000}) {
    for (int grain : {1, 3, 64, 5000}) {
      std::vector<std::atomic<int>> visits(static_cast<std::size_t>(count));
      std::atomic<bool> too_large{false};
      parallel_for(count, grain, [&](int begin, int end) {
        if (end - begin > grain || begin % grain != 0) too_large = true;
        for (int i = begin; i < end; ++i) ++visits[static_cast<std::size_t>(i)];
      });
      EXPECT_FALSE(too_large);
      for (const auto& v : visits) ASSERT_EQ(v, 1) << count << ", " << grain;
    }
  }
}

TEST(ParallelFor, AGrainBelowOneIsOne) {
  std::atomic<int> visits{0};
  parallel_for(10, 0, [&](int begin, int end) { visits += end - begin; });
  EXPECT_EQ(visits, 10);
}

TEST(ParallelFor, RethrowsWhatABodyThrows) {
  const auto work = [](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      if (i == 333) throw std::out_of_range("index 333");
    }
  };
  try {
    parallel_for(1000, 10, work);
    FAIL() << "nothing was thrown";
  } catch (const std::out_of_range& error) {
    EXPECT_STREQ(error.what(), "index 333");
  }
}

TEST(ParallelFor, NestedLoopsFinish) {
  std::atomic<int> sum{0};
  parallel_for(20, 1, [&](int, int) {
    parallel_for(20, 1, [&](int begin, int end) { sum += end - begin; });
  });
  EXPECT_EQ(sum, 400);
}

TEST(ThreadLimit, HoldsWhileItLives) {
  const int before = thread_count();
  {
    const ThreadLimit one(1);
    EXPECT_EQ(thread_count(), 1);
    std::atomic<int> inside{0}, most{0};
    parallel_for(200, 1, [&](int, int) {
      const int now = ++inside;
      int seen = most;
      while (now > seen && !most.compare_exchange_weak(seen, now)) {
      }
      --inside;
    });
    EXPECT_EQ(most, 1);
  }
  EXPECT_EQ(thread_count(), before);
}

}  // namespace
}  // namespace lightwell::parallel_test
