// SIGTERM: exit code 130 within seconds, and no new file. SIGINT and --time: the best result there
// is.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include "radiosity/solution/solution_file.h"
#include "raytrace/pictures/image.h"
#include "tests/cli/program.h"
#include "tests/sanitizers.h"

namespace lightwell::interrupt_test {
namespace {
using namespace std::chrono_literals;

// Options of a solve of small_room() that takes minutes.
const std::vector<std::string> long_work = {"--max-patch-size", "0.1", "--rays", "65536"};

// Waits until the phase "mesh" has ended: a line on standard error says so, and form factors
// follow.
void wait_for_form_factors(const Running& running) {
  for (int i = 0; i < 600 && running.err().empty(); ++i) std::this_thread::sleep_for(50ms);
  ASSERT_NE(running.err(), "") << "no sign of work after 30 s";
}

class InterruptTest : public CommandTest {
 protected:
  // The end of long work that got a signal during form factors.
  Ended ended_by(int signal, const std::vector<std::string>& words) {
    Running running(folder / "", words + long_work);
    wait_for_form_factors(running);
    running.signal(signal);
    return running.wait();
  }
  InterruptTest() { folder.write("room.toml", small_room()); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }
};

TEST_F(InterruptTest, SigtermStopsASolveWithinAMomentAndLeavesNothing) {
  const std::vector<std::string> solve = {"solve", "room.toml", "-o", "S.vtp"};
  Running running(folder / "", solve + long_work);
  wait_for_form_factors(running);
  const auto start = std::chrono::steady_clock::now();
  running.signal(SIGTERM);
  const Ended ended = running.wait();
  const auto taken = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(ended.code, 130) << ended.err;
  EXPECT_EQ(ended.out, "");
  EXPECT_TRUE(says(ended.err, "interrupted"));
  EXPECT_EQ(folder.file_count(), 1) << "something besides the scene is there";
  // The limit is one second on an idle machine; tests run beside other tests.
  EXPECT_LT(taken, 5s * test::slowdown);
}

// Reading takes seconds; notes on the scene follow it.
TEST_F(InterruptTest, CtrlCEndsReadingAtOnce) {
  constexpr int count = 400000;
  std::string obj;
  for (int i = 0; i < count; ++i) {
    const int x = i % 1000, y = i / 1000;
    obj +=
        "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(x * y % 7) + "\n";
  }
  for (int i = 1; i + 1002 < count; ++i) {
    const std::string a = std::to_string(i), b = std::to_string(i + 1),
                      c = std::to_string(i + 1001);
    obj += "f " + a + " " + b + " " + c + "\n";
  }
  folder.write("large.obj", obj);
  Running running(folder / "", {"solve", "large.obj", "-o", "S.vtp"});
  std::this_thread::sleep_for(300ms);
  running.signal(SIGINT);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 130) << ended.err;
  EXPECT_TRUE(says(ended.err, "interrupted"));
  EXPECT_EQ(ended.err.find("note:"), std::string::npos) << ended.err;
}

TEST_F(InterruptTest, SigtermRemovesTheFolderThatRunMade) {
  EXPECT_EQ(ended_by(SIGTERM, {"run", "room.toml", "-o", "deep/results"}).code, 130);
  EXPECT_EQ(folder.file_count(), 1);
}

TEST_F(InterruptTest, CtrlCWritesTheBestSolutionThereIs) {
  const Ended ended = ended_by(SIGINT, {"solve", "room.toml", "-o", "S.vtp", "--json"});
  EXPECT_EQ(ended.code, 4) << ended.err;
  EXPECT_TRUE(says(ended.err, "ending with what there is; another Ctrl-C ends at once"));
  EXPECT_TRUE(says(ended.err, "rows of 64 rays a patch"));
  EXPECT_TRUE(says(ended.err, "warning: the solve was ended early"));
  const auto json = nlohmann::json::parse(ended.out);
  EXPECT_EQ(json["outcome"], "cut_short");
  EXPECT_GT(json["error_estimate"].get<double>(), 0.0);
  // 32 rays leave 1/sqrt(32) of the spread of light among them, which is at most the mean light.
  EXPECT_LT(json["error_estimate"].get<double>(), 1.0 / std::sqrt(32.0));
  // Whoever reads the file is told as well.
  EXPECT_EQ(read_solution(folder / "S.vtp").solution.outcome, Outcome::cut_short);
  EXPECT_EQ(run_json({"info", "S.vtp"})["outcome"], "cut_short");
}

TEST_F(InterruptTest, CtrlCGivesRunWholePictures) {
  const Ended ended = ended_by(SIGINT, {"run", "room.toml", "-o", "D", "--size", "60x40"});
  EXPECT_EQ(ended.code, 4) << ended.err;
  EXPECT_TRUE(says(ended.err, "warning: door: for want of time"));
  for (const char* file : {"D/solution.vtp", "D/door.exr", "D/door.png", "D/report.json"}) {
    EXPECT_TRUE(exists(file)) << file;
  }
  const Image picture = read_exr(folder / "D/door.exr");
  EXPECT_EQ(picture.height, 40);
  EXPECT_GT(picture.radiance.minCoeff(), 0.0f) << "every wall of the room is lit";
  const auto report = nlohmann::json::parse(content_of(folder / "D/report.json"));
  EXPECT_EQ(report["outcome"], "cut_short");
  EXPECT_EQ(report["cut_short_door"]["rows"], 0);
}

TEST_F(InterruptTest, ASecondCtrlCEndsAtOnce) {
  const std::vector<std::string> solve = {"solve", "room.toml", "-o", "S.vtp"};
  Running running(folder / "", solve + std::vector<std::string>{"--max-patch-size", "0.05"});
  wait_for_form_factors(running);
  running.signal(SIGINT);
  std::this_thread::sleep_for(20ms);  // two pending signals of a kind would be one
  running.signal(SIGINT);
  EXPECT_EQ(running.wait().code, -SIGINT);
  EXPECT_FALSE(exists("S.vtp"));
}

TEST_F(InterruptTest, TimeIsKept) {
  const auto json = run_json({"run", "room.toml", "-o", "D", "--size", "60x40", "--time", "4s"});
  EXPECT_EQ(json["outcome"], "converged");
  EXPECT_EQ(json["looked_from"], nlohmann::json::array({"door"}));
  // The first step ends when 16 % is reached.
  EXPECT_LE(json["error_estimate"].get<double>(), 0.16);
  EXPECT_FALSE(json.contains("accuracy")) << "none was asked for";
  EXPECT_EQ(json["time"]["asked"], 4.0);
  EXPECT_LE(json["time"]["aimed_at"].get<double>(), 0.16);
  EXPECT_TRUE(says(json["options"].get<std::string>(), " --time 4s"));
  // The last piece of work that no clock divides, and the files, come on top.
  EXPECT_LT(json["seconds"]["total"].get<double>(), 4.0 + 4.0 * test::slowdown);
  EXPECT_TRUE(exists("D/door.png"));
}

TEST_F(InterruptTest, TooLittleTimeIsSaid) {
  const Ended ended =
      run({"solve", "room.toml", "-o", "S.vtp", "--time", "0.1s", "--accuracy", "0.1%", "--json"});
  EXPECT_EQ(ended.code, 4) << ended.err;
  const auto json = nlohmann::json::parse(ended.out);
  EXPECT_TRUE(json["outcome"] == "cut_short" || json["outcome"] == "accuracy_missed");
  EXPECT_TRUE(exists("S.vtp"));
}

TEST_F(InterruptTest, WrongUseOfTimeIsRefused) {
  const std::vector<std::string> solve = {"solve", "room.toml", "-o", "S.vtp"};
  const auto refused = [&](const std::vector<std::string>& words, const char* reason) {
    const Ended ended = run(solve + words);
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(says(ended.err, reason));
  };
  using Words = std::vector<std::string>;
  refused(Words{"--time", "soon"}, "'soon' is no time from 0.1 s to 24 h");
  refused(Words{"--time", "0"}, "'0' is no time");
  refused(Words{"--time", "10s", "--checkpoint", "C"}, "cannot be combined with --checkpoint");
  refused(Words{"--time", "10s", "--gather-rays", "64"}, "cannot be combined with --gather-rays");
  refused(Words{"--time", "10s", "--refine", "1%"}, "cannot be combined with --refine");
  EXPECT_EQ(run(solve + quick() + Words{"--time", "10s"}).code, 2) << "it has --gather-rays";
}

}  // namespace
}  // namespace lightwell::interrupt_test
