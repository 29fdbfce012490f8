// Laws of shared work: every piece is computed once, and all processes have all results.
#include "radiosity/processes/processes.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <numeric>

#include "scene/errors.h"
#include "scene/parallel.h"
#include "tests/radiosity/processes/local_ports.h"
#include "tests/temporary_folder.h"

namespace lightwell::processes_test {
namespace {
using local_ports::Ends;
using local_ports::run_processes;

Ends nothing_wrong(int size) {
  return Ends(static_cast<std::size_t>(size));
}

Bytes packed(int value) {
  Bytes bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}
int unpacked(const Bytes& bytes) {
  int value = 0;
  EXPECT_EQ(bytes.size(), sizeof value);
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

// Sizes of the run and of the work, and whether pieces run once at a time.
class Shared : public testing::TestWithParam<std::tuple<int, int, int, bool>> {};

TEST_P(Shared, EachPieceIsComputedOnceAndKnownToAll) {
  const auto [size, count, grain, uses_all_threads] = GetParam();
  std::vector<std::atomic<int>> computed(static_cast<std::size_t>(count));
  std::atomic<int> known = 0;
  const auto program = [&, n = count, g = grain, all = uses_all_threads](Processes& processes) {
    constexpr int rounds = 3;
    for (int round = 0; round < rounds; ++round) {
      std::vector<std::atomic<int>> found(static_cast<std::size_t>(n));
      SharedWork work{.fingerprint = 5, .count = n, .grain = g, .uses_all_threads = all};
      work.compute = [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
          ++computed[static_cast<std::size_t>(i)];
          found[static_cast<std::size_t>(i)] += i + 1;
        }
        return packed(begin * n + end);
      };
      work.take = [&](int begin, int end, const Bytes& results) {
        EXPECT_EQ(unpacked(results), begin * n + end);
        for (int i = begin; i < end; ++i) found[static_cast<std::size_t>(i)] += i + 1;
      };
      processes.share(work);
      for (int i = 0; i < n; ++i) known += found[static_cast<std::size_t>(i)] == i + 1 ? 1 : 0;
    }
  };
  EXPECT_EQ(run_processes(size, program), nothing_wrong(size));
  EXPECT_EQ(known, 3 * size * count);
  for (const auto& times : computed) EXPECT_EQ(times, 3);
}

INSTANTIATE_TEST_SUITE_P(Work, Shared,
                         testing::Combine(testing::Values(1, 2, 3, 7),
                                          testing::Values(0, 1, 5, 100), testing::Values(1, 8),
                                          testing::Bool()));

// A process that is busy with its first piece until all other pieces are done computes no second
// one: the others take its share.
TEST(Processes, ASlowProcessHoldsNobodyUp) {
  constexpr int size = 3, count = 60;
  std::atomic<int> done = 0;
  std::array<std::atomic<int>, size> by{};
  const auto program = [&](Processes& processes) {
    SharedWork work{.count = count, .uses_all_threads = true};
    work.compute = [&](int, int) {
      constexpr int slow = 1, most_looks = 60000;
      ++by[static_cast<std::size_t>(processes.rank())];
      for (int look = 0; processes.rank() == slow && done < count - 1; ++look) {
        if (look > most_looks) throw std::runtime_error("the others wait for the slow process");
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      ++done;
      return Bytes();
    };
    work.take = [](int, int, const Bytes&) {};
    processes.share(work);
  };
  EXPECT_EQ(run_processes(size, program), nothing_wrong(size));
  // It may come to the round when no piece is left.
  EXPECT_LE(by[1], 1);
  EXPECT_EQ(by[0] + by[1] + by[2], count);
}

TEST(Processes, PiecesOfACheckpointStayWithTheFirst) {
  constexpr int size = 3, count = 50;
  std::atomic<int> kept_elsewhere = 0, total = 0;
  const auto program = [&](Processes& processes) {
    SharedWork work{.count = count};
    const auto is_kept = [](int begin, int) { return begin % 3 == 0; };
    work.is_kept = is_kept;
    work.compute = [&](int begin, int end) {
      if (!processes.is_first() && is_kept(begin, end)) ++kept_elsewhere;
      ++total;
      return Bytes();
    };
    work.take = [](int, int, const Bytes&) {};
    processes.share(work);
  };
  EXPECT_EQ(run_processes(size, program), nothing_wrong(size));
  EXPECT_EQ(kept_elsewhere, 0);
  EXPECT_EQ(total, count);
}

TEST(Processes, TheFirstKnowsTheLeastAndTellsAll) {
  constexpr int size = 4;
  const auto program = [&](Processes& processes) {
    const int rank = processes.rank();
    EXPECT_EQ(processes.least((rank - 2) * (rank - 2)), 0);
    EXPECT_EQ(processes.least(-(std::int64_t{1} << 40) * rank), -3 * (std::int64_t{1} << 40));
    EXPECT_EQ(unpacked(processes.from_first(packed(rank + 7))), 7);
    const auto texts = processes.gather(std::to_string(rank));
    EXPECT_EQ(texts.size(), processes.is_first() ? 4u : 0u);
    for (std::size_t r = 0; r < texts.size(); ++r) EXPECT_EQ(texts[r], std::to_string(r));
    processes.require_same("the scene", "a");
  };
  EXPECT_EQ(run_processes(size, program), nothing_wrong(size));
}

TEST(Processes, OtherInputIsNamedWithItsProcesses) {
  const Ends ends = run_processes(4, [](Processes& processes) {
    processes.require_same("the scene", processes.rank() % 2 == 1 ? "b" : "a");
  });
  EXPECT_TRUE(says(ends[0], "the scene of processes 1 and 3 is not that of process 0")) << ends[0];
  EXPECT_TRUE(says(ends[0], "'b' instead of 'a'"));
}

// Work with `compute` in three processes.
Ends ends_of(const std::function<void(int rank, int piece)>& compute,
             const std::function<void(int finished)>& progress = {}) {
  return run_processes(3, [&](Processes& processes) {
    SharedWork work{.count = 300};
    if (processes.is_first()) work.progress = progress;
    work.compute = [&](int begin, int) {
      compute(processes.rank(), begin);
      return Bytes();
    };
    work.take = [](int, int, const Bytes&) {};
    processes.share(work);
    processes.from_first({});  // where processes learn what has happened after their last piece
  });
}

TEST(Processes, WhyOneFailedIsSaidByTheFirst) {
  // Process 0 waits, so that process 2 has a piece.
  std::atomic<bool> has_failed = false;
  const Ends ends = ends_of([&](int rank, int) {
    if (rank == 2) {
      has_failed = true;
      throw std::runtime_error("the disk is full");
    }
    for (int look = 0; !has_failed && look < 10000; ++look) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  EXPECT_TRUE(says(ends[0], "process 2: the disk is full (on ")) << ends[0];
  EXPECT_EQ(ends[1], "dismissed");
  EXPECT_EQ(ends[2], "the disk is full");
}

TEST(Processes, AStopOfTheFirstEndsAll) {
  std::atomic<bool> is_stopped = false;
  const auto compute = [&](int, int) {
    for (int look = 0; !is_stopped && look < 10000; ++look) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  const Ends ends = ends_of(compute, [&](int) {
    is_stopped = true;
    throw Interrupted();
  });
  EXPECT_EQ(ends, Ends({"interrupted", "dismissed", "dismissed"}));
}

TEST(Processes, OtherWorkIsFoundOut) {
  const Ends ends = run_processes(2, [](Processes& processes) {
    SharedWork work{.fingerprint = 1u + static_cast<unsigned>(processes.rank()), .count = 10};
    work.compute = [](int, int) { return Bytes(); };
    work.take = [](int, int, const Bytes&) {};
    processes.share(work);
  });
  EXPECT_TRUE(says(ends[0], "process 1 does other work than process 0")) << ends[0];
  EXPECT_EQ(ends[1], "dismissed");
}

TEST(Processes, TrafficCountsTheBytesOfResults) {
  constexpr int size = 3, count = 90;
  constexpr std::size_t bytes = 1000;
  std::array<Traffic, size> traffic{};
  const auto program = [&](Processes& processes) {
    SharedWork work{.count = count};
    work.compute = [](int, int) { return Bytes(bytes); };
    work.take = [](int, int, const Bytes&) {};
    processes.share(work);
    traffic[static_cast<std::size_t>(processes.rank())] = processes.traffic();
  };
  EXPECT_EQ(run_processes(size, program), nothing_wrong(size));
  std::int64_t pieces = 0, sent = 0;
  for (const Traffic& each : traffic) {
    pieces += each.pieces;
    sent += each.sent;
    EXPECT_EQ(each.rounds, 1);
  }
  EXPECT_EQ(pieces, count);
  // Each result goes to two others, with a number of 4 bytes. A piece takes a request of 16 bytes
  // and an answer of 4 at most; two pieces per thread and process more may be asked for in vain.
  const std::int64_t results = count * (size - 1) * static_cast<std::int64_t>(bytes + 4);
  EXPECT_GE(sent, results);
  EXPECT_LE(sent, results + 20 * (count + 2 * size * thread_count()));
}

}  // namespace
}  // namespace lightwell::processes_test
