#include "design/limits_file.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "scene/errors.h"
#include "tests/temporary_folder.h"

namespace lightwell::limits_file_test {
namespace {

LightingLimits read(const std::string& text) {
  const TemporaryFolder folder;
  return read_limits(folder.write("limits.toml", text));
}

// Each text is refused with a sentence that names the file and holds the other string.
void expect_refusals(const std::vector<std::pair<std::string, std::string>>& cases) {
  for (const auto& [text, sentence] : cases) {
    try {
      read(text);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << text << "\n"
                                                                             << error.what();
      EXPECT_NE(std::string(error.what()).find("limits.toml"), std::string::npos) << error.what();
    }
  }
}

TEST(LimitsFile, HoldsLimitsInTheirOrder) {
  const LightingLimits limits = read(R"(
maintenance = 0.8
[[limits]]
grid = "desk"
uniformity_at_least = 0.6
mean_at_least = 500
[[limits]]
grid = "wall"
greatest_at_most = 300
[[glare]]
observer = "seat"
ugr_at_most = 19
[dimming]
least = 0.1
groups = [["row *", "spot"], ["wall washer"]]
[[move]]
luminaires = ["row *"]
axes = "zx"
lowest = [-1, 2.0]
highest = [3.5, 2.8]
apart = 0.5
)");
  EXPECT_DOUBLE_EQ(limits.maintenance_factor.value(), 0.8);
  EXPECT_DOUBLE_EQ(limits.least_level, 0.1);
  ASSERT_EQ(limits.limits.size(), 4u);
  EXPECT_EQ(limits.limits[0].kind, LimitKind::mean_at_least);
  EXPECT_DOUBLE_EQ(limits.limits[0].value, 500.0);
  EXPECT_EQ(limits.limits[1].kind, LimitKind::uniformity_at_least);
  EXPECT_EQ(limits.limits[1].place, "desk");
  EXPECT_EQ(limits.limits[2].place, "wall");
  EXPECT_EQ(limits.limits[3].kind, LimitKind::ugr_at_most);
  EXPECT_EQ(limits.limits[3].place, "seat");
  EXPECT_NE(limits.limits[3].origin.find("limits.toml:10:1: glare of observer 'seat'"),
            std::string::npos)
      << limits.limits[3].origin;
  ASSERT_EQ(limits.groups.size(), 2u);
  EXPECT_EQ(limits.groups[0].names, (std::vector<std::string>{"row *", "spot"}));
  ASSERT_EQ(limits.moves.size(), 1u);
  EXPECT_EQ(limits.moves[0].axes, (std::vector<int>{0, 2}));
  EXPECT_EQ(limits.moves[0].lowest, (std::vector<double>{-1.0, 2.0}));
  EXPECT_EQ(limits.moves[0].highest, (std::vector<double>{3.5, 2.8}));
  EXPECT_DOUBLE_EQ(limits.moves[0].apart, 0.5);
}

TEST(LimitsFile, MovesAreRefusedWithALineAndASentence) {
  const std::string limit = "[[glare]]\nobserver = \"eye\"\nugr_at_most = 19\n";
  const std::string move = limit + "[[move]]\nluminaires = [\"spot\"]\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"move = 3\n" + limit, "write [[move]]"},
      {limit + "[[move]]\naxes = \"x\"\nlowest = [0]\nhighest = [1]\n", "luminaires"},
      {limit + "[[move]]\nluminaires = []\naxes = \"x\"\nlowest = [0]\nhighest = [1]\n",
       "is empty"},
      {move + "lowest = [0]\nhighest = [1]\n", "axes"},
      {move + "axes = \"xw\"\nlowest = [0, 0]\nhighest = [1, 1]\n", "is 'xw'; write the axes"},
      {move + "axes = \"xx\"\nlowest = [0, 0]\nhighest = [1, 1]\n", "write each axis once"},
      {move + "axes = \"\"\nlowest = []\nhighest = []\n", ":6:"},
      {move + "axes = \"xy\"\nlowest = [0]\nhighest = [1, 1]\n",
       "must have as many numbers as there are axes, 2, in the order x, y, z; it has 1"},
      {move + "axes = \"xy\"\nlowest = [0, 2]\nhighest = [1, 1]\n", "below the lowest place, 2"},
      {move + "axes = \"x\"\nlowest = [nan]\nhighest = [1]\n", ":7:"},
      {move + "axes = \"x\"\nlowest = [0]\nhighest = [1]\napart = -1\n", ":9:"},
      {move + "axes = \"x\"\nlowest = [0]\nhighest = [1]\nstep = 1\n", "step"}};
  expect_refusals(cases);
}

TEST(LimitsFile, IsRefusedWithALineAndASentence) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "there are no limits"},
      {"maintenance = 0.8\n", "there are no limits"},
      {"maintenance = 0\n", ":1:"},
      {"maintenance = 1.2\n", "is above 1"},
      {"limits = 3\n", "write [[limits]]"},
      {"[[limits]]\ngrid = \"desk\"\n", "limit nothing"},
      {"[[limits]]\nmean_at_least = 5\n", "grid"},
      {"[[limits]]\ngrid = \"desk\"\nmean_at_least = -5\n", ":3:"},
      {"[[limits]]\ngrid = \"desk\"\nuniformity_at_least = 1.5\n", "is above 1"},
      {"[[limits]]\ngrid = \"desk\"\nmean_atleast = 5\n", "mean_at_least"},
      {"[[limits]]\ngrid = \"desk\"\nmean_at_least = 500\nmean_at_most = 300\n", "cannot be met"},
      {"[[limits]]\ngrid = \"desk\"\nleast_at_least = 9\ngreatest_at_most = 3\n", "cannot be met"},
      {"[[limits]]\ngrid = \"a\"\nmean_at_least = 5\n[[limits]]\ngrid = \"a\"\nmean_at_most = 9\n",
       "one [[limits]] table for each"},
      {"[[glare]]\nobserver = \"eye\"\n", "ugr_at_most"},
      {"[[glare]]\nobserver = \"eye\"\nugr_at_most = 0\n", ":3:"},
      {"[[glare]]\nobserver = \"eye\"\nugr_at_most = 19\n[dimming]\nleast = 2\n", ":5:"},
      {"[[glare]]\nobserver = \"eye\"\nugr_at_most = 19\n[dimming]\ngroups = [[]]\n", "is empty"}};
  expect_refusals(cases);
}

}  // namespace
}  // namespace lightwell::limits_file_test
