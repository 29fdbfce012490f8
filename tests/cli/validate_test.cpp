// The command that compares the program with known answers.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/cli/program.h"

namespace lightwell::validate_command_test {
namespace {

using Words = std::vector<std::string>;

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class Validate : public CommandTest {};

TEST_F(Validate, NeedsNoFileAndPrintsATableAndAVerdict) {
  const Ended ended = run({"validate", "--only", "ugr-*"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(says(ended.out, "expected     computed"));
  EXPECT_TRUE(says(ended.out, "ugr-one"));
  EXPECT_TRUE(says(ended.out, "8 of 8 cases pass in "));
  EXPECT_EQ(ended.err, "");
}

TEST_F(Validate, JsonIsTheContracts) {
  const auto json = run_json({"validate", "--only", "guth"});
  EXPECT_EQ(json["passed"], 1);
  EXPECT_EQ(json["failed"], 0);
  EXPECT_EQ(json["cases"][0]["id"], "guth-position-index");
  EXPECT_EQ(json["cases"][0]["pass"], true);
}

TEST_F(Validate, WritesItsPages) {
  const Ended ended = run({"validate", "--only", "guth", "--html", "v.html", "--markdown", "v.md",
                           "--json-file", "v.json", "--quiet"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.out + ended.err, "");
  for (const char* file : {"v.html", "v.md", "v.json"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
  }
}

TEST_F(Validate, ListNamesCasesAndRunsNone) {
  const Ended ended = run({"validate", "--list", "--only", "cie 171"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_TRUE(says(ended.out, "cie171-5.10-4x4"));
  EXPECT_FALSE(says(ended.out, "pass"));
}

TEST_F(Validate, PatternsThatMatchNothingAreRefused) {
  const Ended ended = run({"validate", "--only", "furnance-mixed"});
  EXPECT_EQ(ended.code, 3);
  EXPECT_TRUE(says(ended.err, "'furnance-mixed'") && says(ended.err, "furnace-mixed")) << ended.err;
}

TEST_F(Validate, FilesThatCannotBeWrittenAreRefusedBeforeTheWork) {
  for (const char* option : {"--html", "--markdown", "--json-file"}) {
    const Ended ended = run({"validate", option, "no-such-folder/v"});
    EXPECT_EQ(ended.code, 1) << option;
    EXPECT_TRUE(says(ended.err, "no-such-folder")) << ended.err;
    EXPECT_EQ(ended.out, "");
  }
}

// Cases of files do not fail where the machine cannot hold the files.
TEST_F(Validate, AMachineWithoutATemporaryFolderIsNoFailedCase) {
  const std::string err = (folder / "err").string();
  const std::string command = "TMPDIR=/no-such-folder '" LIGHTWELL_PROGRAM
                              "' validate --only ies-spot > '" +
                              err + "' 2>&1";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_TRUE(says(content_of(err), "TMPDIR"));
}

// All cases take a minute; a run that is told to stop after its first line ends with what is done.
TEST_F(Validate, InterruptKeepsWhatIsDone) {
  Running program(folder / "", {"validate", "--json-file", "v.json"});
  while (program.out().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  program.signal(SIGINT);
  const Ended ended = program.wait();
  EXPECT_EQ(ended.code, 130);
  EXPECT_TRUE(says(ended.out, "were not reached")) << ended.out;
  EXPECT_TRUE(std::filesystem::exists(folder / "v.json"));
}

}  // namespace
}  // namespace lightwell::validate_command_test
