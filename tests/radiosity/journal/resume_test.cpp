// A resumed solve gives the same bits as an uninterrupted one.
#include <gtest/gtest.h>

#include <random>

#include "radiosity/journal/journal.h"
#include "scene/errors.h"
#include "scene/parallel.h"
#include "tests/radiosity/journal/quick_solves.h"
#include "tests/radiosity/two_lamps.h"
#include "tests/temporary_folder.h"

namespace lightwell::resume_test {
namespace {
namespace fs = std::filesystem;
using quick_solves::Case;
using quick_solves::cases;
using quick_solves::expect_same_solve;
using quick_solves::quick;
using quick_solves::room;

class Resumed : public testing::TestWithParam<std::tuple<Case, double>> {
 protected:
  Scene scene = room(std::get<0>(GetParam()).with_specular);
  SolveOptions options() const {
    SolveOptions options = quick();
    std::get<0>(GetParam()).set(options);
    return options;
  }
  Provenance of() const { return {.version = "test", .scene_hash = scene_hash(scene)}; }
  double every() const { return std::get<1>(GetParam()); }
  TemporaryFolder folder;

  // Solves until progress has been called `calls` times. Returns nullopt if stopped.
  std::optional<SolvedScene> solve(Journal* journal, int calls, int* called = nullptr) {
    SolveOptions asked = options();
    int count = 0;
    asked.run.progress = [&](std::string_view, double) { return ++count < calls; };
    asked.run.journal = journal;
    std::optional<SolvedScene> solved;
    try {
      solved = solve_scene(scene, asked);
    } catch (const Interrupted&) {
    }
    if (called) *called = count;
    return solved;
  }
};

constexpr int to_the_end = 1 << 30;

TEST_P(Resumed, SolveHasTheBitsOfOneThatWasNotStopped) {
  std::mt19937 random(12345);
  int calls = 0;
  std::optional<SolvedScene> reference;
  {
    const ThreadLimit limit(3);
    reference = solve(nullptr, to_the_end, &calls);
  }
  ASSERT_TRUE(reference);
  ASSERT_GT(calls, 20);

  const fs::path file = folder / "C";
  int stops = 0;
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    fs::remove(file);
    // Each attempt stops at a random point; later attempts recall the work of earlier ones.
    std::optional<SolvedScene> solved;
    for (int attempt = 0; !solved; ++attempt) {
      const ThreadLimit limit(attempt % 2 == 0 ? 1 : 3);
      Journal journal(file, of(), every());
      const int stop = attempt < 4 ? std::uniform_int_distribution(1, calls)(random) : to_the_end;
      solved = solve(&journal, stop);
      if (!solved) ++stops;
      if (round == 0 && attempt == 1) {
        // A kill may truncate the file anywhere.
        journal.close();
        const auto header = static_cast<std::int64_t>(content_of(file).find("checksum: ") + 27);
        fs::resize_file(file, static_cast<std::uintmax_t>(
                                  std::uniform_int_distribution(header, journal.size())(random)));
      }
    }
    expect_same_solve(*solved, *reference);
  }
  std::printf("%d progress calls, stopped %d times; the journal has %zu bytes\n", calls, stops,
              static_cast<std::size_t>(fs::file_size(file)));
  EXPECT_GT(stops, rounds);
}

TEST_P(Resumed, AFinishedSolveIsRecalledAsAWhole) {
  const fs::path file = folder / "C";
  std::optional<SolvedScene> first, second;
  std::int64_t size = 0;
  {
    Journal journal(file, of(), every());
    first = solve(&journal, to_the_end);
    journal.close();
    size = journal.size();
  }
  Journal journal(file, of(), every());
  second = solve(&journal, to_the_end);
  journal.close();
  expect_same_solve(*first, *second);
  // Marks are written at intervals and states replace earlier ones; a block would be larger than
  // the margin. Passes and states that depend on time may be new.
  constexpr double hour = 3600.0;
  if (every() < hour) return;
  EXPECT_LE(journal.size(), size + 200);
}

// With an interval of 1e-9 s, which keeps every state and pass at once, and with 1e6 s, within
// which none is kept.
INSTANTIATE_TEST_SUITE_P(Solves, Resumed,
                         testing::Combine(testing::ValuesIn(cases), testing::Values(1e-9, 1e6)),
                         [](const auto& each) {
                           return std::string(std::get<0>(each.param).name) +
                                  (std::get<1>(each.param) < 1.0 ? "AlwaysKept" : "BlocksKept");
                         });

TEST(Resume, AJournalOfAnotherSceneIsRefused) {
  TemporaryFolder folder;
  const Scene scene = room(false);
  Journal journal(folder / "C", {.scene_hash = scene_hash(scene) + 1}, 1.0);
  SolveOptions options = quick();
  options.run.journal = &journal;
  EXPECT_THROW(solve_scene(scene, options), std::invalid_argument);
}

// Options absent from the header are in the fingerprints, so no block serves other options.
TEST(Resume, OtherOptionsTakeNothingFromAJournal) {
  TemporaryFolder folder;
  const Scene scene = room(true);
  const Provenance of = {.scene_hash = scene_hash(scene)};
  SolveOptions options = quick();
  {
    Journal journal(folder / "C", of, 1.0);
    options.run.journal = &journal;
    solve_scene(scene, options);
  }
  options.form_factors.emitter_points = 4;
  options.gather.shadows.max_rays = 64;
  options.caustic_rays = 1 << 11;
  Journal journal(folder / "C", of, 1.0);
  options.run.journal = &journal;
  const SolvedScene found = solve_scene(scene, options);
  options.run.journal = nullptr;
  expect_same_solve(found, solve_scene(scene, options));
}

// Writes the journal of a whole solve.
void keep_solve(const std::filesystem::path& file, const Scene& scene, SolveOptions options) {
  Journal journal(file, {.version = "1", .scene_hash = scene_hash(scene)}, 1.0);
  options.run.journal = &journal;
  solve_scene(scene, options);
}

// Form factors do not depend on the reflectance of surfaces or the emission of lamps.
TEST(Resume, AnotherSolveOfTheSameGeometryTakesItsFormFactors) {
  TemporaryFolder folder;
  Scene scene = room(true);
  SolveOptions options = quick();
  keep_solve(folder / "C", scene, options);
  for (Material& material : scene.materials) {
    material.reflectance *= 0.9f;
    material.emission *= 2.0f;
  }
  const auto journal = Journal::of_another_solve(folder / "C", "1");
  const std::int64_t size = journal->size();
  options.form_factors.run.journal = journal.get();
  const SolvedScene reused = solve_scene(scene, options);
  EXPECT_GT(journal->recalled(), 0);
  options.form_factors.run.journal = nullptr;
  expect_same_solve(reused, solve_scene(scene, options));
  EXPECT_EQ(std::filesystem::file_size(folder / "C"), size);  // nothing was written

  // Mirrors affect the form factors.
  for (Material& material : scene.materials) material.specular *= 0.9f;
  const auto other = Journal::of_another_solve(folder / "C", "1");
  options.form_factors.run.journal = other.get();
  solve_scene(scene, options);
  EXPECT_EQ(other->recalled(), 0);
}

// A mirror affects more than form factors.
TEST(Resume, AnotherMirrorTakesNothing) {
  TemporaryFolder folder;
  Scene scene = room(true);
  SolveOptions options = quick();
  keep_solve(folder / "C", scene, options);
  for (Material& material : scene.materials) material.specular *= 0.5f;
  const auto journal = Journal::of_another_solve(folder / "C", "1");
  options.run.journal = journal.get();
  EXPECT_THROW(solve_scene(scene, options), std::invalid_argument);
  options.run.journal = nullptr;
  options.form_factors.run.journal = journal.get();
  const SolvedScene found = solve_scene(scene, options);
  EXPECT_EQ(journal->recalled(), 0);
  options.form_factors.run.journal = nullptr;
  expect_same_solve(found, solve_scene(scene, options));
}

// Emitters are numbered by brightness, in the journal as well.
TEST(Resume, FormFactorsOfLampsAreNotMistakenForThoseOfOthers) {
  TemporaryFolder folder;
  Scene scene = test::two_lamps();
  SolveOptions options = quick();
  keep_solve(folder / "C", scene, options);
  // The dimmest lamp becomes the brightest.
  Material* dimmest = nullptr;
  for (Material& material : scene.materials) {
    if (!material.is_emitter()) continue;
    if (!dimmest || material.emission.sum() < dimmest->emission.sum()) dimmest = &material;
  }
  dimmest->emission *= 100.0f;
  const auto journal = Journal::of_another_solve(folder / "C", "1");
  options.form_factors.run.journal = journal.get();
  const SolvedScene reused = solve_scene(scene, options);
  options.form_factors.run.journal = nullptr;
  expect_same_solve(reused, solve_scene(scene, options));
}

TEST(Resume, AnotherSolvesJournalMustBeOfThisVersion) {
  TemporaryFolder folder;
  EXPECT_THROW(Journal::of_another_solve(folder / "none", "1"), InputError);
  { Journal journal(folder / "C", {.version = "1"}, 1.0); }
  EXPECT_THROW(Journal::of_another_solve(folder / "C", "2"), InputError);
  {
    Journal in_use(folder / "C", {.version = "1"}, 1.0);
    EXPECT_THROW(Journal::of_another_solve(folder / "C", "1"), InputError);
  }
  const auto first = Journal::of_another_solve(folder / "C", "1");
  const auto second = Journal::of_another_solve(folder / "C", "1");  // several readers are allowed
  EXPECT_TRUE(first->is_read_only());
}

}  // namespace
}  // namespace lightwell::resume_test
