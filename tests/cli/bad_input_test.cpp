// Wrong input and wrong usage: exit code, one sentence on standard error, nothing on standard
// output, and no new file.
#include <gtest/gtest.h>

#include <fstream>
#include <ostream>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace lightwell::bad_input_test {
namespace {

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string without_camera() {
  const std::string text = small_room();
  return text.substr(0, text.find("[[cameras]]"));
}

struct Mistake {
  std::string name;
  std::vector<std::string> arguments;
  int code;
  std::vector<std::string> says;
};

std::ostream& operator<<(std::ostream& out, const Mistake& mistake) {
  return out << mistake.name;
}

class Wrong : public testing::TestWithParam<Mistake> {
 protected:
  void SetUp() override {
    folder.write("room.toml", small_room());
    folder.write("torn.toml", "unit = \"m\"\n[materials.white\n");
    folder.write("nan.toml", with(small_room(), "[1.5, 1, 2.4]", "[nan, 1, 2.4]"));
    folder.write("flat.toml", with(small_room(), "[2.5, 2, 2.4], [2.5, 1, 2.4]",
                                   "[1.5, 1.8, 2.4], [1.5, 1.2, 2.4]"));
    folder.write("bright.toml", with(small_room(), "[0.7, 0.5, 0.3]", "1.2"));
    folder.write("dark.toml", with(small_room(), "power = [12, 10, 8]", "reflectance = 0.5"));
    folder.write("blind.toml", without_camera());
    folder.write("scene.xyz", "what is this");
    folder.write("points.csv", "x,y,z\n1,1,0\n");
    folder.write("junk.vtp", "no solution");
    folder.write("junk.exr", "no picture");
    std::filesystem::create_directory(folder / "taken.vtp");
  }
  TemporaryFolder folder;
};

TEST_P(Wrong, IsRefusedWithASentenceAndLeavesNothing) {
  const Mistake& mistake = GetParam();
  const int files = folder.file_count();
  const Ended ended = run_lightwell(folder / "", mistake.arguments);
  EXPECT_EQ(ended.code, mistake.code) << ended.err;
  EXPECT_EQ(ended.out, "");
  for (const std::string& part : mistake.says) EXPECT_TRUE(says(ended.err, part));
  EXPECT_EQ(folder.file_count(), files) << "something was left behind";
  EXPECT_EQ(ended.err.rfind("error: ", 0), 0u) << ended.err;
}

const std::vector<std::string> solve_room = {"solve", "room.toml", "-o", "room.vtp"};

const Mistake mistakes[] = {
    {"MissingFile", {"solve", "nowhere.toml", "-o", "S.vtp"}, 3, {"nowhere.toml"}},
    {"MissingMesh", {"run", "nowhere.obj"}, 3, {"nowhere.obj"}},
    {"UnknownFormat", {"info", "scene.xyz"}, 3, {"scene.xyz", ".toml"}},
    {"UgrOfARoom", {"info", "room.toml", "--ugr"}, 3, {"room.toml", ".ldt", "lightwell report"}},
    {"MalformedToml", {"solve", "torn.toml", "-o", "S.vtp"}, 3, {"torn.toml:2"}},
    {"VertexThatIsNoNumber", {"solve", "nan.toml", "-o", "S.vtp"}, 3, {"nan.toml", "panel"}},
    {"LampWithoutArea",
     {"solve", "flat.toml", "-o", "S.vtp", "--quiet"},
     3,
     {"flat.toml", "nothing emits", "flat.toml:", "panel", "left out"}},
    {"ReflectanceAboveOne", {"solve", "bright.toml", "-o", "S.vtp"}, 3, {"white", "1.2"}},
    {"NothingEmits", {"solve", "dark.toml", "-o", "S.vtp"}, 3, {"dark.toml", "nothing emits"}},
    {"NothingEmitsInRun", {"run", "dark.toml", "-o", "results"}, 3, {"nothing emits"}},
    {"NoCamera", {"run", "blind.toml", "-o", "results"}, 3, {"blind.toml", "no camera"}},
    {"OutputInNoFolder",
     {"solve", "room.toml", "-o", "none/S.vtp"},
     1,
     {"none/S.vtp", "no folder 'none'"}},
    {"OutputIsAFolder", {"solve", "room.toml", "-o", "taken.vtp"}, 1, {"taken.vtp", "folder"}},
    {"OutputFolderIsAFile", {"run", "room.toml", "-o", "points.csv"}, 1, {"points.csv", "file"}},
    {"OutputFolderBelowAFile", {"run", "room.toml", "-o", "points.csv/a"}, 1, {"points.csv/a"}},
    {"OutputOfAnotherKind", {"solve", "room.toml", "-o", "S.png"}, 2, {"S.png", ".vtp"}},
    {"TwoScenes", {"info", "room.toml", "dark.toml"}, 2, {"'dark.toml'", "too many"}},
    {"NoOutput", {"solve", "room.toml"}, 2, {"--output", "lightwell solve --help"}},
    {"NoScene", {"solve"}, 2, {"scene"}},
    {"UnknownCommand", {"sovle", "room.toml"}, 2, {"'sovle'", "Did you mean 'solve'?"}},
    {"UnknownCommandAfterASwitch", {"--threads", "1", "rendre"}, 2, {"Did you mean 'render'?"}},
    {"UnknownOption",
     solve_room + std::vector<std::string>{"--ray", "64"},
     2,
     {"'--ray'", "Did you mean '--rays'?"}},
    {"RangeThatFalls",
     {"view", "room.toml", "S.vtp", "--false-colour", "lux", "--range", "5:2"},
     2,
     {"'5:2'", "LOW:HIGH"}},
    {"RangeWithoutFalseColours",
     {"view", "room.toml", "S.vtp", "--range", "0:9"},
     2,
     {"--false-colour"}},
    {"UnknownFalseColours",
     {"view", "room.toml", "S.vtp", "--false-colour", "lumen"},
     2,
     {"'lumen'", "lux"}},
    {"AClickBetweenPlaces",
     {"view", "room.toml", "S.vtp", "--offscreen", "a.png", "--click", "100,"},
     2,
     {"--click", "'100,'", "X,Y"}},
    {"APointerWithoutAPicture", {"view", "room.toml", "--pointer", "1,2"}, 2, {"--offscreen"}},
    {"ShotsWithoutAPicture", {"view", "room.toml", "--shots", "3"}, 2, {"--offscreen"}},
    {"FramesWithoutAPath",
     {"view", "room.toml", "S.vtp", "--frames", "3", "--offscreen", "a-%d.png"},
     2,
     {"--path"}},
    {"IsoluxOfNothing", {"view", "room.toml", "S.vtp", "--isolux", "100,0"}, 2, {"'0'"}},
    {"UnknownSwitchBeforeTheCommand",
     {"--quite", "info", "room.toml"},
     2,
     {"'--quite'", "'--quiet'"}},
    {"RaysNoPowerOfTwo",
     solve_room + std::vector<std::string>{"--rays", "100"},
     2,
     {"--rays", "100", "power of two"}},
    {"PatchSizeThatIsNoNumber",
     solve_room + std::vector<std::string>{"--max-patch-size", "nan"},
     2,
     {"--max-patch-size"}},
    {"PatchSizeOfZero",
     solve_room + std::vector<std::string>{"--max-patch-size", "0"},
     2,
     {"above 0"}},
    {"ToleranceBelowZero",
     solve_room + std::vector<std::string>{"--tolerance", "-1"},
     2,
     {"--tolerance"}},
    {"MethodThatIsNotThere",
     solve_room + std::vector<std::string>{"--form-factors", "hemicubes"},
     2,
     {"auto", "ray-cast", "hemicube", "analytic"}},
    {"SolverThatIsNotThere",
     solve_room + std::vector<std::string>{"--solver", "jacoby"},
     2,
     {"jacoby", "auto", "gauss-seidel", "jacobi", "sor", "southwell", "cg", "bicgstab", "gmres",
      "Did you mean 'jacobi'"}},
    {"AccuracyThatIsNone",
     solve_room + std::vector<std::string>{"--accuracy", "0%"},
     2,
     {"--accuracy", "'0%'", "5lx"}},
    {"AccuracyOfProbesInLux",
     {"probe", "room.toml", "--points", "points.csv", "-o", "E.csv", "--accuracy", "5lx"},
     2,
     {"--accuracy", "'5lx'", "0.1%", "100%"}},
    {"AccuracyOfProbesTooSmall",
     {"probe", "room.toml", "--points", "points.csv", "-o", "E.csv", "--accuracy", "0.05%"},
     2,
     {"--accuracy", "'0.05%'", "0.1%"}},
    {"LookingFromACameraThatIsNotThere",
     solve_room + std::vector<std::string>{"--look-from", "window"},
     3,
     {"no camera 'window'", "door"}},
    {"LookingFromNowhere",
     solve_room + std::vector<std::string>{"--look-from", ""},
     2,
     {"--look-from", "everywhere"}},
    {"LookingFromPlacesThatAreNotThere",
     solve_room + std::vector<std::string>{"--look-from", "desk.csv"},
     3,
     {"desk.csv"}},
    {"AccuracyInAnotherUnit",
     solve_room + std::vector<std::string>{"--accuracy", "5cd"},
     2,
     {"--accuracy", "'5cd'"}},
    {"AccuracyThatMeansPerCentMoreProbably",
     solve_room + std::vector<std::string>{"--accuracy", "1"},
     2,
     {"--accuracy", "1%", "100%"}},
    {"AccuracyAndRefinement",
     solve_room + std::vector<std::string>{"--accuracy", "1%", "--refine", "1%"},
     2,
     {"--accuracy", "--refine"}},
    {"RefinedToNothing",
     solve_room + std::vector<std::string>{"--refine", "0%"},
     2,
     {"--refine", "0.001% to 100%", "off"}},
    {"RefinedToLessThanNothing",
     solve_room + std::vector<std::string>{"--refine=-1%"},
     2,
     {"--refine", "'-1%'"}},
    {"RefinedToNoNumber",
     solve_room + std::vector<std::string>{"--refine", "nan"},
     2,
     {"--refine", "'nan'"}},
    {"RefinedToAnotherUnit",
     solve_room + std::vector<std::string>{"--refine", "1 lx"},
     2,
     {"--refine", "'1 lx'"}},
    {"NoElementsAllowed",
     solve_room + std::vector<std::string>{"--max-elements", "0"},
     2,
     {"--max-elements", "from 1 to 20000000"}},
    {"LessThanNoElements",
     solve_room + std::vector<std::string>{"--max-elements=-5"},
     2,
     {"--max-elements", "from 1 to 20000000"}},
    {"TooManyElementsAllowed",
     solve_room + std::vector<std::string>{"--max-elements", "1e12"},
     2,
     {"--max-elements", "from 1 to 20000000"}},
    {"SizeWithoutHeight", {"run", "room.toml", "--size", "640"}, 2, {"--size", "640x480"}},
    {"ThreadsBelowZero", {"run", "room.toml", "--threads", "-1"}, 2, {"--threads"}},
    {"MeshOfAMissingFile", {"mesh", "nowhere.toml"}, 3, {"nowhere.toml"}},
    {"MeshOfATornScene", {"mesh", "torn.toml", "-o", "M.vtp"}, 3, {"torn.toml:2"}},
    {"MeshInNoFolder",
     {"mesh", "room.toml", "-o", "none/M.vtp"},
     1,
     {"none/M.vtp", "no folder 'none'"}},
    {"MeshOverAFolder", {"mesh", "room.toml", "-o", "taken.vtp"}, 1, {"taken.vtp", "folder"}},
    {"NorthThatIsNoNumber",
     {"shortwave", "room.toml", "-o", "K.csv", "--albedo", "0.2", "--sun", "45,180", "--north",
      "nan"},
     2,
     {"--north", "an angle in degrees from -360 to 360 is needed, not 'nan'"}},
    {"GroundThatIsNoNumber",
     {"daylight", "room.toml", "--weather", "a.epw", "-o", "year", "--ground", "nan"},
     2,
     {"--ground", "a reflectance from 0 to 1 is needed, not 'nan'"}},
    {"SunThatIsNoNumber",
     {"daylight", "room.toml", "--weather", "a.epw", "-o", "year", "--sun-points", "points.csv",
      "--least-sun", "nan"},
     2,
     {"--least-sun", "an altitude in degrees from 0 to 89 is needed, not 'nan'"}},
    {"MarginThatIsNoNumber",
     {"report", "room.toml", "S.vtp", "--surface", "floor", "--margin", "nan"},
     2,
     {"--margin", "a length from 0 to 1e+09 is needed, not 'nan'"}},
    {"MaintenanceThatIsNoNumber",
     {"report", "room.toml", "S.vtp", "--maintenance", "nan"},
     2,
     {"--maintenance", "a factor from 1e-06 to 1 is needed, not 'nan'"}},
    {"APlusIsPartOfANumber",
     {"render", "room.toml", "junk.vtp", "-o", "a.png", "--exposure", "+1", "--shift", "0,+0.1"},
     3,
     {"junk.vtp"}},
    {"TwoSignsAreNoNumber",
     {"render", "room.toml", "junk.vtp", "-o", "a.png", "--exposure", "+-1"},
     2,
     {"'+-1' is not a number"}},
    {"MeshOfAnotherKind", {"mesh", "room.toml", "-o", "M.obj"}, 2, {"M.obj", ".vtp"}},
    {"BothSidesOfNoMesh", {"mesh", "room.toml", "--both-sides"}, 2, {"--both-sides", "--output"}},
    {"MeshWithAnOptionOfSolve",
     {"mesh", "room.toml", "--rays", "64"},
     2,
     {"'--rays'", "lightwell mesh --help"}},
    {"MeshWithoutElements",
     {"mesh", "room.toml", "--elements-per-patch-edge", "0"},
     2,
     {"from 1 to 64"}},
    {"MeshOfElementsBySizeAndNumber",
     {"mesh", "room.toml", "--elements-per-patch-edge", "3", "--max-element-size", "0.1"},
     2,
     {"--max-element-size", "combined with --elements-per-patch-edge"}},
    {"MeshOfElementsLargerThanPatches",
     {"mesh", "room.toml", "--max-patch-size", "0.1", "--max-element-size", "0.2"},
     3,
     {"elements of 0.2 m", "patches of 0.1 m"}},
    {"MeshOfTooManyElements",
     {"mesh", "room.toml", "-o", "M.vtp", "--max-patch-size", "1e-5"},
     3,
     {"room.toml", "million"}},
    {"TooManyElements",
     solve_room + std::vector<std::string>{"--max-patch-size", "1e-5"},
     3,
     {"million"}},
    {"SolutionThatIsNone", {"render", "room.toml", "junk.vtp", "-o", "a.png"}, 3, {"junk.vtp"}},
    {"SolutionThatIsMissing", {"render", "room.toml", "no.vtp", "-o", "a.png"}, 3, {"no.vtp"}},
    {"WrongCamera",
     {"render", "room.toml", "junk.vtp", "--camera", "dor", "-o", "a.png"},
     3,
     {"'dor'", "Did you mean 'door'?"}},
    {"PictureOfAnotherKind",
     {"render", "room.toml", "junk.vtp", "-o", "a.jpg"},
     2,
     {"a.jpg", ".png"}},
    {"PassThatIsNotThere",
     {"render", "room.toml", "junk.vtp", "--pass", "photons", "-o", "a.png"},
     2,
     {"photons", "interpolate, direct, gather"}},
    {"QualityThatIsNotThere",
     {"render", "room.toml", "junk.vtp", "--quality", "best", "-o", "a.png"},
     2,
     {"no quality 'best'", "draft, good, final"}},
    {"MirrorsDeeperThanTheStack",
     {"render", "room.toml", "junk.vtp", "--depth", "10000", "-o", "a.png"},
     2,
     {"--depth", "from 0 to 1000", "10000"}},
    {"PointsWithoutNormals",
     {"probe", "room.toml", "junk.vtp", "--points", "points.csv", "-o", "E.csv"},
     3,
     {"points.csv", "nx"}},
    {"ProbesOfAMeshThatIsNotThere",
     {"probe", "room.toml", "--points", "points.csv", "-o", "E.csv", "--interpolate"},
     3,
     {"--interpolate", "name one after the scene"}},
    {"PictureThatIsNone", {"compare", "junk.exr", "junk.exr"}, 3, {"junk.exr"}},
    {"PictureThatIsMissing", {"info", "no.exr"}, 3, {"no.exr"}},
};

INSTANTIATE_TEST_SUITE_P(Use, Wrong, testing::ValuesIn(mistakes),
                         [](const auto& each) { return each.param.name; });

/// The small room with a solution.
class Solved : public testing::Test {
 protected:
  void SetUp() override {
    folder.write("room.toml", small_room());
    const Ended ended = run_lightwell(
        folder / "", std::vector<std::string>{"solve", "room.toml", "-o", "room.vtp"} + quick());
    ASSERT_EQ(ended.code, 0) << ended.err;
  }
  TemporaryFolder folder;
};

TEST_F(Solved, SolutionOfAnotherSceneIsRefused) {
  folder.write("other.toml", with(small_room(), "[0.7, 0.5, 0.3]", "[0.7, 0.5, 0.4]"));
  const Ended ended =
      run_lightwell(folder / "", {"render", "other.toml", "room.vtp", "-o", "a.png"});
  EXPECT_EQ(ended.code, 3);
  EXPECT_EQ(ended.out, "");
  EXPECT_TRUE(says(ended.err, "other.toml"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_F(Solved, ACameraMayChangeWithoutSolvingAgain) {
  folder.write("moved.toml", with(small_room(), "fov = 75", "fov = 60"));
  const Ended ended =
      run_lightwell(folder / "", {"render", "moved.toml", "room.vtp", "-o", "a.png"});
  EXPECT_EQ(ended.code, 0) << ended.err;
}

TEST_F(Solved, TornSolutionIsRefused) {
  const auto file = folder / "room.vtp";
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", "room.vtp"},
        std::vector<std::string>{"render", "room.toml", "room.vtp", "-o", "a.png"}}) {
    const Ended ended = run_lightwell(folder / "", arguments);
    EXPECT_EQ(ended.code, 3);
    EXPECT_EQ(ended.out, "");
    EXPECT_TRUE(says(ended.err, "room.vtp"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_F(Solved, AFailedRenderKeepsTheOldPicture) {
  folder.write("a.png", "the old picture");
  const Ended ended = run_lightwell(folder / "", {"render", "room.toml", "no.vtp", "-o", "a.png"});
  EXPECT_EQ(ended.code, 3);
  std::ifstream in(folder / "a.png");
  std::string text;
  std::getline(in, text);
  EXPECT_EQ(text, "the old picture");
}

}  // namespace
}  // namespace lightwell::bad_input_test
