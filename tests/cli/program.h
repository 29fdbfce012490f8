#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace lightwell {

/// Exit code and output of a run of the built lightwell.
struct Ended {
  int code = -1;    ///< exit code; -signal if a signal ended it
  std::string out;  ///< standard output
  std::string err;  ///< standard error
};

/// The lightwell command as a child process with working folder `folder`. Standard output and
/// standard error go to files outside of `folder`.
class Running {
 public:
  Running(const std::filesystem::path& folder, const std::vector<std::string>& arguments);
  /// Any command: its program and arguments.
  static std::unique_ptr<Running> command(const std::filesystem::path& folder,
                                          const std::vector<std::string>& words);
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void signal(int number) const;
  int process() const { return process_; }
  /// Text on standard error so far.
  std::string err() const;
  /// Text on standard output so far.
  std::string out() const;
  Ended wait();

 private:
  struct Words {
    std::vector<std::string> of{};
  };
  Running(const std::filesystem::path& folder, const Words& words);

  TemporaryFolder said_;
  int process_ = -1;
};

Ended run_lightwell(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

/// A test with an empty folder in which it runs the command.
class CommandTest : public testing::Test {
 protected:
  Ended run(const std::vector<std::string>& arguments) {
    return run_lightwell(folder / "", arguments);
  }
  /// Standard output of the command with --json; throws unless that is exactly one JSON value.
  nlohmann::json run_json(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return nlohmann::json::parse(ended.out);
  }
  TemporaryFolder folder;
};

/// A room of 4 m x 3 m x 2.5 m with a luminous panel of 1 m^2 under its ceiling and the camera
/// "door". With quick() a solve takes a moment.
std::string small_room();
/// small_room() with these tables of TOML before its camera.
std::string small_room_with(const std::string& tables);
/// An OBJ file of the unit cube, six squares that face inwards.
std::string unit_cube();

/// Coarse options for small_room().
std::vector<std::string> quick();

/// `a` followed by `b`.
std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b);

}  // namespace lightwell
