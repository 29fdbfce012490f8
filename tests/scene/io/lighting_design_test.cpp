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

TEST_F(Design, HasOutlinesOfGridsInMetres) {
  const std::string grid = "[[grids]]\nsurface = \"floor\"\n";
  const std::string outline = "outline = [[0, 0, 0], [200, 0, 0], [0, 300, 0]]\n";
  const std::string holes = "holes = [[[10, 10, 0], [20, 10, 0], [10, 20, 0]]]\n";
  const LightingDesign design = read(grid + outline + holes);
  ASSERT_EQ(design.grids[0].outline.size(), 2u);
  EXPECT_EQ(design.grids[0].outline[0][2], Eigen::Vector3d(0, 3, 0));
  EXPECT_EQ(design.grids[0].outline[1][1], Eigen::Vector3d(0.2, 0.1, 0));
  const std::string part = "part = { min = [0, 0, 0], max = [1, 1, 0] }\n";
  EXPECT_NE(refused(grid + outline + part).find("beside 'part'"), std::string::npos);
  EXPECT_NE(refused(grid + holes).find("need an 'outline'"), std::string::npos);
  EXPECT_NE(refused(grid + "outline = [[0, 0, 0], [1, 0, 0]]\n").find("fewer than three"),
            std::string::npos);
}

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

const std::string furnished = R"(
[[cameras]]
name = "chair"
position = [200, 100, 120]
look_at = [0, 100, 120]
[[grids]]
name = "task"
surface = "floor"
height = 75
part = { min = [100, 100, 0], max = [200, 160, 0] }
[[grids]]
name = "surround"
surface = "floor"
height = 75
leaves_out = ["task"]
[[grids]]
name = "face"
surface = "floor"
height = 120
measures = "semicylindrical"
facing = [0, 2, 0]
)";

TEST_F(Design, HasPartsAndQuantitiesOfGrids) {
  const LightingDesign design = read(furnished);
  ASSERT_EQ(design.grids.size(), 3u);
  ASSERT_TRUE(design.grids[0].part.has_value());
  EXPECT_TRUE(design.grids[0].part->min().isApprox(Eigen::Vector3d(1.0, 1.0, 0.0)));
  EXPECT_TRUE(design.grids[0].part->max().isApprox(Eigen::Vector3d(2.0, 1.6, 0.0)));
  EXPECT_EQ(design.grids[1].leaves_out, std::vector<int>{0});
  EXPECT_EQ(design.grids[2].quantity, GridQuantity::semicylindrical);
  EXPECT_TRUE(design.grids[2].facing.isApprox(Eigen::Vector3d::UnitY()));
}

TEST_F(Design, HasAreasOfTwoStandards) {
  const LightingDesign design = read(furnished + R"(
[maintenance]
lamp_flux = 0.9
room = 0.95
[[areas]]
name = "desk"
activity = "writing"
raised = true
grid = "task"
surround = "surround"
walls = "fl*"
observers = ["chair"]
eye_height = 160
[[areas]]
emergency = "high-risk task area"
grid = "task"
usual_lux = 500
[energy]
surface = "floor"
daylight_hours = 2250
night_hours = 250
occupancy = 0.9
)");
  ASSERT_EQ(design.areas.size(), 2u);
  const DesignArea& desk = design.areas[0];
  EXPECT_EQ(desk.activity, "writing");
  EXPECT_TRUE(desk.is_raised);
  EXPECT_EQ(desk.grid, 0);
  EXPECT_EQ(desk.surround, 1);
  EXPECT_FALSE(desk.background.has_value());
  EXPECT_EQ(desk.walls, std::vector<int>{0});
  EXPECT_EQ(desk.observers, std::vector<std::string>{"chair"});
  EXPECT_DOUBLE_EQ(desk.eye_height, 1.6);
  EXPECT_EQ(design.areas[1].name, "area2");
  EXPECT_EQ(design.areas[1].emergency, EmergencyArea::high_risk_task_area);
  EXPECT_EQ(design.areas[1].usual_lux, 500.0);
  ASSERT_TRUE(design.maintenance.has_value());
  EXPECT_DOUBLE_EQ(design.maintenance->factor(), 0.9 * 0.95);
  ASSERT_TRUE(design.use.has_value());
  EXPECT_EQ(design.use->night_hours, 250.0);
}

TEST_F(Design, SaysWhatIsWrongWithAreas) {
  const auto says = [&](const std::string& tables, const std::string& sentence) {
    const std::string message = refused(furnished + tables);
    EXPECT_NE(message.find(sentence), std::string::npos) << message;
  };
  says("[[areas]]\nactivity = \"writing\"\ngrid = \"tusk\"\n", "Did you mean 'task'?");
  says("[[areas]]\ngrid = \"task\"\n", "activity");
  says("[[areas]]\nactivity = \"writing\"\ngrid = \"task\"\nwalls = [\"west\"]\n",
       "no surface or material of the scene matches that");
  says("[[areas]]\nactivity = \"writing\"\ngrid = \"task\"\nobservers = [\"door\"]\n",
       "there is no camera of that name");
  says("[[areas]]\nemergency = \"open area\"\ngrid = \"task\"\nusual_lux = 3\n",
       "only a high-risk task area has");
  says("[[areas]]\nemergency = \"high-risk task area\"\ngrid = \"task\"\n", "needs 'usual_lux'");
  says("[[grids]]\nsurface = \"floor\"\nmeasures = \"vertical\"\n", "needs 'facing'");
  says("[[grids]]\nsurface = \"floor\"\nleaves_out = [\"later\"]\n",
       "there is no [[grids]] table of that name before it");
  says("[maintenance]\nroom = 1.5\n", "room");
  says("[energy]\nsurface = \"floor\"\ndaylight_hours = 8000\nnight_hours = 1000\n",
       "more hours of use than the 8760 of a year");
}

}  // namespace
}  // namespace lightwell::lighting_design_test
