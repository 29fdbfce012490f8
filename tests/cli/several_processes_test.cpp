// Runs that several processes share: their files, their messages, and their ends.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "radiosity/solution/solution_file.h"
#include "tests/cli/program.h"

namespace lightwell::several_processes_test {
namespace {
namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Words = std::vector<std::string>;

// A variable of the environment, for programs that start meanwhile.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

#ifdef LIGHTWELL_MPIEXEC

// A room with six boxes, one of which reaches through a wall, and a mirror.
std::string room_of_boxes() {
  std::string tables = "[materials.mirror]\nspecular = 0.8\n";
  for (int i = 0; i < 6; ++i) {
    const double x = 0.3 + 0.6 * i, y = 0.4 + 0.35 * i, height = 0.4 + 0.2 * i;
    tables += "[[surfaces]]\nname = \"box " + std::to_string(i) + "\"\nmaterial = \"" +
              (i == 2 ? "mirror" : "white") + "\"\nbox = { min = [" + std::to_string(x) + ", " +
              std::to_string(y) + ", 0], max = [" + std::to_string(x + 0.4) + ", " +
              std::to_string(y + 0.3) + ", " + std::to_string(height) + "] }\n";
  }
  return small_room_with(tables);
}

class SeveralProcesses : public CommandTest {
 protected:
  SeveralProcesses() {
    folder.write("room.toml", small_room());
    folder.write("boxes.toml", room_of_boxes());
  }

  static Words launcher(int size) { return {LIGHTWELL_MPIEXEC, "-n", std::to_string(size)}; }
  static Words program(const Words& arguments) {
    return Words{LIGHTWELL_PROGRAM} + arguments + Words{"--threads", "1"};
  }
  std::unique_ptr<Running> start(int size, const Words& arguments) const {
    return Running::command(folder / "", launcher(size) + program(arguments));
  }
  Ended share(int size, const Words& arguments) const { return start(size, arguments)->wait(); }
  // One command for each process.
  Ended side_by_side(const std::vector<Words>& commands) const {
    Words words = launcher(1) + commands[0];
    for (std::size_t i = 1; i < commands.size(); ++i) {
      words = words + Words{":", "-n", "1"} + commands[i];
    }
    return Running::command(folder / "", words)->wait();
  }

  // The bytes of a solution whose clock stood still.
  std::string timeless(const std::string& file) const {
    SolvedScene solved = read_solution(folder / file);
    for (auto& phase : solved.solution.seconds) phase.seconds = 0.0;
    for (auto& step : solved.solution.history) step.seconds = 0.0;
    write_solution(folder / "timeless.vtp", solved);
    return content_of(folder / "timeless.vtp");
  }

  // More processes than cores, by root too: Open MPI refuses both unless told otherwise, and MPICH
  // knows none of the variables.
  Variable as_root{"OMPI_ALLOW_RUN_AS_ROOT", "1"}, confirmed{"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
      oversubscribe{"OMPI_MCA_rmaps_base_oversubscribe", "1"},
      unbound{"OMPI_MCA_hwloc_base_binding_policy", "none"};
};

TEST_F(SeveralProcesses, SolutionsHaveTheBytesOfOneProcess) {
  struct Case {
    std::string scene;
    Words options;
    std::vector<int> sizes{};
  };
  const std::vector<Case> cases = {
      {CORNELL_SCENE,
       {"--max-patch-size", "110", "--rays", "64", "--gather-rays", "32"},
       {1, 2, 7}},
      {"boxes.toml", quick(), {1, 2, 3, 7}},
      {"boxes.toml", {"--accuracy", "20%", "--max-patch-size", "1.5"}, {3}}};
  for (const auto& [scene, options, sizes] : cases) {
    const Words solve = Words{"solve", scene, "-o", "S.vtp"} + options;
    const int code = run(solve).code;
    const std::string alone = timeless("S.vtp");
    for (const int size : sizes) {
      fs::remove(folder / "S.vtp");
      const Ended ended = share(size, solve);
      EXPECT_EQ(ended.code, code) << ended.err;
      EXPECT_TRUE(timeless("S.vtp") == alone) << scene << " by " << size << " processes";
    }
  }
}

TEST_F(SeveralProcesses, PicturesAndFormFactorsHaveTheBytesOfOneProcess) {
  const Words render = Words{"run", "boxes.toml", "-o", "out"} + quick();
  const Words factors = {"form-factors", "boxes.toml", "-o", "F.mtx", "--target-error", "0.05"};
  run(render);
  run(factors);
  const std::string picture = content_of(folder / "out/door.png");
  const std::string matrix = content_of(folder / "F.mtx");
  ASSERT_FALSE(picture.empty());
  ASSERT_FALSE(matrix.empty());
  fs::remove_all(folder / "out");
  fs::remove(folder / "F.mtx");
  EXPECT_TRUE(says(share(3, render).err, "render: "));
  EXPECT_TRUE(content_of(folder / "out/door.png") == picture);
  share(2, factors);
  EXPECT_TRUE(content_of(folder / "F.mtx") == matrix);
}

TEST_F(SeveralProcesses, TheReportCountsTheWorkOfEach) {
  const Ended ended = share(3, Words{"solve", "boxes.toml", "-o", "S.vtp", "--json"} + quick());
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto json = nlohmann::json::parse(ended.out);
  ASSERT_EQ(json["processes"].size(), 3u);
  double sent = 0.0, received = 0.0;
  for (const auto& each : json["processes"]) {
    EXPECT_GE(each["pieces"], 0);
    sent += each["sent_mb"].get<double>();
    received += each["received_mb"].get<double>();
  }
  EXPECT_GT(sent, 0.0);
  // Bytes over 2^20 are exact, and JSON keeps all digits. Requests of the last round may be under
  // way: at most two of 16 bytes, one for the thread and one ahead, from each of the two other
  // processes.
  const double under_way = 2 * 2 * 16.0 / (1 << 20);
  EXPECT_LE(received, sent);
  EXPECT_GE(received, sent - under_way);
}

// Kills one of the processes of mpirun.
void kill_one(int launcher, std::mt19937& random) {
  const std::string id = std::to_string(launcher);
  std::ifstream children("/proc/" + id + "/task/" + id + "/children");
  std::vector<int> ids;
  for (int child = 0; children >> child;) ids.push_back(child);
  if (ids.empty()) return;  // all have ended already
  ::kill(ids[std::uniform_int_distribution<std::size_t>(0, ids.size() - 1)(random)], SIGKILL);
}

TEST_F(SeveralProcesses, AKilledRunGoesOnWithAnotherNumberOfProcesses) {
  const Words options = {"--max-patch-size", "0.5", "--rays", "512", "--gather-rays", "128"};
  const Words solve = Words{"solve", "room.toml", "-o", "S.vtp"} + options;
  const Words kept = solve + Words{"--checkpoint", "C", "--every", "0.1s", "--resume"};
  ASSERT_EQ(run(solve).code, 0);
  const std::string alone = timeless("S.vtp");
  fs::remove(folder / "S.vtp");
  const char* asked = std::getenv("LIGHTWELL_KILLS");
  const int kills = asked ? std::atoi(asked) : 3;
  std::mt19937 random(11);
  int killed = 0;
  for (int i = 0; i < kills; ++i) {
    const auto running = start(2 + i % 3, kept);
    std::this_thread::sleep_for(std::uniform_int_distribution(200, 1500)(random) * 1ms);
    kill_one(running->process(), random);
    const Ended ended = running->wait();
    if (ended.code != 0) ++killed;
    if (fs::exists(folder / "S.vtp")) break;
  }
  const Ended ended = share(2, kept);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(timeless("S.vtp") == alone) << "after " << killed << " kills";
  EXPECT_FALSE(fs::exists(folder / "C"));
}

TEST_F(SeveralProcesses, AnInterruptSaysOnceHowToGoOn) {
  const Words solve = {"solve", "room.toml", "-o",  "S.vtp", "--max-patch-size",
                       "0.15",  "--rays",    "4096"};
  const auto running = start(2, solve + Words{"--checkpoint", "C", "--every", "0.1s"});
  for (int look = 0; look < 600 && !fs::exists(folder / "C"); ++look) {
    std::this_thread::sleep_for(20ms);
  }
  std::this_thread::sleep_for(500ms);
  running->signal(SIGTERM);
  const Ended ended = running->wait();
  EXPECT_NE(ended.code, 0);
  EXPECT_FALSE(fs::exists(folder / "S.vtp"));
  EXPECT_EQ(count_of(ended.err, "To resume:"), 1) << ended.err;
  EXPECT_EQ(count_of(ended.err, "mpirun -n 2"), 1) << ended.err;
}

// Each of these is refused by one sentence, however many processes there are.
TEST_F(SeveralProcesses, WrongInputIsRefusedOnce) {
  const Words solve = Words{"solve", "room.toml", "-o", "S.vtp"} + quick();
  const Words other = Words{"solve", "boxes.toml", "-o", "S.vtp"} + quick();
  const Words finer = Words{"solve", "room.toml", "-o", "S.vtp", "--rays", "32"};
  const Words missing = Words{"solve", "none.toml", "-o", "S.vtp"};
  const auto refused = [&](const Ended& ended, const std::string& sentence) {
    EXPECT_TRUE(says(ended.err, sentence));
    EXPECT_EQ(count_of(ended.err, "error: "), 1) << ended.err;
    EXPECT_NE(ended.code, 0);
    EXPECT_FALSE(fs::exists(folder / "S.vtp"));
  };
  refused(side_by_side({program(solve), program(other)}),
          "the scene of process 1 is not that of process 0");
  refused(side_by_side({program(solve), program(solve), program(finer)}),
          "the list of options of process 2 is not that of process 0");
  refused(side_by_side({program(solve), program(missing)}), "process 1: ");
  refused(share(3, missing), "none.toml");
  refused(share(3, {"solve", "room.toml", "-o", "S.vtp", "--time", "5s"}),
          "--time is for one process");
  refused(share(3, {"info", "room.toml"}), "'info' runs in one process");
  refused(share(3, solve + Words{"--acuracy", "1%"}), "there is no option '--acuracy'");
  refused(share(2, Words{"solve", "room.toml", "-o", "no/folder/S.vtp"}), "there is no folder");
}

TEST_F(SeveralProcesses, MoreProcessesThanPatchesAreNoted) {
  folder.write("cube.obj", unit_cube());
  const Ended ended = share(7, {"form-factors", "cube.obj", "-o", "F.mtx"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(count_of(ended.err, "7 processes share the work of 6 patches"), 1) << ended.err;
}

// The second process may not write files of more than 64 kB, in which rows that have no room in
// memory do not fit. The budget is the one that a refusal asks for. Rows of 3750 patches go to disk
// even with 40 MB more.
TEST_F(SeveralProcesses, AFullDiskOfOneEndsAll) {
  folder.write("cube.obj", unit_cube());
  const Words factors = {"form-factors", "cube.obj",         "-o",   "F.mtx",   "--target-error",
                         "0.02",         "--max-patch-size", "0.04", "--memory"};
  const std::string refusal = share(2, factors + Words{"2M"}).err;
  const std::size_t at = refusal.find("Allow ");
  ASSERT_NE(at, std::string::npos) << refusal;
  const int needed = std::stoi(refusal.substr(at + 6));
  const Words small = program(factors + Words{std::to_string(needed) + "M"});
  const Words limited = Words{"sh", "-c", "ulimit -f 128; exec \"$@\"", "sh"} + small;
  const Ended ended = side_by_side({small, limited});
  EXPECT_EQ(ended.code, 1) << ended.err;
  EXPECT_TRUE(says(ended.err, "process 1: "));
  EXPECT_EQ(count_of(ended.err, "error: "), 1) << ended.err;
}

#else

TEST(SeveralProcesses, AreRefusedOnceWithoutMpi) {
  const TemporaryFolder folder;
  folder.write("room.toml", small_room());
  const Words solve = Words{"solve", "room.toml", "-o", "S.vtp"} + quick();
  const Variable size("OMPI_COMM_WORLD_SIZE", "2");
  for (const char* rank : {"0", "1"}) {
    const Variable number("OMPI_COMM_WORLD_RANK", rank);
    const Ended ended = run_lightwell(folder / "", solve);
    EXPECT_EQ(ended.code, 3);
    EXPECT_EQ(count_of(ended.err, "was built without MPI"), rank[0] == '0' ? 1 : 0) << ended.err;
    EXPECT_FALSE(fs::exists(folder / "S.vtp"));
  }
}

#endif

}  // namespace
}  // namespace lightwell::several_processes_test
