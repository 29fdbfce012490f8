#include "radiosity/form_factors/transport.h"

#include <gtest/gtest.h>

#include "radiosity/solve.h"
#include "tests/radiosity/test_scenes.h"
#include "tests/temporary_folder.h"

namespace lightwell::transport_test {
namespace {

constexpr std::int64_t megabyte = 1 << 20;

/// 100 MB are resident, and 50 MB are needed beside rows.
TransportChoice choose(std::int64_t rows, std::int64_t disk, std::int64_t limit = 500 * megabyte) {
  return choose_transport({.patches = 4000,
                           .rows = rows,
                           .work = 50 * megabyte,
                           .shooting = 20 * megabyte,
                           .resident = 100 * megabyte,
                           .limit = limit,
                           .disk = disk});
}

TEST(Transport, RowsStayInMemoryWhileTheyFit) {
  const TransportChoice choice = choose(350 * megabyte, 0);
  EXPECT_EQ(choice.transport, Transport::rows_in_memory);
  EXPECT_EQ(choice.reason,
            "form factors of 4000 patches may take 350 MB, which fit into the 350 MB that a budget "
            "of 500 MB leaves");
}

TEST(Transport, WhatDoesNotFitGoesToDisk) {
  const TransportChoice choice = choose(351 * megabyte, 702 * megabyte);
  EXPECT_EQ(choice.transport, Transport::rows_on_disk);
  EXPECT_TRUE(says(choice.reason, "the rest goes to disk"));
  EXPECT_TRUE(says(choice.reason, "'--memory 501M' would keep all in memory"));
}

TEST(Transport, PatchesShootWhereRowsCannotBeKept) {
  const TransportChoice full = choose(351 * megabyte, 701 * megabyte);
  EXPECT_EQ(full.transport, Transport::shooting);
  EXPECT_TRUE(says(full.reason, "more than half of the 701 MB free on disk"));
  EXPECT_TRUE(says(full.reason, "'--memory 501M', or larger patches, would keep form factors"));

  const TransportChoice slow = choose(most_rows_on_disk + 1, 100 * most_rows_on_disk);
  EXPECT_EQ(slow.transport, Transport::shooting);
  EXPECT_TRUE(says(slow.reason, "more than a disk can be read through in time (8.0 GB)"));

  // The least slice of rows is 16 MB.
  const TransportChoice narrow = choose(351 * megabyte, most_rows_on_disk, 165 * megabyte);
  EXPECT_EQ(narrow.transport, Transport::shooting);
  EXPECT_TRUE(says(narrow.reason, "not even room for a part of them"));
  EXPECT_EQ(choose(351 * megabyte, most_rows_on_disk, 166 * megabyte).transport,
            Transport::rows_on_disk);
}

TEST(Transport, WhatFitsNowhereIsLeftToTheBudgetToRefuse) {
  EXPECT_EQ(choose(megabyte, most_rows_on_disk, 119 * megabyte).transport,
            Transport::rows_in_memory);
}

TEST(Transport, RowsAreEstimatedFromPatchesAndRays) {
  EXPECT_EQ(most_row_bytes(100, {.rays_per_patch = 512}), 100 * 100 * 8);
  EXPECT_EQ(most_row_bytes(10000, {.rays_per_patch = 64}), 10000 * 128 * 8);
  EXPECT_EQ(most_row_bytes(10000, {.method = FormFactorMethod::analytic, .rays_per_patch = 64}),
            std::int64_t{10000} * 10000 * 8);
}

TEST(Transport, AFolderThatIsNoneHasNoRoom) {
  const TemporaryFolder folder;
  EXPECT_EQ(room_on_disk(folder / "missing"), 0);
}

// A missing folder has no room for rows. The budget suffices for shooting, but not for rows.
TEST(Transport, ASolveThatCannotKeepRowsShoots) {
  const Scene scene = test::furnace(0.5f, 1.0f, true);
  SolveOptions options{.mesh = {.auto_patch_count = 4000, .elements_per_patch_edge = 1},
                       .gather = {.rays = 16},
                       .error_points = 16};
  options.refine.tolerance = 0.0;
  options.solver.tolerance = 1e-2;
  const auto with = [&](MemoryOptions memory) {
    options.form_factors.memory = std::make_shared<MemoryBudget>(std::move(memory));
    return solve_scene(scene, options);
  };
  const TemporaryFolder folder;
  const SolvedScene shot =
      with({.limit = resident_memory().now + 36 * megabyte, .folder = folder / "missing"});
  ASSERT_EQ(shot.solution.solver, "progressive");
  ASSERT_EQ(shot.mesh.notes.size(), 1u);
  EXPECT_TRUE(says(shot.mesh.notes[0], "(--solver progressive), which is noisier"));
  const SolvedScene kept = with({});
  EXPECT_NE(kept.solution.solver, "progressive");
  EXPECT_TRUE(kept.mesh.notes.empty());

  options.progressive = ProgressiveOptions{.tolerance = options.solver.tolerance,
                                           .overshooting = Overshooting::ambient};
  const SolvedScene asked = with({});
  EXPECT_TRUE((asked.solution.irradiance() == shot.solution.irradiance()).all()) << "same bits";
}

TEST(Transport, ElementsGoByWhatIsLeft) {
  // 650 bytes per element and 50 per column; rounded down to a sixteenth of a power of two.
  EXPECT_EQ(elements_in(800 * 16384, 3), 16384);
  EXPECT_EQ(elements_in(800 * 16384 + 800 * 1023, 3), 16384);
  EXPECT_EQ(elements_in(800 * 16384 + 800 * 1024, 3), 17408);
  EXPECT_EQ(elements_in(800 * 16384 - 1, 3), 15872);
  EXPECT_EQ(elements_in(3650 * 5, 60), 5);
  EXPECT_EQ(elements_in(0, 3), 0);
  EXPECT_EQ(elements_in(-megabyte, 3), 0);
}

}  // namespace
}  // namespace lightwell::transport_test
