// Option --memory: resident memory of the process, and rows that do not fit.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "tests/cli/program.h"
#include "tests/sanitizers.h"

namespace lightwell::memory_test {
namespace {
using Words = std::vector<std::string>;

class Memory : public CommandTest {
 protected:
  // In patches of 0.04 every row of the cube has hundreds of entries.
  void SetUp() override {
    folder.write("cube.obj", unit_cube());
    folder.write("room.toml", small_room());
  }
  Ended factors(const std::string& output, const Words& more) {
    return run(Words{"form-factors", "cube.obj", "-o", output, "--json", "--target-error", "0.02",
                     "--max-patch-size", "0.04"} +
               more);
  }
  std::string content(const std::string& file) const { return content_of(folder / file); }
};

// The budget in the message of a refusal, MB; 0: none.
int needed_mb(const std::string& refusal) {
  std::smatch found;
  return std::regex_search(refusal, found, std::regex("Allow (\\d+) MB")) ? std::stoi(found[1]) : 0;
}

TEST_F(Memory, TheLeastThatIsEnoughIsSaidAndKept) {
  if (!test::memory_is_its_own) GTEST_SKIP() << "a sanitizer uses memory too";
  const Ended unlimited = factors("F.mtx", {});
  ASSERT_EQ(unlimited.code, 0) << unlimited.err;
  const auto free = nlohmann::json::parse(unlimited.out);
  EXPECT_EQ(free["storage"]["disk_mb"], 0.0);
  const std::string matrix = content("F.mtx");
  ASSERT_GT(matrix.size(), 1u << 20);

  const Ended refused = factors("F.mtx", {"--memory", "2M"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_TRUE(says(refused.err, "a memory budget of 2 MB is too small"));
  EXPECT_EQ(content("F.mtx"), matrix) << "the old file stays";
  const int needed = needed_mb(refused.err);
  ASSERT_GT(needed, 20) << refused.err;
  ASSERT_LT(needed, free["peak_memory_mb"].get<double>()) << "the case is large enough";

  const Ended kept = factors("F.mtx", {"--memory", std::to_string(needed) + "M", "--threads", "3"});
  ASSERT_EQ(kept.code, 0) << kept.err;
  const auto small = nlohmann::json::parse(kept.out);
  EXPECT_GT(small["storage"]["disk_mb"].get<double>(), 1.0);
  EXPECT_EQ(small["storage"]["budget_mb"], needed);
  EXPECT_LT(small["peak_memory_mb"].get<double>(), 1.15 * needed);
  EXPECT_TRUE(content("F.mtx") == matrix) << "the same bits";
  EXPECT_EQ(folder.file_count(), 4) << "two scenes and two results; no file of rows";
}

TEST_F(Memory, PeopleAreToldWhereRowsWere) {
  const Ended ended = run({"form-factors", "cube.obj", "-o", "F.mtx", "--memory", "1.5 GiB"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(says(ended.out, "in memory (budget 1.5 GB)"));
}

TEST_F(Memory, SolveAndRunKeepToItToo) {
  const auto json = nlohmann::json::parse(
      run(Words{"solve", "room.toml", "-o", "S.vtp", "--memory", "1G", "--json"} + quick()).out);
  EXPECT_EQ(json["storage"]["budget_mb"], 1024.0);
  for (const Words& command :
       {Words{"solve", "room.toml", "-o", "T.vtp"}, Words{"run", "room.toml", "-o", "results"}}) {
    const Ended refused = run(command + Words{"--memory", "1M"} + quick());
    EXPECT_EQ(refused.code, 3);
    EXPECT_TRUE(says(refused.err, "too small"));
  }
  EXPECT_EQ(folder.file_count(), 3) << "two scenes and the solution";
}

// Shooting takes 16 MB for its rays and 144 bytes a patch; rows take 1.2 kB a patch beside a slice
// of 16 MB. A budget between the two, for 12 000 patches, allows shooting alone.
TEST_F(Memory, PatchesShootWhereRowsDoNotFit) {
  if (!test::memory_is_its_own) GTEST_SKIP() << "a sanitizer uses memory too";
  const auto solve = [&](const char* output, const std::string& memory) {
    return run(Words{"solve", "room.toml", "-o", output, "--json", "--max-patch-size", "0.1",
                     "--elements-per-patch-edge", "1", "--refine", "off", "--rays", "64",
                     "--gather-rays", "32", "--tolerance", "1e-3", "--memory", memory});
  };
  const std::string refused = solve("S.vtp", "2M").err;
  std::smatch taken;
  ASSERT_TRUE(std::regex_search(refused, taken, std::regex("its tree take (\\d+) MB"))) << refused;
  const int budget = std::stoi(taken[1]) + 24;
  const Ended ended = solve("S.vtp", std::to_string(budget) + "M");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(says(ended.err, "so patches shoot their light without them"));
  const auto json = nlohmann::json::parse(ended.out);
  EXPECT_EQ(json["solver"], "progressive");
  EXPECT_LT(json["peak_memory_mb"].get<double>(), 1.15 * budget);
  EXPECT_NE(nlohmann::json::parse(solve("T.vtp", "1G").out)["solver"], "progressive");
}

TEST_F(Memory, NoMoreElementsAreMadeThanFit) {
  if (!test::memory_is_its_own) GTEST_SKIP() << "a sanitizer uses memory too";
  const auto solve = [&](const Words& more) {
    return run(Words{"solve", "room.toml", "-o", "S.vtp", "--json", "--max-patch-size", "0.3",
                     "--gather-rays", "32", "--refine", "0.01%", "--max-elements", "200000"} +
               more);
  };
  const std::string refused = solve({"--memory", "2M"}).err;
  std::smatch taken;
  ASSERT_TRUE(std::regex_search(refused, taken, std::regex("its tree take (\\d+) MB"))) << refused;
  const int budget = std::stoi(taken[1]) + 50;
  const Ended ended = solve({"--memory", std::to_string(budget) + "M"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(says(ended.err, "stopped at the most elements that '--memory' has room for"));
  const auto json = nlohmann::json::parse(ended.out);
  EXPECT_EQ(json["refinement"]["outcome"], "memory_limit_reached");
  EXPECT_GT(json["elements"], 20000);
  EXPECT_LT(json["peak_memory_mb"].get<double>(), 1.15 * budget);
}

TEST_F(Memory, AmountsThatAreNoneAreRefused) {
  for (const char* wrong : {"", "much", "G", "-1G", "0", "100", "512K", "5X", "2GG", "nan", "inf",
                            "1e400", "9999999999T", "1,5G"}) {
    const Ended ended =
        run({"form-factors", "cube.obj", "-o", "F.mtx", std::string("--memory=") + wrong});
    EXPECT_EQ(ended.code, 2) << wrong;
    EXPECT_TRUE(says(ended.err, "--memory")) << wrong;
  }
  for (const char* right : {"2G", "2g", "2GB", "2gib", "2048M", "2147483648", "0.5t", "4e3 MiB"}) {
    const Ended ended = run({"form-factors", "cube.obj", "-o", "F.mtx", "--memory", right});
    EXPECT_EQ(ended.code, 0) << right << ": " << ended.err;
  }
}

// The program inherits the limit. A write beyond it raises SIGXFSZ, which would end the program by
// default.
TEST_F(Memory, AFileThatMayNotGrowIsAnError) {
  if (!test::memory_is_its_own) GTEST_SKIP() << "a sanitizer uses memory too";
  const int needed = needed_mb(factors("F.mtx", {"--memory", "2M"}).err);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit limit{.rlim_cur = 1 << 20, .rlim_max = before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  const Ended ended = factors("F.mtx", {"--memory", std::to_string(needed) + "M"});
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(ended.code, 1);
  EXPECT_TRUE(says(ended.err, "rows that do not fit into memory could not be written"));
  EXPECT_EQ(folder.file_count(), 2) << "the two scenes";
}

}  // namespace
}  // namespace lightwell::memory_test
