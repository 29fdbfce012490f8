#include <gtest/gtest.h>

#include <string>

#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "scene/io/window_states.h"
#include "tests/temporary_folder.h"

namespace lightwell::read_windows_test {
namespace {

const std::string room = R"([materials.clear]
glass = { ior = 1.5, thin = true }
[materials.fabric]
translucent = 0.05
reflectance = 0.5
[materials.white]
reflectance = 0.7
[[surfaces]]
name = "floor"
material = "white"
polygon = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]
[[surfaces]]
name = "pane 1"
material = "clear"
polygon = [[0, 0, 1], [1, 0, 1], [1, 0, 2], [0, 0, 2]]
[[surfaces]]
name = "pane 2"
material = "clear"
polygon = [[2, 0, 1], [3, 0, 1], [3, 0, 2], [2, 0, 2]]
)";

const std::string states =
    "states = [{ name = \"open\" }, { name = \"blind\", material = \"fabric\" }]\n";

class ReadWindows : public testing::Test {
 protected:
  OperatedWindows read(const std::string& windows) const {
    return read_windows(read_scene(folder.write("room.toml", room + windows)));
  }
  std::string refusal(const std::string& windows) const {
    try {
      read(windows);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was refused";
  }
  TemporaryFolder folder;
};

}  // namespace

TEST_F(ReadWindows, GroupsHaveSurfacesStatesAndARule) {
  const OperatedWindows windows =
      read("[[windows]]\nname = \"south\"\nsurfaces = [\"pane 1\"]\n" + states +
           "[[windows]]\nsurfaces = \"* 2\"\noperation = \"illuminance\"\nclose_above = 20000\n"
           "open_below = 15000\n" +
           states);
  ASSERT_EQ(windows.groups.size(), 2u);
  const WindowGroup &south = windows.groups[0], &second = windows.groups[1];
  EXPECT_EQ(south.name, "south");
  EXPECT_EQ(south.surfaces, std::vector<int>{1});
  EXPECT_EQ(south.operation, WindowOperation::lm_83);
  EXPECT_EQ(south.state, 1);
  ASSERT_EQ(south.states.size(), 2u);
  EXPECT_FALSE(south.states[0].material);
  EXPECT_EQ(windows.materials[static_cast<std::size_t>(south.states[1].material.value())].name,
            "fabric");
  EXPECT_EQ(second.name, "windows2");
  EXPECT_EQ(second.surfaces, std::vector<int>{2});
  EXPECT_EQ(second.close_above, 20000.0);
  EXPECT_EQ(second.open_below, 15000.0);
}

// A pattern may name the material of the panes; states then add no note that nothing uses theirs.
TEST_F(ReadWindows, PatternsMatchMaterialsAndStatesUseTheirs) {
  const auto file =
      folder.write("room.toml", room + "[[windows]]\nsurfaces = [\"clear\"]\n" + states);
  const Scene scene = read_scene(file);
  EXPECT_EQ(read_windows(scene).groups[0].surfaces, (std::vector<int>{1, 2}));
  for (const std::string& note : scene.notes) {
    EXPECT_EQ(note.find("fabric"), std::string::npos) << note;
  }
}

TEST_F(ReadWindows, SchedulesAreTablesOrFiles) {
  const std::string head =
      "[[windows]]\nsurfaces = \"clear\"\noperation = \"schedule\"\n" + states + "schedule = ";
  const WindowGroup winter =
      read(head + "[{ state = \"blind\", from = \"11-01\", to = \"02-28\", hours = \"22-6\" }]\n")
          .groups[0];
  ASSERT_EQ(winter.spans.size(), 1u);
  const ScheduleSpan& span = winter.spans[0];
  EXPECT_TRUE(span.contains(11, 1, 22));
  EXPECT_TRUE(span.contains(2, 28, 5));
  EXPECT_FALSE(span.contains(3, 1, 5));
  EXPECT_FALSE(span.contains(12, 24, 6));
  std::string hours = "state\n";
  for (int h = 0; h < 8760; ++h) hours += h == 12 ? "1,blind\n" : "0,open\n";
  folder.write("hours.csv", hours);
  const WindowGroup by_file = read(head + "\"hours.csv\"\n").groups[0];
  ASSERT_EQ(by_file.hours.size(), 8760u);
  EXPECT_EQ(by_file.hours[12], 1);
  EXPECT_EQ(by_file.hours[13], 0);
}

// Materials of a file beside the scene, then those of the scene.
TEST_F(ReadWindows, AFileBesideTheSceneHasMaterialsOfItsOwn) {
  const Scene scene = read_scene(folder.write("room.toml", room));
  EXPECT_TRUE(read_windows(scene).groups.empty());
  const auto file = folder.write(
      "windows.toml",
      "[materials.dim]\nglass = { ior = 1.5, thin = true, tint = 0.1 }\n[[windows]]\n"
      "surfaces = \"pane*\"\nstates = [{ name = \"clear\" }, { name = \"dim\", material = "
      "\"dim\" }, { name = \"blind\", material = \"fabric\" }]\n");
  const OperatedWindows windows = read_windows(file, scene);
  const WindowGroup& group = windows.groups.at(0);
  ASSERT_EQ(group.states.size(), 3u);
  EXPECT_EQ(windows.materials[static_cast<std::size_t>(group.states[1].material.value())].name,
            "dim");
  EXPECT_EQ(windows.materials[static_cast<std::size_t>(group.states[2].material.value())].name,
            "fabric");
}

TEST_F(ReadWindows, WrongInputIsASentence) {
  const std::string pane = "[[windows]]\nname = \"south\"\nsurfaces = \"pane 1\"\n";
  const auto expect = [&](const std::string& windows, const std::string& sentence) {
    const std::string said = refusal(windows);
    EXPECT_NE(said.find(sentence), std::string::npos) << said;
    EXPECT_NE(said.find("room.toml:"), std::string::npos) << said;
  };
  expect("[[windows]]\nsurfaces = \"pan\"\n" + states,
         "no surface or material of the scene matches");
  expect(pane + "states = [{ name = \"open\" }]\n", "must have at least two states");
  expect(pane + "states = [{ name = \"open\" }, { name = \"blind\", material = \"fabrik\" }]\n",
         "Did you mean 'fabric'?");
  expect(pane + "states = [{ name = \"open\" }, { name = \"blind\" }]\n",
         "lacks the key 'material'");
  expect(pane +
             "states = [{ name = \"open\", material = \"white\" }, { name = \"blind\", "
             "material = \"fabric\" }]\n",
         "is not for the first state, which is the scene as it stands");
  expect(pane + states +
             "operation = \"schedule\"\nschedule = [{ state = \"blind\", hours = \"24-0\" }]\n",
         "write two different hours from 0 to 24");
  expect(pane + "states = [{ name = \"open\" }, { name = \"open\", material = \"fabric\" }]\n",
         "is named 'open' like an earlier one");
  expect(pane + states + "operation = \"always\"\nstate = \"blinds\"\n", "Did you mean 'blind'?");
  expect(pane + states + "operation = \"always\"\n", "lacks the key 'state'");
  expect(pane + states + "closed = \"open\"\n", "is the first state, which is the open one");
  expect(pane + states + "close_above = 100\n", "belongs to operation = \"illuminance\"");
  expect(pane + states + "operation = \"illuminance\"\nclose_above = 100\nopen_below = 200\n",
         "must lie between 0 and 100");
  expect(pane + states + "operation = \"schedule\"\nschedule = []\n", "is empty");
  expect(pane + states +
             "operation = \"schedule\"\nschedule = [{ state = \"blind\", from = \"02-30\" }]\n",
         "'02-30'; write month and day");
  expect(pane + states +
             "operation = \"schedule\"\nschedule = [{ state = \"blind\", hours = \"8-25\" }]\n",
         "write two different hours from 0 to 24");
  expect(pane + states + pane + states, "has the name of an earlier group");
  expect(pane + states + "[[windows]]\nsurfaces = \"pane*\"\n" + states,
         "has the surface 'pane 1', which the windows 'south' have, too");
}

TEST_F(ReadWindows, FilesOfSchedulesAreChecked) {
  const std::string windows = "[[windows]]\nname = \"south\"\nsurfaces = \"clear\"\n" + states +
                              "operation = \"schedule\"\nschedule = \"hours.csv\"\n";
  folder.write("hours.csv", "open\nblind\n");
  EXPECT_NE(refusal(windows).find("the schedule of the windows 'south' has 2 hours"),
            std::string::npos)
      << refusal(windows);
  folder.write("hours.csv", "open\nshut\n");
  EXPECT_NE(refusal(windows).find("hours.csv:2: 'shut' is no state of the windows 'south'"),
            std::string::npos)
      << refusal(windows);
}

}  // namespace lightwell::read_windows_test
