// Manual pages, completions and the demonstration: what an installation gives to its user.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace lightwell {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), none; at != none; ++at) {
    found.push_back((*at)[1].str());
  }
  return found;
}

// The long options that a --help lists.
std::vector<std::string> options_of(const std::string& help) {
  return matches(help, std::regex("(?:^|\\n)  (?:-[a-z],)?(--[a-z][a-z0-9-]*)"));
}

std::string without_backslashes(std::string text) {
  std::erase(text, '\\');
  return text;
}

class Installed : public CommandTest {
 protected:
  // The commands that the program's manual page lists.
  std::vector<std::string> commands() {
    EXPECT_EQ(run({"manual", "-o", "man1"}).code, 0);
    const std::string page = content_of(folder / "man1/lightwell.1");
    const std::size_t begin = page.find(".SH COMMANDS");
    const std::string list = page.substr(begin, page.find(".SH OPTIONS") - begin);
    return matches(without_backslashes(list), std::regex("fB([a-z-]+)fR"));
  }
  std::string help(const std::string& command) { return run({command, "--help"}).out; }
  std::string script(const std::string& shell) {
    const Ended ended = run({"completion", shell});
    EXPECT_EQ(ended.code, 0);
    return ended.out;
  }
  // The words that bash offers for the last of `words`.
  std::string offered(const std::vector<std::string>& words) {
    folder.write("completion", script("bash"));
    std::ofstream ask(folder / "ask");
    ask << "cd '" << (folder / "").string() << "'\n. ./completion\nCOMP_WORDS=(";
    for (const std::string& word : words) ask << " '" << word << "'";
    ask << ")\nCOMP_CWORD=" << words.size() - 1 << "\n_lightwell\necho ${COMPREPLY[*]} > answer\n";
    ask.close();
    EXPECT_EQ(std::system(("bash '" + (folder / "ask").string() + "'").c_str()), 0);
    std::string answer = content_of(folder / "answer");
    std::erase(answer, '\n');
    return answer;
  }
};

TEST_F(Installed, EveryOptionOfTheHelpIsOnTheManualPage) {
  const std::vector<std::string> all = commands();
  for (const char* const name : {"run", "solve", "render", "view", "daylight", "demo", "info"}) {
    EXPECT_EQ(std::ranges::count(all, name), 1) << name;
  }
  for (const std::string& command : all) {
    const std::string page =
        without_backslashes(content_of(folder / ("man1/lightwell-" + command + ".1")));
    const std::vector<std::string> options = options_of(help(command));
    EXPECT_GE(options.size(), 5u) << command;  // those of every command
    const std::string name = page.substr(0, page.find(".SH SYNOPSIS"));
    EXPECT_EQ(std::ranges::count(name, '('), std::ranges::count(name, ')')) << name;
    for (const std::string& option : options) {
      EXPECT_NE(page.find("fB" + option + "fR"), std::string::npos) << command << " " << option;
    }
  }
}

TEST_F(Installed, ManualPagesHoldOptionsThatTheHelpHasNoRoomFor) {
  ASSERT_EQ(run({"manual", "-o", "man1"}).code, 0);
  const std::string page = without_backslashes(content_of(folder / "man1/lightwell-run.1"));
  EXPECT_EQ(help("run").find("--photons"), std::string::npos);
  EXPECT_NE(page.find("fB--photonsfR"), std::string::npos);
}

TEST_F(Installed, EveryShellKnowsEveryOption) {
  const std::string bash = script("bash"), zsh = script("zsh"), fish = script("fish");
  for (const std::string& command : commands()) {
    for (const std::string& option : options_of(help(command))) {
      const std::string word = option.substr(2);
      EXPECT_NE(bash.find(option), std::string::npos) << option;
      EXPECT_NE(zsh.find("'*" + option + "["), std::string::npos) << option;
      EXPECT_TRUE(std::regex_search(
          fish, std::regex("__fish_seen_subcommand_from " + command + "'[^\n]* -l " + word + " ")))
          << command << " " << option;
    }
  }
}

TEST_F(Installed, BashCompletes) {
  folder.write("room.toml", "");
  EXPECT_EQ(offered({"lightwell", "sol"}), "solve");
  EXPECT_EQ(offered({"lightwell", "render", "--gather-s"}), "--gather-samples");
  EXPECT_EQ(offered({"lightwell", "render", "--pass", "g"}), "gather");
  EXPECT_EQ(offered({"lightwell", "run", "--threads", ""}), "");
  EXPECT_EQ(offered({"lightwell", "solve", "roo"}), "room.toml");
  EXPECT_EQ(offered({"lightwell", "completion", ""}), "bash zsh fish");
  EXPECT_EQ(offered({"lightwell", "render", "--pass", "=", "g"}), "gather");  // --pass=g
  fs::create_directory(folder / "rooms");
  EXPECT_EQ(offered({"lightwell", "run", "-o", "roo"}), "rooms");
}

TEST_F(Installed, UnknownShellsAreNamed) {
  const Ended ended = run({"completion", "tcsh"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended.err, "'tcsh'; choose from: bash, zsh, fish"));
}

TEST_F(Installed, DemoMakesAPictureWithoutAnyFile) {
  const Ended ended = run({"demo", "--no-window"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(content_of(folder / "lightwell-demo/cornell.toml"), content_of(CORNELL_SCENE));
  for (const char* const made : {"solution.vtp", "report.json", "diffuse.png", "diffuse.exr"}) {
    EXPECT_TRUE(fs::exists(folder / "lightwell-demo" / made)) << made;
  }
  EXPECT_TRUE(says(ended.err, "lightwell view lightwell-demo/cornell.toml"));
}

TEST_F(Installed, DemoKeepsASceneThatWasEdited) {
  fs::create_directory(folder / "mine");
  folder.write("mine/cornell.toml", small_room());
  const Ended ended = run({"demo", "--no-window", "-o", "mine"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(content_of(folder / "mine/cornell.toml"), small_room());
  EXPECT_TRUE(fs::exists(folder / "mine/door.png"));
  EXPECT_TRUE(says(ended.err, "'mine/cornell.toml' is there already"));
}

TEST_F(Installed, ASolutionAloneFindsItsScene) {
  fs::create_directory(folder / "far");
  folder.write("far/room.toml", small_room());
  ASSERT_EQ(run(std::vector<std::string>{"solve", "far/room.toml", "-o", "S.vtp"} + quick()).code,
            0);
  // A camera that does not exist is refused once the scene was found and read.
  const std::vector<std::string> view{"view", "S.vtp", "--camera", "roof", "--offscreen", "a.png"};
  EXPECT_TRUE(says(run(view).err, "roof"));
  // Another room of that name where the solve ran does not stand for the scene beside the solution.
  fs::copy(folder / "S.vtp", folder / "far/S.vtp");
  folder.write("room.toml", "torn");
  std::vector<std::string> far = view;
  far[1] = "far/S.vtp";
  EXPECT_TRUE(says(run(far).err, "roof"));
  fs::rename(folder / "far/room.toml", folder / "room.toml");
  EXPECT_TRUE(says(run(view).err, "roof")) << "beside the solution";
  fs::remove(folder / "room.toml");
  const Ended lost = run(view);
  EXPECT_EQ(lost.code, 3);
  EXPECT_TRUE(says(lost.err, "'far/room.toml', is neither there nor beside"));
}

}  // namespace
}  // namespace lightwell
