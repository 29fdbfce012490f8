#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "scene/errors.h"
#include "standards/road/road.h"
#include "tests/temporary_folder.h"

namespace lightwell::road_file_test {
namespace {

// A road beside the luminaire of the examples, with one text in place of another.
class RoadFile : public testing::Test {
 protected:
  RoadFile() {
    std::filesystem::copy_file(LIGHTWELL_TEST_DATA "/../../examples/road/luminaires/street.ies",
                               folder / "street.ies");
  }
  std::filesystem::path written(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    folder.write("road.toml", text.replace(at, from.size(), to));
    return folder / "road.toml";
  }
  std::string refusal(const std::string& from, const std::string& to) {
    return message_of<InputError>([&] { read_road(written(plain, from, to)); });
  }
  void expect(const std::string& from, const std::string& to, const std::string& words) {
    EXPECT_TRUE(says(refusal(from, to), words)) << to;
  }

  TemporaryFolder folder;
  const std::string plain = R"(
[road]
width = 7
lanes = 2
class = "M3"
[luminaires]
file = "street.ies"
spacing = 30
height = 8
[[strips]]
side = "right"
width = 2
)";
};

TEST_F(RoadFile, HasTheDefaultsOfTheGuide) {
  const Road road = read_road(written(plain, "M3", "M4"));
  EXPECT_EQ(road.title, "road");
  EXPECT_EQ(road.surface.name, "R3");
  EXPECT_EQ(road.oncoming, 0);
  EXPECT_FALSE(road.drives_on_left);
  EXPECT_EQ(road.classes.front().key, "M4");
  EXPECT_EQ(road.luminaires.arrangement, RoadArrangement::single_right);
  EXPECT_EQ(road.luminaires.watts, 40.0);  // of the photometric file
  EXPECT_EQ(road.luminaires.maintenance, 1.0);
  EXPECT_EQ(road.strips.front().name, "strip 1");
}

/// Another flux is another lamp, whose power the photometric file does not know.
TEST_F(RoadFile, ScalesFluxAndSurface) {
  const Road road = read_road(written(plain, "spacing", "lumens = 1000\nspacing"));
  EXPECT_NEAR(road.luminaires.flux_factor * road.luminaires.file->flux(), 1000.0, 1e-9);
  EXPECT_EQ(road.luminaires.watts, 0.0);
  const Road light = read_road(written(plain, "class", "surface = \"R1\"\nq0 = 0.05\nclass"));
  EXPECT_NEAR(light.surface.r(0, 0), 0.5 * 655e-4, 1e-15);
  folder.write("mine.csv", "0 180\n0 300 300\n12 1 1\n");
  EXPECT_EQ(read_road(written(plain, "class", "surface = \"mine.csv\"\nclass")).surface.name,
            "mine.csv");
}

TEST_F(RoadFile, IsRefusedWithASentence) {
  expect("M3", "N3", "no class of EN 13201-2");
  expect("\"M3\"", "[]", "is empty");
  expect("class = \"M3\"", "", "has no class");
  expect("width = 7", "", "width");
  expect("lanes = 2", "lanes = 0", "lanes");
  expect("lanes = 2", "lanes = 2\noncoming_lanes = 3", "oncoming_lanes");
  expect("class", "surface = \"R5\"\nclass", "neither 'R1', 'R2'");
  expect("street.ies", "none.ies", "none.ies");
  expect("spacing = 30", "spacing = 0", "spacing");
  expect("height = 8", "height = 1", "height");
  expect("height = 8", "height = 8\narrangement = \"median\"", "write its width as 'median'");
  expect("lanes = 2", "lanes = 2\nmedian = 2", "arrangement = \"median\"");
  expect("side = \"right\"", "side = \"right\"\nclass = \"M3\"", "for carriageways");
  expect("side = \"right\"", "side = \"right\"\nname = \"carriageway\"", "taken");
  expect("[[strips]]", "[strips]", "[[strips]]");
  expect("lanes = 2", "lanes = 2\ncolour = 1", "colour");
  expect("M3", "P7", "no limit, so there is nothing to hold the road to");
  expect("class = \"M3\"", "class = \"C3\"\nwet_surface = \"R4\"", "no M class");
  expect("lanes = 2", "lanes = 2\nq0 = 1.0", "q0");
}

/// Strips may touch each other and fill the median, and no more.
TEST_F(RoadFile, RefusesStripsThatOverlap) {
  const auto second = [](const std::string& side, const std::string& gap) {
    return "[[strips]]\nname = \"path\"\nside = \"" + side + "\"\nwidth = 1\ngap = " + gap +
           "\n[[strips]]";
  };
  expect(
      "[[strips]]", second("right", "1.5"),
      "'strip 2' reaches to 2 m from the carriageway, and 'path' begins at 1.5 m; make its 'gap' "
      "2 or more");
  EXPECT_EQ(refusal("[[strips]]", second("right", "2")), "");
  EXPECT_EQ(refusal("[[strips]]", second("left", "0")), "");
  const std::string median = "median = 3\nlanes = 2";
  const auto with_median = [&](const std::string& strips) {
    std::string text = plain;
    text.replace(text.find("lanes = 2"), 9, median);
    text.replace(text.find("spacing"), 7, "arrangement = \"median\"\nspacing");
    return message_of<InputError>([&] { read_road(written(text, "[[strips]]", strips)); });
  };
  EXPECT_EQ(with_median(second("left", "2")), "");
  EXPECT_TRUE(says(with_median(second("left", "2.5")),
                   "reach over the median: 'path' ends 3.5 m from the carriageway"));
  EXPECT_EQ(with_median(second("right", "2.5")), "");
}

}  // namespace
}  // namespace lightwell::road_file_test
