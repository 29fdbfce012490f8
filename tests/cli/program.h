#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace lightwell {

/// How a run of the built lightwell ended and what it said.
struct Ended {
  int code = -1;    ///< exit code; -signal if a signal ended it
  std::string out;  ///< standard output
  std::string err;  ///< standard error
};

/// The lightwell command as a child process, with its working folder in `folder`. What it says goes
/// to files outside that folder.
class Running {
 public:
  Running(const std::filesystem::path& folder, const std::vector<std::string>& arguments);
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void signal(int number) const;
  /// What it has said on standard error up to now.
  std::string err() const;
  Ended wait();

 private:
  TemporaryFolder said_;
  int process_ = -1;
};

Ended run_lightwell(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

/// A folder of its own, and the command run in it.
class CommandTest : public testing::Test {
 protected:
  Ended run(const std::vector<std::string>& arguments) {
    return run_lightwell(folder / "", arguments);
  }
  /// With --json; throws unless standard output is one value and nothing else.
  nlohmann::json run_json(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return nlohmann::json::parse(ended.out);
  }
  TemporaryFolder folder;
};

/// A room 4 m x 3 m x 2.5 m with a luminous panel under its ceiling and the camera "door"; small
/// enough to solve in a moment with `quick`.
std::string small_room();
/// The unit cube from inside, as an OBJ file of six squares.
std::string unit_cube();

/// Coarse options for small_room().
std::vector<std::string> quick();

/// `a` followed by `b`.
std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b);

}  // namespace lightwell
