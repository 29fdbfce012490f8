// Help, and questions about input that is probably not what was meant.
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "tests/cli/program.h"

namespace lightwell::hints_test {
namespace {

class Hints : public CommandTest {};

std::string with(std::string text, std::string_view from, std::string_view to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
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
  const std::string room = with(small_room(), "max = [4, 3, 2.5]", "max = [4000, 3000, 2500]");
  folder.write("large.toml", room);
  folder.write("millimetres.toml", with(room, "unit = \"m\"", "unit = \"mm\""));
  EXPECT_TRUE(says(run({"info", "large.toml"}).out, "4000 m long"));
  EXPECT_TRUE(says(run({"info", "large.toml"}).out, "millimetres?"));
  EXPECT_FALSE(says(run({"info", "millimetres.toml"}).out, "millimetres?"));
}

// At 5e6 m floats are multiples of 0.5 m, and 5000000.5 is an odd one. A quarter of a metre is no
// float there, and whole metres are what a person may have written.
TEST_F(Hints, CoordinatesRoundedFarFromTheOriginAreAskedAbout) {
  const auto says_of_corner = [&](const std::string& y) {
    folder.write("far.obj", "v 500000 " + y + " 100\nv 500004 5000000 100\nv 500004 5000003 100\n" +
                                "f 1 2 3\n");
    return says(run({"info", "far.obj"}).out, "multiples of 0.5 m (single precision)");
  };
  EXPECT_TRUE(says_of_corner("5000000.5"));
  EXPECT_FALSE(says_of_corner("5000000.25"));
  EXPECT_FALSE(says_of_corner("5000001"));
  EXPECT_TRUE(says_of_corner("4999999.5"));
}

// A facet at 20 km is 5000 times as far from a room of 4 m as the walls are from the middle.
TEST_F(Hints, APartFarOutsideIsAskedAboutInPlaceOfTheUnit) {
  folder.write("stray.toml", small_room() +
                                 "[[surfaces]]\nname = \"crumb\"\nmaterial = \"white\"\n" +
                                 "polygon = [[2e4, 0, 0], [2e4, 1, 0], [2e4, 0, 1]]\n");
  const std::string said = run({"info", "stray.toml"}).out;
  EXPECT_TRUE(says(said, "'crumb' reaches 2e+04 m"));
  EXPECT_FALSE(says(said, "millimetres?"));
  folder.write("room.toml", small_room());
  EXPECT_FALSE(says(run({"info", "room.toml"}).out, "reaches"));
}

TEST_F(Hints, ALampFarOutsideIsAskedAbout) {
  const auto room_with_lamp_at = [](const char* height) {
    std::string room = small_room();
    room.append("[[lamps]]\nname = \"stray\"\npower = 10\nposition = [2, 1, ");
    return room.append(height).append("]\n");
  };
  folder.write("far.toml", room_with_lamp_at("2400"));
  folder.write("near.toml", room_with_lamp_at("2.3"));
  EXPECT_TRUE(says(run({"info", "far.toml"}).out, "'stray' lies"));
  EXPECT_FALSE(says(run({"info", "near.toml"}).out, "'stray' lies"));
}

}  // namespace
}  // namespace lightwell::hints_test
