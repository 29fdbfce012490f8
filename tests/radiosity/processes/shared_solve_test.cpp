// A solve whose work several processes share has the bits of a solve by one.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <random>

#include "radiosity/journal/journal.h"
#include "scene/errors.h"
#include "tests/radiosity/journal/quick_solves.h"
#include "tests/radiosity/processes/local_ports.h"
#include "tests/temporary_folder.h"

namespace lightwell::shared_solve_test {
namespace {
using local_ports::Ends;
using local_ports::run_processes;
using quick_solves::Case;
using quick_solves::cases;
using quick_solves::expect_same_solve;
using quick_solves::quick;
using quick_solves::room;

class SharedSolve : public testing::TestWithParam<Case> {
 protected:
  Scene scene = room(GetParam().with_specular);
  SolveOptions options() const {
    SolveOptions options = quick();
    GetParam().set(options);
    return options;
  }
};

TEST_P(SharedSolve, HasTheBitsOfASolveByOneProcess) {
  const SolvedScene alone = solve_scene(scene, options());
  constexpr int size = 3;
  std::array<SolvedScene, size> solved;
  std::atomic<std::int64_t> of_others = 0;
  const Ends ends = run_processes(size, [&](Processes& processes) {
    SolveOptions own = options();
    own.run.processes = &processes;
    solved[static_cast<std::size_t>(processes.rank())] = solve_scene(scene, own);
    if (!processes.is_first()) of_others += processes.traffic().pieces;
  });
  EXPECT_GT(of_others, 0) << "the first process did all the work";
  EXPECT_EQ(ends, Ends(size));
  for (const SolvedScene& each : solved) expect_same_solve(each, alone);
}

INSTANTIATE_TEST_SUITE_P(Solves, SharedSolve, testing::ValuesIn(cases),
                         [](const auto& each) { return std::string(each.param.name); });

// The journal is the first process's. Runs of 3, 1 and 2 processes are stopped at random moments
// and go on with another number of processes.
TEST(SharedSolve, GoesOnWithAnotherNumberOfProcesses) {
  const Scene scene = room(true);
  const SolvedScene alone = solve_scene(scene, quick());
  const TemporaryFolder folder;
  std::mt19937 random(7);
  std::optional<SolvedScene> solved;
  constexpr int sizes[] = {3, 1, 2, 3, 2};
  std::int64_t recalled = 0;
  for (std::size_t attempt = 0; attempt < std::size(sizes); ++attempt) {
    const bool is_last = attempt + 1 == std::size(sizes);
    const int stop = is_last ? 1 << 30 : std::uniform_int_distribution(20, 60)(random);
    run_processes(sizes[attempt], [&](Processes& processes) {
      std::optional<Journal> journal;
      SolveOptions own = quick();
      own.run.processes = &processes;
      int calls = 0;
      own.run.progress = [&](std::string_view, double) {
        processes.check();
        return !processes.is_first() || ++calls < stop;
      };
      if (processes.is_first()) {
        journal.emplace(folder / "C", Provenance{.scene_hash = scene_hash(scene)}, 1.0);
        own.run.journal = &*journal;
      }
      SolvedScene found = solve_scene(scene, own);
      if (!processes.is_first()) return;
      solved = std::move(found);
      recalled = journal->recalled();
    });
  }
  ASSERT_TRUE(solved);
  EXPECT_GT(recalled, 0);
  expect_same_solve(*solved, alone);
}

}  // namespace
}  // namespace lightwell::shared_solve_test
