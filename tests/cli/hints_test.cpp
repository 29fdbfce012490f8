// Help, and questions about input that is probably not what was meant.
#include <gtest/gtest.h>

#include <string>

#include "tests/cli/program.h"

namespace lightwell::hints_test {
namespace {

class Hints : public CommandTest {};

std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST_F(Hints, HelpIsThatOfTheOptionsOfTheSameName) {
  EXPECT_EQ(run({"help"}).out, run({}).out);
  const Ended of_probe = run({"help", "probe"});
  EXPECT_EQ(of_probe.code, 0);
  EXPECT_EQ(of_probe.out, run({"probe", "--help"}).out);
  EXPECT_EQ(run({"help", "prob"}).code, 2);
}

// The room of 4 m x 3 m x 2.5 m in millimetres, read as metres, is 4000 m long.
TEST_F(Hints, ARoomOfKilometresIsAskedAbout) {
  std::string room = with(small_room(), "max = [4, 3, 2.5]", "max = [4000, 3000, 2500]");
  folder.write("large.toml", room);
  folder.write("millimetres.toml", with(room, "unit = \"m\"", "unit = \"mm\""));
  EXPECT_TRUE(says(run({"info", "large.toml"}).out, "4000 m long"));
  EXPECT_TRUE(says(run({"info", "large.toml"}).out, "millimetres?"));
  EXPECT_FALSE(says(run({"info", "millimetres.toml"}).out, "millimetres?"));
}

TEST_F(Hints, ALampFarOutsideIsAskedAbout) {
  const std::string lamp = "[[lamps]]\nname = \"stray\"\npower = 10\nposition = [2, 1, 2400]\n";
  folder.write("far.toml", small_room() + lamp);
  folder.write("near.toml", small_room() + with(lamp, "2400", "2.3"));
  EXPECT_TRUE(says(run({"info", "far.toml"}).out, "'stray' lies"));
  EXPECT_FALSE(says(run({"info", "near.toml"}).out, "stray"));
}

}  // namespace
}  // namespace lightwell::hints_test
