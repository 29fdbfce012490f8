// SIGINT and SIGTERM: exit code 130 within seconds, and no new file.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "tests/cli/program.h"
#include "tests/sanitizers.h"

namespace lightwell::interrupt_test {
namespace {
using namespace std::chrono_literals;

class Interrupted : public testing::TestWithParam<int> {};

TEST_P(Interrupted, SolveStopsWithinAMomentAndLeavesNothing) {
  TemporaryFolder folder;
  folder.write("room.toml", small_room());
  // Without the signal, the solve would take minutes.
  Running running(folder / "", {"solve", "room.toml", "-o", "S.vtp", "--max-patch-size", "0.1",
                                "--rays", "65536"});
  // The first line on standard error ends the phase "mesh"; form factors follow.
  for (int i = 0; i < 600 && running.err().empty(); ++i) std::this_thread::sleep_for(50ms);
  ASSERT_NE(running.err(), "") << "no sign of work after 30 s";

  const auto start = std::chrono::steady_clock::now();
  running.signal(GetParam());
  const Ended ended = running.wait();
  const auto taken = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(ended.code, 130) << ended.err;
  EXPECT_EQ(ended.out, "");
  EXPECT_TRUE(says(ended.err, "interrupted"));
  EXPECT_EQ(folder.file_count(), 1) << "something besides the scene is there";
  // The limit is one second on an idle machine; tests run beside other tests.
  EXPECT_LT(taken, 5s * test::slowdown);
}

TEST_P(Interrupted, RunRemovesTheFolderItMade) {
  TemporaryFolder folder;
  folder.write("room.toml", small_room());
  Running running(folder / "", {"run", "room.toml", "-o", "deep/results", "--max-patch-size", "0.1",
                                "--rays", "65536"});
  for (int i = 0; i < 600 && running.err().empty(); ++i) std::this_thread::sleep_for(50ms);
  running.signal(GetParam());
  EXPECT_EQ(running.wait().code, 130);
  EXPECT_EQ(folder.file_count(), 1);
}

INSTANTIATE_TEST_SUITE_P(By, Interrupted, testing::Values(SIGINT, SIGTERM), [](const auto& each) {
  return each.param == SIGINT ? "SIGINT" : "SIGTERM";
});

}  // namespace
}  // namespace lightwell::interrupt_test
