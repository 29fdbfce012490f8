// Files and errors of 'lightwell form-factors'.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/program.h"

namespace lightwell::form_factors_test {
namespace {
using Words = std::vector<std::string>;

// Unit squares that face each other at distance 1.
const std::string plates = R"(T plates
C encl=1
F 3
V 1  0 0 0
V 2  1 0 0
V 3  1 1 0
V 4  0 1 0
V 5  0 0 1
V 6  1 0 1
V 7  1 1 1
V 8  0 1 1
S 1  1 2 3 4  0 0 0.90 floor
S 2  8 7 6 5  0 0 0.50 ceiling
)";

// The box between (0.3, 0.35, 0.2) and (0.6, 0.75, 0.6), seen from outside.
const std::string box = R"(
V  9  0.3 0.35 0.2
V 10  0.6 0.35 0.2
V 11  0.6 0.75 0.2
V 12  0.3 0.75 0.2
V 13  0.3 0.35 0.6
V 14  0.6 0.35 0.6
V 15  0.6 0.75 0.6
V 16  0.3 0.75 0.6
O 3   9 12 11 10
O 4  13 14 15 16
O 5   9 10 14 13
O 6  10 11 15 14
O 7  11 12 16 15
O 8  12  9 13 16
)";

// Exact F_12 without and with the box, computed with mpmath for this project: the first by the
// double contour integral, the second by clipping the visible region.
constexpr double plates_F = 0.199824895698387, plates_and_box_F = 0.123862784216098;

// Largest rounding error of a factor or share below 1 that is stored as a float.
constexpr double rounding = 6e-8;
// A closed form is rounded to a float twice: when it is stored, and when closure scales its row.
constexpr double closed_form = 2 * rounding;

struct Matrix {
  std::size_t rows = 0;
  std::map<std::pair<int, int>, double> entry{};

  double at(int i, int j) const {
    const auto found = entry.find({i, j});
    return found == entry.end() ? 0.0 : found->second;
  }
};

class FormFactorsCommand : public CommandTest {
 protected:
  nlohmann::json json_file(const std::string& name) const {
    std::ifstream in(folder / name);
    return nlohmann::json::parse(in);
  }
  // Factors of any input lie in [0, 1].
  Matrix matrix(const std::string& name) const {
    std::ifstream in(folder / name);
    std::string line;
    while (in.peek() == '%') std::getline(in, line);
    Matrix matrix;
    std::size_t columns = 0, entries = 0;
    in >> matrix.rows >> columns >> entries;
    EXPECT_EQ(matrix.rows, columns);
    int i = 0, j = 0;
    double F = 0.0;
    while (in >> i >> j >> F) {
      EXPECT_TRUE(F > 0.0 && F <= 1.0) << i << " " << j << " " << F;
      matrix.entry[{i, j}] = F;
    }
    EXPECT_EQ(matrix.entry.size(), entries);
    return matrix;
  }
};

TEST_F(FormFactorsCommand, TwoPlatesAreRightWithinTheErrorAskedFor) {
  folder.write("plates.vs3", plates);
  const auto json = run_json({"form-factors", "plates.vs3", "-o", "F.mtx"});
  const Matrix F = matrix("F.mtx");
  ASSERT_EQ(F.rows, 2u);
  EXPECT_NEAR(F.at(1, 2), plates_F, closed_form);
  EXPECT_NEAR(F.at(2, 1), plates_F, closed_form);
  EXPECT_EQ(F.entry.size(), 2u);
  EXPECT_EQ(json["facets"], 2);
  EXPECT_LE(json["closure_max_error"].get<double>(), 2 * rounding) << "one factor, one open share";
  EXPECT_LE(json["reciprocity_max_error"].get<double>(), 2 * rounding) << "two factors";
  EXPECT_NEAR(json["open_share"].get<double>(), 1.0 - plates_F, closed_form);
  EXPECT_DOUBLE_EQ(json["total_area"].get<double>(), 2.0);
  EXPECT_GT(json["seconds"]["total"].get<double>(), 0.0);
  EXPECT_GT(json["peak_memory_mb"].get<double>(), 0.0);
  EXPECT_EQ(json["files"], nlohmann::json::array({"F.mtx", "F.json"}));
  const auto beside = json_file("F.json");
  EXPECT_EQ(beside["row"]["name"], nlohmann::json::array({"floor", "ceiling"}));
  EXPECT_EQ(beside["row"]["facet"], nlohmann::json::array({1, 2}));
  EXPECT_EQ(beside["row"]["area"].size(), 2u);
  EXPECT_EQ(folder.file_count(), 3);
}

// Clipping is exact to 1e-6. The standard error of ray casting is at most the target, 1e-3; an
// error of four standard errors is exceeded once in 16 000 cases.
TEST_F(FormFactorsCommand, AnObstructionTakesItsShareAndHasNoRow) {
  folder.write("box.vs3", plates + box);
  const std::map<std::string, double> allowed{{"auto", 1e-6}, {"ray-cast", 4e-3}};
  for (const auto& [method, error] : allowed) {
    const auto json = run_json({"form-factors", "box.vs3", "-o", "F.mtx", "--method", method});
    const Matrix F = matrix("F.mtx");
    EXPECT_EQ(F.rows, 2u);
    EXPECT_NEAR(F.at(1, 2), plates_and_box_F, error) << method;
    const auto row = json_file("F.json")["row"];
    const double blocked = row["blocked"][0].get<double>();
    EXPECT_GT(blocked, 0.05);
    EXPECT_NEAR(F.at(1, 2) + blocked + row["open"][0].get<double>(), 1.0, 14 * rounding)
        << "a factor, an open share, and 12 patches of the box";
    EXPECT_GT(json["error_estimate"].get<double>(), 0.0);
    EXPECT_LE(json["error_estimate"].get<double>(), 1e-3) << "what was asked for";
  }
}

// A sphere's factors are counts of 2^18 rays at most: their standard error is some 1e-4. Patches of
// a sphere add their errors, so a target of 2e-2 for the whole leaves room for those of 8 patches.
TEST_F(FormFactorsCommand, EndsWithItsOwnCodeAboveTheTargetError) {
  folder.write("ball.toml", R"(
[materials.grey]
reflectance = 0.5
[[surfaces]]
name = "ball"
material = "grey"
sphere = { center = [0.5, 0.5, 1], radius = 0.4 }
[[surfaces]]
name = "floor"
material = "grey"
polygon = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
)");
  const Words words = {"form-factors", "ball.toml", "-o", "F.mtx", "--json", "--target-error"};
  const Ended close = run(words + Words{"2e-5", "--method", "ray-cast"});
  EXPECT_EQ(close.code, 4);
  EXPECT_TRUE(says(close.err, "above the target error of 2e-05"));
  EXPECT_GT(nlohmann::json::parse(close.out)["error_estimate"].get<double>(), 2e-5);
  const Ended rough = run(words + Words{"2e-2", "--method", "ray-cast"});
  EXPECT_EQ(rough.code, 0) << rough.err;
  const Ended unknown = run(words + Words{"2e-5", "--method", "hemicube"});
  EXPECT_EQ(unknown.code, 0);
  EXPECT_TRUE(says(unknown.err, "no estimate of its error"));
  EXPECT_TRUE(nlohmann::json::parse(unknown.out)["error_estimate"].is_null());
}

// A hundred triangles that cross each other are cut into a thousand patches. Closed forms and
// shadow rays for all pairs of these took minutes and missed the target.
TEST_F(FormFactorsCommand, FacetsThatCrossByTheDozenReachTheTarget) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  std::string vertices, faces;
  for (int i = 0; i < 100; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      vertices += "v " + std::to_string(place(random)) + " " + std::to_string(place(random)) + " " +
                  std::to_string(place(random)) + "\n";
    }
    faces += "f " + std::to_string(3 * i + 1) + " " + std::to_string(3 * i + 2) + " " +
             std::to_string(3 * i + 3) + "\n";
  }
  folder.write("crossing.obj", vertices + faces);
  const Ended ended =
      run({"form-factors", "crossing.obj", "-o", "crossing.mtx", "--target-error", "0.02"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_TRUE(says(ended.err, "their factors are counts of rays"));
}

TEST_F(FormFactorsCommand, MethodsAgree) {
  folder.write("plates.vs3", plates);
  for (const char* method : {"auto", "ray-cast", "hemicube", "analytic"}) {
    ASSERT_EQ(run({"form-factors", "plates.vs3", "-o", "F.mtx", "--method", method}).code, 0);
    // Hemicubes may have twice the target error at their resolution.
    const bool is_exact = method == std::string("auto") || method == std::string("analytic");
    EXPECT_NEAR(matrix("F.mtx").at(1, 2), plates_F, is_exact ? closed_form : 2e-3) << method;
  }
}

TEST_F(FormFactorsCommand, AClosedBoxLosesNothing) {
  folder.write("cube.obj", unit_cube());
  const auto json = run_json({"form-factors", "cube.obj", "-o", "F.mtx"});
  EXPECT_LE(json["closure_max_error"].get<double>(), 5 * rounding) << "five factors a row";
  EXPECT_EQ(json["open_share"].get<double>(), 0.0);
  EXPECT_TRUE(json["notes"].empty()) << json["notes"];
  const Matrix F = matrix("F.mtx");
  EXPECT_NEAR(F.at(1, 2), plates_F, closed_form);
  EXPECT_NEAR(F.at(1, 3), (1.0 - plates_F) / 4.0, closed_form) << "by symmetry";
}

TEST_F(FormFactorsCommand, FacetsKeepTheirNumbersWhateverIsWrongWithOthers) {
  folder.write("bad.obj", R"(
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 1 2 2
f 1 2 3 4
f 1 2 3 4
f 8 7 6 5
f 5 6 7 8
)");
  const auto json = run_json({"form-factors", "bad.obj", "-o", "F.mtx"});
  const Matrix F = matrix("F.mtx");
  EXPECT_EQ(F.rows, 5u);
  EXPECT_NEAR(F.at(2, 4), plates_F, closed_form);
  EXPECT_EQ(F.entry.size(), 2u) << "facet 5 is the back of 4 and looks away";
  const std::string notes = json["notes"].dump();
  EXPECT_TRUE(says(notes, "empty rows: 1."));
  EXPECT_TRUE(says(notes, "left out and keep empty rows: 3."));
  EXPECT_TRUE(says(notes, "back of an earlier one: 5."));
  EXPECT_EQ(json_file("F.json")["row"]["area"][0], 0.0);
  EXPECT_EQ(json_file("F.json")["row"]["area"][4], 1.0);
}

TEST_F(FormFactorsCommand, OneFacetSeesNothing) {
  folder.write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto json = run_json({"form-factors", "one.obj", "-o", "F.mtx"});
  EXPECT_EQ(matrix("F.mtx").entry.size(), 0u);
  EXPECT_EQ(json["open_share"], 1.0);
  EXPECT_TRUE(says(json["notes"].dump(), "No facet sees another"));
}

TEST_F(FormFactorsCommand, BacksHaveRowsWhereAskedFor) {
  folder.write("plates.vs3", plates);
  ASSERT_EQ(run({"form-factors", "plates.vs3", "-o", "F.mtx", "--two-sided"}).code, 0);
  const Matrix F = matrix("F.mtx");
  EXPECT_EQ(F.rows, 4u);
  EXPECT_NEAR(F.at(1, 2), plates_F, closed_form);
  EXPECT_EQ(F.entry.size(), 2u) << "backs look outwards";
  const auto row = json_file("F.json")["row"];
  EXPECT_EQ(row["side"], nlohmann::json::array({"front", "front", "back", "back"}));
  EXPECT_EQ(row["facet"], nlohmann::json::array({1, 2, 1, 2}));
}

TEST_F(FormFactorsCommand, SmallerPatchesAreRowsThatKnowTheirFacet) {
  folder.write("plates.vs3", plates);
  const auto json =
      run_json({"form-factors", "plates.vs3", "-o", "F.mtx", "--max-patch-size", "0.5"});
  EXPECT_EQ(json["rows"], 8) << "four squares of 0.5 on each plate";
  EXPECT_EQ(json["facets"], 2);
  const Matrix F = matrix("F.mtx");
  const auto row = json_file("F.json")["row"];
  double exchange = 0.0;  // A_1 F_12 as the sum over patches
  for (int i = 1; i <= 8; ++i) {
    for (int j = 1; j <= 8; ++j) {
      const auto facet = [&](int r) { return row["facet"][static_cast<std::size_t>(r - 1)]; };
      if (facet(i) == 1 && facet(j) == 2) exchange += 0.25 * F.at(i, j);
    }
  }
  EXPECT_NEAR(exchange, plates_F, closed_form);
}

TEST_F(FormFactorsCommand, WritesView3dsResultAndAPictureOfARow) {
  folder.write("plates.vs3", plates);
  const auto json = run_json(
      {"form-factors", "plates.vs3", "-o", "F.mtx", "--view3d", "F.txt", "--show-row", "2"});
  EXPECT_EQ(json["files"], nlohmann::json::array({"F.mtx", "F.txt", "F.row2.vtp", "F.json"}));
  std::ifstream in(folder / "F.txt");
  std::string program, version;
  int format = -1, encl = -1, emit = -1, rows = -1;
  in >> program >> version >> format >> encl >> emit >> rows;
  EXPECT_EQ(format, 0);
  EXPECT_EQ(encl, 1) << "as the file's control words say";
  EXPECT_EQ(emit, 0);
  EXPECT_EQ(rows, 2);
  std::vector<double> numbers(8);
  for (double& number : numbers) in >> number;
  ASSERT_TRUE(in) << "areas, matrix, emittances";
  EXPECT_EQ(numbers[0], 1.0);
  EXPECT_NEAR(numbers[3], plates_F, 0.5e-6) << "six decimals";
  EXPECT_EQ(numbers[6], 0.9);
  EXPECT_EQ(numbers[7], 0.5);
}

// A closed cube of unit edges in three objects; its fronts face inside, or outside if `turned`.
std::string closed_cube(bool turned) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
  const std::vector<std::pair<const char*, std::vector<std::array<int, 4>>>> objects = {
      {"floor", {{1, 2, 3, 4}}},
      {"ceiling", {{8, 7, 6, 5}}},
      {"walls", {{2, 1, 5, 6}, {3, 2, 6, 7}, {4, 3, 7, 8}, {1, 4, 8, 5}}}};
  for (const auto& [name, faces] : objects) {
    text += fmt::format("o {}\n", name);
    for (const auto& [a, b, c, d] : faces) {
      text += turned ? fmt::format("f {} {} {} {}\n", d, c, b, a)
                     : fmt::format("f {} {} {} {}\n", a, b, c, d);
    }
  }
  return text;
}

TEST_F(FormFactorsCommand, WritesTheListsOfOpenfoam) {
  folder.write("cube.obj", closed_cube(false));
  folder.write("boundary.obj", closed_cube(true));
  const auto json =
      run_json({"form-factors", "cube.obj", "-o", "F.mtx", "--openfoam", "case/constant"});
  EXPECT_EQ(json["files"].size(), 8u);
  EXPECT_TRUE(
      says(content_of(folder / "case/constant/finalAgglom"), "3\n(\n1(0)\n1(0)\n4(0 1 2 3)\n)"));
  EXPECT_TRUE(says(content_of(folder / "case/constant/globalFaceFaces"),
                   "6\n(\n5(1 2 3 4 5)\n5(0 2 3 4 5)\n"));
  // Boundaries of OpenFOAM face out of the fluid: the fluid sees their backs, as the cube's fronts.
  run_json({"form-factors", "boundary.obj", "--two-sided", "-o", "F.mtx", "--openfoam", "backs"});
  for (const char* list : {"F", "globalFaceFaces", "finalAgglom", "constructMapDim"}) {
    EXPECT_EQ(content_of(folder / "backs" / list), content_of(folder / "case/constant" / list));
  }
}

TEST_F(FormFactorsCommand, WritesSurfacesForMoose) {
  folder.write("cube.obj", closed_cube(false));
  run_json({"form-factors", "cube.obj", "-o", "F.mtx", "--moose", "cube.csv"});
  std::istringstream in(content_of(folder / "cube.csv"));
  std::string heading, floor;
  std::getline(in, heading);
  EXPECT_EQ(heading, "boundary,area,floor,ceiling,walls");
  char comma = ' ';
  double area = 0.0, to_floor = -1.0, to_ceiling = 0.0, to_walls = 0.0;
  std::getline(in, floor, ',');
  in >> area >> comma >> to_floor >> comma >> to_ceiling >> comma >> to_walls;
  EXPECT_EQ(floor, "floor");
  EXPECT_EQ(area, 1.0);
  EXPECT_EQ(to_floor, 0.0);
  // The same squares as those of `plates`. Factors are floats, of which four make up the walls.
  EXPECT_NEAR(to_ceiling, plates_F, 0x1p-24);
  EXPECT_NEAR(to_walls, 1.0 - plates_F, 5 * 0x1p-24);
}

TEST_F(FormFactorsCommand, SaysForPeopleWhatWasFound) {
  folder.write("plates.vs3", plates);
  const Ended ended = run({"form-factors", "plates.vs3", "-o", "F.mtx"});
  for (const char* part : {"2 of 2 facets, 2 entries, 2 m2", "closure", "open", "error", "F.mtx"}) {
    EXPECT_TRUE(says(ended.out, part));
  }
  const Ended quiet = run({"form-factors", "plates.vs3", "-o", "F.mtx", "--quiet"});
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST_F(FormFactorsCommand, AnyNumberOfThreadsGivesTheSameFile) {
  folder.write("box.vs3", plates + box);
  const auto text = [&](const char* threads) {
    EXPECT_EQ(run({"form-factors", "box.vs3", "-o", "F.mtx", "--threads", threads}).code, 0);
    std::ostringstream out;
    out << std::ifstream(folder / "F.mtx").rdbuf();
    return out.str();
  };
  EXPECT_EQ(text("1"), text("3"));
}

TEST_F(FormFactorsCommand, AcceptsTheOptionsItRecords) {
  folder.write("plates.vs3", plates);
  const Words scene = {"form-factors", "plates.vs3", "-o", "F.mtx"};
  for (const Words& more : {Words{}, Words{"--max-patch-size", "0.5", "--two-sided"},
                            Words{"--method", "hemicube", "--hemicube-resolution", "64"}}) {
    const auto options = run_json(scene + more)["options"].get<std::string>();
    std::istringstream in(options);
    const Words recorded{std::istream_iterator<std::string>(in), {}};
    EXPECT_EQ(run_json(scene + recorded)["options"], options);
  }
}

TEST_F(FormFactorsCommand, HelpTellsHowFactorsAreFoundInOnePlace) {
  const std::string help = run({"form-factors", "--help"}).out;
  const std::size_t group = help.find("How form factors are found");
  ASSERT_NE(group, std::string::npos);
  for (const char* option : {"--method", "--hemicube-resolution", "--target-error"}) {
    EXPECT_NE(help.find(option, group), std::string::npos) << option;
  }
}

TEST_F(FormFactorsCommand, MistakesHaveTheirExitCodesAndLeaveNothing) {
  folder.write("plates.vs3", plates);
  folder.write("flat.vs3", "F 2\n");
  struct Mistake {
    Words arguments;
    int code;
    const char* part;
  };
  const std::vector<Mistake> mistakes = {
      {{"plates.vs3"}, 2, "--output"},
      {{"plates.vs3", "-o", "F.csv"}, 2, ".mtx"},
      {{"plates.vs3", "-o", "F.mtx", "--method", "guess"},
       2,
       "there is no form-factor method 'guess'"},
      {{"plates.vs3", "-o", "F.mtx", "--target-error", "nan"}, 2, "above 0"},
      {{"plates.vs3", "-o", "F.mtx", "--row-output", "r.vtp"}, 2, "--show-row"},
      {{"plates.vs3", "-o", "F.mtx", "--show-row", "3"}, 3, "there are 2"},
      {{"missing.vs3", "-o", "F.mtx"}, 3, "missing.vs3"},
      {{"flat.vs3", "-o", "F.mtx"}, 3, "three-dimensional"},
      {{"plates.vs3", "-o", "no-folder/F.mtx"}, 1, "no-folder"},
      {{"plates.vs3", "-o", "F.mtx", "--view3d", "no-folder/F.txt"}, 1, "no-folder"},
      {{"plates.vs3", "-o", "F.mtx", "--moose", "F.txt"}, 2, "must end in .i or .csv"},
      {{"plates.vs3", "-o", "F.mtx", "--moose", "no-folder/F.i"}, 1, "no-folder"},
      {{"plates.vs3", "-o", "F.mtx", "--moose", "F.i", "--two-sided"}, 2, "excludes --two-sided"},
      {{"plates.vs3", "-o", "F.mtx", "--openfoam", "case", "--max-patch-size", "1"},
       2,
       "excludes --max-patch-size"},
      {{"plates.vs3", "-o", "F.mtx", "--openfoam", "plates.vs3"}, 1, "plates.vs3"},
      {{"plates.vs3", "-o", "F.mtx", "--view3d", "F.i", "--moose", "F.i"}, 1, "F.i"},
  };
  for (const Mistake& mistake : mistakes) {
    const Ended ended = run(Words{"form-factors"} + mistake.arguments);
    EXPECT_EQ(ended.code, mistake.code) << mistake.part;
    EXPECT_TRUE(says(ended.err, mistake.part));
  }
  EXPECT_EQ(folder.file_count(), 2) << "the two scenes";
}

}  // namespace
}  // namespace lightwell::form_factors_test
