// Solves that are stopped and resumed.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <thread>

#include "radiosity/solution/solution_file.h"
#include "tests/cli/program.h"

namespace lightwell::checkpoint_test {
namespace {
using namespace std::chrono_literals;
using Words = std::vector<std::string>;

// Options of a solve that takes a few seconds.
Words work() {
  return {"--max-patch-size", "0.25", "--rays", "2048", "--gather-rays", "256"};
}

const Words solve = {"solve", "room.toml", "-o", "S.vtp"};
const Words kept = {"--checkpoint", "C"};

class CheckpointTest : public CommandTest {
 protected:
  CheckpointTest() { folder.write("room.toml", small_room()); }

  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }
  // Stops a solve while it computes form factors, when the checkpoint exists.
  // True once a checkpoint in the folder holds more than its head, which takes less than 10 kB.
  bool keeps_work() const {
    const std::filesystem::directory_iterator files(folder / "");
    return std::any_of(begin(files), end(files), [](const auto& file) {
      std::error_code gone;
      const bool is_checkpoint =
          file.path().filename() == "C" || file.path().extension() == ".ckpt";
      return is_checkpoint && std::filesystem::file_size(file.path(), gone) > 10000 && !gone;
    });
  }
  Ended stopped(const Words& words, int signal) {
    Running running(folder / "", words);
    for (int i = 0; i < 600 && running.err().empty(); ++i) std::this_thread::sleep_for(50ms);
    // Work is worth keeping from the first phase on that is kept.
    for (int i = 0; i < 600 && !keeps_work(); ++i) std::this_thread::sleep_for(10ms);
    running.signal(signal);
    return running.wait();
  }
  // Makes the checkpoint "C" with all the work of a quick solve, and no solution.
  void make_checkpoint() {
    ASSERT_EQ(run(solve + quick() + kept + Words{"--keep-checkpoint"}).code, 0);
    std::filesystem::remove(folder / "S.vtp");
  }
};

bool same_bits(const BandArray& a, const BandArray& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         (a.size() == 0 ||
          std::memcmp(a.data(), b.data(), sizeof(float) * static_cast<std::size_t>(a.size())) == 0);
}

void expect_same_solution(const std::filesystem::path& a, const std::filesystem::path& b) {
  const SolvedScene x = read_solution(a), y = read_solution(b);
  EXPECT_TRUE(same_bits(x.solution.patch_radiosity, y.solution.patch_radiosity));
  EXPECT_TRUE(same_bits(x.solution.direct_irradiance, y.solution.direct_irradiance));
  EXPECT_TRUE(same_bits(x.solution.indirect_irradiance, y.solution.indirect_irradiance));
  EXPECT_TRUE(same_bits(x.solution.caustic_irradiance, y.solution.caustic_irradiance));
  EXPECT_TRUE(same_bits(x.solution.interpolation_error, y.solution.interpolation_error));
  EXPECT_TRUE(same_bits(x.solution.gather_noise, y.solution.gather_noise));
  EXPECT_EQ(x.solution.residual, y.solution.residual);
  EXPECT_EQ(x.solution.error_estimate, y.solution.error_estimate);
  EXPECT_EQ(x.mesh.corners, y.mesh.corners);
}

TEST_F(CheckpointTest, AnInterruptSaysHowToGoOnAndThatWorks) {
  ASSERT_EQ(run(Words{"solve", "room.toml", "-o", "reference.vtp", "--quiet"} + work()).code, 0);
  for (const int signal : {SIGINT, SIGTERM}) {
    const Ended ended = stopped(solve + work() + kept, signal);
    // Ctrl-C writes the best solution there is besides.
    const bool ends_early = signal == SIGINT;
    EXPECT_EQ(ended.code, ends_early ? 4 : 130) << ended.err;
    EXPECT_TRUE(says(ended.err, "finished work is in 'C' ("));
    EXPECT_TRUE(exists("C"));
    EXPECT_EQ(exists("S.vtp"), ends_early);
    const std::string before_command = "To resume:\n  ";
    const std::size_t at = ended.err.find(before_command);
    ASSERT_NE(at, std::string::npos) << ended.err;
    const std::string command = ended.err.substr(at + before_command.size());
    EXPECT_TRUE(says(command, "solve room.toml -o S.vtp"));
    EXPECT_TRUE(says(command, "--checkpoint C --resume"));
    // The printed command is given to a shell, as a user would copy it.
    std::string shell = "cd '" + folder.path().string() + "' && " + command;
    shell.erase(shell.find_last_not_of('\n') + 1);
    ASSERT_EQ(std::system((shell + " >out 2>err").c_str()), 0) << content_of(folder / "err");
    EXPECT_TRUE(says(content_of(folder / "err"), "resuming from 'C'"));
    EXPECT_TRUE(says(content_of(folder / "err"), "removed the checkpoint 'C'"));
    EXPECT_FALSE(exists("C"));
    expect_same_solution(folder / "S.vtp", folder / "reference.vtp");
    std::filesystem::remove(folder / "S.vtp");
  }
}

// The command to resume quotes words that a shell would split.
TEST_F(CheckpointTest, TheCommandToGoOnIsQuoted) {
  const Ended ended = stopped(solve + work() + Words{"--checkpoint", "it's done.ckpt"}, SIGINT);
  EXPECT_TRUE(says(ended.err, "--checkpoint 'it'\\''s done.ckpt' --resume"));
}

TEST_F(CheckpointTest, ResumingWhatIsFinishedSaysSo) {
  ASSERT_EQ(run(solve + quick() + kept + Words{"--resume"}).code, 0);
  const std::string solution = content_of(folder / "S.vtp");
  const Ended ended = run(solve + quick() + kept + Words{"--resume"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_TRUE(says(ended.err, "'S.vtp' is finished"));
  EXPECT_TRUE(says(ended.out, "energy")) << "the report is printed all the same";
  EXPECT_EQ(content_of(folder / "S.vtp"), solution);
  EXPECT_FALSE(exists("C"));
  // Other options start another solve.
  const Ended other =
      run(solve + quick() + Words{"--gather-rays", "64"} + kept + Words{"--resume"});
  EXPECT_EQ(other.code, 2) << "the option was given twice";
  const Ended finer = run({"solve", "room.toml", "-o", "S.vtp", "--max-patch-size", "0.8", "--rays",
                           "64", "--gather-rays", "32", "--checkpoint", "C", "--resume"});
  EXPECT_EQ(finer.code, 0);
  EXPECT_TRUE(says(finer.err, "there is no checkpoint 'C' yet; starting from the beginning"));
  EXPECT_NE(content_of(folder / "S.vtp"), solution);
}

TEST_F(CheckpointTest, ItIsKeptIfAskedFor) {
  const nlohmann::json json =
      run_json(solve + quick() + kept + Words{"--keep-checkpoint", "--every", "2min"});
  EXPECT_TRUE(exists("C"));
  EXPECT_EQ(json["checkpoint"]["file"], "C");
  EXPECT_GT(json["checkpoint"]["mb"], 0.001);
  EXPECT_EQ(json["checkpoint"]["resumed_mb"], 0.0);
  std::filesystem::rename(folder / "S.vtp", folder / "first.vtp");
  const nlohmann::json again = run_json(solve + quick() + kept + Words{"--resume"});
  EXPECT_GT(again["checkpoint"]["resumed_mb"], 0.001);
  expect_same_solution(folder / "S.vtp", folder / "first.vtp");
}

TEST_F(CheckpointTest, FinishedWorkIsNotOverwritten) {
  make_checkpoint();
  const std::string before = content_of(folder / "C");
  const Ended ended = run(solve + quick() + kept);
  EXPECT_EQ(ended.code, 3);
  EXPECT_TRUE(says(ended.err, "'C' holds finished work already; add --resume to continue"));
  EXPECT_EQ(content_of(folder / "C"), before);
}

TEST_F(CheckpointTest, RefusesWithTheReason) {
  make_checkpoint();
  const auto refused = [&](const Words& words, const std::string& reason) {
    const Ended ended = run(words + kept + Words{"--resume"});
    EXPECT_EQ(ended.code, 3) << ended.err;
    EXPECT_TRUE(says(ended.err, reason));
    EXPECT_FALSE(exists("S.vtp"));
  };
  refused(solve + Words{"--max-patch-size", "1", "--rays", "128", "--gather-rays", "32"},
          "was made with other options: with --rays 64, now it is --rays 128. Give");
  refused(solve + quick() + Words{"--discontinuity"},
          "with no --discontinuity, now it is --discontinuity");
  std::string text = small_room();
  text.replace(text.find("0.7, 0.5, 0.3"), 13, "0.7, 0.5, 0.4");
  folder.write("other.toml", text);
  refused(Words{"solve", "other.toml", "-o", "S.vtp"} + quick(),
          "is of another scene: of 'room.toml'");

  const std::string whole = content_of(folder / "C");
  std::string damaged = whole;
  damaged[whole.size() / 3] = static_cast<char>(damaged[whole.size() / 3] ^ 4);
  folder.write("C", damaged);
  refused(solve + quick(), "is damaged: what is at byte");
  std::string edited = whole;
  edited[whole.find("version: ") + 9] = '9';
  folder.write("C", edited);
  refused(solve + quick(), "is damaged: its first lines");
  folder.write("C", small_room());
  refused(solve + quick(), "the file is something else; give another name");
  EXPECT_EQ(content_of(folder / "C"), small_room());
  EXPECT_EQ(run(solve + quick() + kept).code, 3) << "nor without --resume";
  EXPECT_EQ(content_of(folder / "C"), small_room());
}

TEST_F(CheckpointTest, FormFactorsServeOtherReflectances) {
  make_checkpoint();
  std::string text = small_room();
  text.replace(text.find("0.7, 0.5, 0.3"), 13, "0.7, 0.5, 0.4");
  folder.write("room.toml", text);
  const nlohmann::json json = run_json(solve + quick() + Words{"--reuse", "C"});
  EXPECT_EQ(json["reused"]["file"], "C");
  EXPECT_GT(json["reused"]["mb"], 0.001);
  std::filesystem::rename(folder / "S.vtp", folder / "reused.vtp");
  ASSERT_EQ(run(solve + quick()).code, 0);
  expect_same_solution(folder / "S.vtp", folder / "reused.vtp");
  const Ended other = run(solve + Words{"--max-patch-size", "0.5", "--reuse", "C"});
  EXPECT_EQ(other.code, 0);
  EXPECT_TRUE(says(other.err, "warning: nothing in 'C' could be used"));
}

TEST_F(CheckpointTest, WrongUseIsSaidAtOnce) {
  const auto refused = [&](const Words& words, int code, const std::string& reason) {
    const Ended ended = run(solve + quick() + words);
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_TRUE(says(ended.err, reason));
    EXPECT_FALSE(exists("S.vtp"));
  };
  refused({"--resume"}, 2, "--resume: it needs --checkpoint FILE");
  refused({"--every", "10s"}, 2, "--every: it needs --checkpoint FILE");
  refused({"--keep-checkpoint"}, 2, "--keep-checkpoint: it needs --checkpoint FILE");
  refused({"--checkpoint", "C", "--every", "soon"}, 2, "'soon' is no time from 0.1 s to 24 h");
  refused({"--checkpoint", "C", "--every", "0"}, 2, "is no time");
  refused({"--checkpoint", "none/C"}, 1, "there is no folder 'none'");
  refused({"--checkpoint", "./S.vtp"}, 3, "cannot both be './S.vtp'");
  EXPECT_EQ(folder.file_count(), 1);
}

TEST_F(CheckpointTest, TimesHaveUnits) {
  for (const char* time : {"10s", "10 s", "2min", "0.5", "1.5h", "100ms", "3 m"}) {
    EXPECT_EQ(run(solve + quick() + kept + Words{"--every", time}).code, 0) << time;
  }
}

// A refused scene leaves no checkpoint, which a later solve would be refused for.
TEST_F(CheckpointTest, AFailureBeforeAnyWorkLeavesNone) {
  std::string text = small_room();
  text.erase(text.find("power ="), text.find("]", text.find("power =")) + 1 - text.find("power ="));
  folder.write("dark.toml", text);
  EXPECT_EQ(run(Words{"solve", "dark.toml", "-o", "S.vtp"} + kept).code, 3);
  EXPECT_FALSE(exists("C"));
}

TEST_F(CheckpointTest, RunGoesOnWithItsPictures) {
  const Words run_room = {"run", "room.toml", "-o", "D"};
  ASSERT_EQ(run(Words{"run", "room.toml", "-o", "reference"} + quick()).code, 0);
  ASSERT_EQ(run(run_room + quick() + kept + Words{"--resume"}).code, 0);
  EXPECT_FALSE(exists("C"));
  const std::string picture = content_of(folder / "reference/door.exr");
  std::filesystem::remove(folder / "D/door.exr");
  std::filesystem::remove(folder / "D/report.json");
  const Ended ended = run(run_room + quick() + kept + Words{"--resume"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(says(ended.err, "is finished"));
  EXPECT_TRUE(exists("D/report.json"));
  EXPECT_EQ(content_of(folder / "D/door.exr"), picture);
}

// RLIMIT_FSIZE of the child stands for a full disk: no file may grow beyond the limit.
TEST_F(CheckpointTest, AFullDiskStopsTheCheckpointAndNotTheSolve) {
  ASSERT_EQ(run(Words{"solve", "room.toml", "-o", "reference.vtp", "--quiet"} + work()).code, 0);
  const auto needed = std::filesystem::file_size(folder / "reference.vtp");
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limit{needed + 4096, before.rlim_max};
  std::unique_ptr<Running> running;
  ::setrlimit(RLIMIT_FSIZE, &limit);
  running = std::make_unique<Running>(
      folder / "", solve + work() + kept + Words{"--every", "0.1", "--keep-checkpoint"});
  ::setrlimit(RLIMIT_FSIZE, &before);
  const Ended ended = running->wait();
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(says(ended.err, "'C' cannot be written any more: File too large"));
  expect_same_solution(folder / "S.vtp", folder / "reference.vtp");
  std::filesystem::remove(folder / "S.vtp");
  EXPECT_EQ(run(solve + work() + kept + Words{"--resume"}).code, 0);
  expect_same_solution(folder / "S.vtp", folder / "reference.vtp");
}

// Number of kills, by the environment variable LIGHTWELL_KILLS (50 for a long test).
int kill_count() {
  const char* const asked = std::getenv("LIGHTWELL_KILLS");
  return asked ? std::atoi(asked) : 4;
}

TEST_F(CheckpointTest, KilledAnywhereAndResumedItHasTheSameBits) {
  // The scene has a mirror, glass and a caustic; the options make form factors and refine.
  const std::string scene = LIGHTWELL_CORNELL "/cornell-spheres.toml";
  const Words options = {"--max-patch-size", "80",  "--rays",   "2048",
                         "--gather-rays",    "128", "--refine", "2%"};
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(run(Words{"solve", scene, "-o", "reference.vtp"} + options).code, 0);
  const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - start;

  std::mt19937 random(2026);
  const Words words = Words{"solve", scene, "-o", "S.vtp", "--every", "0.1", "--resume"} + kept;
  int kills = 0, resumed = 0, finished = 0;
  while (kills < kill_count() || finished == 0) {
    const Words threads = {"--threads", std::to_string(1 + kills % 3)};
    Running running(folder / "", words + options + threads);
    if (kills < kill_count()) {
      std::this_thread::sleep_for(std::uniform_real_distribution(0.0, 1.0)(random) * whole);
      running.signal(SIGKILL);
    }
    const Ended ended = running.wait();
    if (ended.err.find("resuming from 'C'") != std::string::npos) ++resumed;
    if (ended.code == -SIGKILL) {
      ++kills;
      continue;
    }
    ASSERT_EQ(ended.code, 0) << ended.err;
    ++finished;
    expect_same_solution(folder / "S.vtp", folder / "reference.vtp");
    EXPECT_FALSE(exists("C"));
    std::filesystem::remove(folder / "S.vtp");
  }
  std::printf("a solve of %.1f s: %d kills, %d starts that went on, %d finished\n", whole.count(),
              kills, resumed, finished);
  EXPECT_GT(resumed, 0);
}

}  // namespace
}  // namespace lightwell::checkpoint_test
