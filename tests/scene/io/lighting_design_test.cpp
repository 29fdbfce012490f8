// The lighting design in a native file.
#include "scene/io/lighting_design.h"

#include <gtest/gtest.h>

#include <string>

#include "scene/errors.h"
#include "scene/io/luminaires/luminaire_file.h"
#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::lighting_design_test {
namespace {

const std::string room = R"(
unit = "cm"
[materials.white]
reflectance = 0.5
[[surfaces]]
name = "floor"
material = "white"
polygon = [[0, 0, 0], [400, 0, 0], [400, 300, 0], [0, 300, 0]]
)";

const std::string bracket =
    "[[lamps]]\nposition = [50, 50, 50]\naim = [0, 0, -1]\nfile = \"" LIGHTWELL_DOCS
    "/luminaires/bracket.ies\"\n";

class Design : public testing::Test {
 protected:
  LightingDesign read(const std::string& more) {
    return read_lighting_design(read_scene(folder.write("room.toml", room + more)));
  }
  std::string refused(const std::string& more) {
    return message_of<InputError>([&] { read(more); });
  }
  TemporaryFolder folder;
};

TEST_F(Design, HasTheGridsInMetres) {
  const LightingDesign design = read(R"(
[[grids]]
name = "task area"
surface = "floor"
height = 75
margin = 0
spacing = 20
[[grids]]
surface = "floor"
)");
  ASSERT_EQ(design.grids.size(), 2u);
  EXPECT_EQ(design.grids[0].name, "task area");
  EXPECT_EQ(design.grids[0].surface, 0);
  EXPECT_DOUBLE_EQ(design.grids[0].height, 0.75);
  EXPECT_EQ(design.grids[0].margin, 0.0);
  EXPECT_DOUBLE_EQ(design.grids[0].spacing, 0.2);
  EXPECT_EQ(design.grids[1].name, "grid2");
  EXPECT_FALSE(design.grids[1].margin.has_value());
}

/// The key `watts` takes precedence over the photometric file. A flux other than the file's belongs
/// to another luminaire, of unknown power.
TEST_F(Design, KnowsThePowerOfLamps) {
  const double of_file = read_luminaire(LIGHTWELL_DOCS "/luminaires/bracket.ies").watts;
  ASSERT_GT(of_file, 0.0);
  const LightingDesign design =
      read(bracket + bracket + "watts = 7\n" + bracket + "lumens = 100\n" +
           "[[lamps]]\nposition = [1, 1, 1]\nlumens = 800\nwatts = 8.5\n" +
           "[[lamps]]\nposition = [2, 1, 1]\nlumens = 800\n");
  EXPECT_EQ(design.watts, (std::vector<double>{of_file, 7.0, 0.0, 8.5, 0.0}));
  EXPECT_EQ(design.luminous_height.size(), 5u);
}

TEST_F(Design, DoesNotChangeTheScene) {
  const auto hash = [&](const std::string& more) {
    return scene_hash(read_scene(folder.write("room.toml", room + more)));
  };
  EXPECT_EQ(hash(bracket + "watts = 9\n[[grids]]\nsurface = \"floor\"\n"), hash(bracket));
}

TEST_F(Design, RefusesGridsOfNothing) {
  EXPECT_TRUE(says(refused("[[grids]]\nsurface = \"flor\"\n"), "Did you mean 'floor'?"));
  EXPECT_TRUE(says(refused("[[grids]]\nname = \"a\"\n"), "surface"));
  EXPECT_TRUE(says(refused("[[grids]]\nsurface = \"floor\"\nheight = -1\n"), "height of grid"));
  EXPECT_TRUE(says(refused("[[grids]]\nsurface = \"floor\"\nspacing = 0\n"), "spacing of grid"));
  EXPECT_TRUE(says(refused("[[grids]]\nname = \"a\"\nsurface = \"floor\"\n[[grids]]\nname = "
                           "\"a\"\nsurface = \"floor\"\n"),
                   "name of another grid"));
  EXPECT_TRUE(says(refused("[grids]\nsurface = \"floor\"\n"), "write [[grids]]"));
  EXPECT_TRUE(says(refused(bracket + "watts = 0\n"), "watts"));
}

}  // namespace
}  // namespace lightwell::lighting_design_test
