// Report and file of 'lightwell mesh'; the file is read by VTK, as ParaView does.
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <string>

#include "tests/cli/program.h"

namespace lightwell::mesh_test {
namespace {
using Words = std::vector<std::string>;

// Relative rounding error of a sum of some hundred areas of order one.
constexpr double rounding = 1e-12;

const std::string ball = R"(
[[surfaces]]
name = "ball"
material = "white"
sphere = { center = [1, 1, 0.6], radius = 0.35 }
)";

class MeshCommand : public CommandTest {
 protected:
  void SetUp() override { folder.write("room.toml", small_room()); }
  vtkPolyData* read(const std::string& name) {
    reader->SetFileName((folder / name).c_str());
    reader->Update();
    return reader->GetOutput();
  }
  std::vector<double> column(const std::string& file, const char* name) {
    vtkDataArray* const array = read(file)->GetCellData()->GetArray(name);
    std::vector<double> values;
    EXPECT_NE(array, nullptr) << name;
    for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i) {
      values.push_back(array->GetTuple1(i));
    }
    return values;
  }
  vtkNew<vtkXMLPolyDataReader> reader;
};

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// The area is 2 (4 x 3 + 4 x 2.5 + 3 x 2.5) m^2 of room, 1 m^2 of panel, and the exact ball.
TEST_F(MeshCommand, FrontsCoverTheSceneOnce) {
  folder.write("ball.toml", small_room() + ball);
  const double area = 60.0 + 4.0 * std::numbers::pi * 0.35 * 0.35;
  const auto json = run_json({"mesh", "ball.toml", "-o", "M.vtp", "--max-patch-size", "0.5"});
  EXPECT_NEAR(json["area"].get<double>(), area, area * rounding);
  EXPECT_NEAR(json["scene_area"].get<double>(), area, area * rounding);
  EXPECT_LT(json["area_error"].get<double>(), rounding);
  const std::vector<double> areas = column("M.vtp", "area");
  EXPECT_EQ(json["front_elements"].get<std::size_t>(), areas.size());
  EXPECT_NEAR(sum(areas), area, area * rounding);
  EXPECT_EQ(sum(column("M.vtp", "is_back")), 0.0);
  EXPECT_EQ(json["files"], nlohmann::json::array({"M.vtp"}));
  EXPECT_GE(json["seconds"]["mesh"].get<double>(), 0.0);

  const std::vector<double> patch = column("M.vtp", "patch"), total = column("M.vtp", "patch_area");
  std::map<double, double> of_patch;
  for (std::size_t e = 0; e < areas.size(); ++e) of_patch[patch[e]] += areas[e];
  EXPECT_EQ(json["front_patches"].get<std::size_t>(), of_patch.size());
  for (std::size_t e = 0; e < areas.size(); ++e) {
    EXPECT_NEAR(of_patch[patch[e]], total[e], total[e] * rounding);
  }
}

TEST_F(MeshCommand, ReportAndColumnsAgree) {
  folder.write("ball.toml", small_room() + ball);
  const auto json = run_json({"mesh", "ball.toml", "-o", "M.vtp"});
  const std::vector<double> angle = column("M.vtp", "least_angle");
  const auto below = [&angle](double degrees) {
    const auto count =
        std::count_if(angle.begin(), angle.end(), [=](double a) { return a < degrees; });
    return static_cast<double>(count) / static_cast<double>(angle.size());
  };
  EXPECT_EQ(json["least_angle"], *std::min_element(angle.begin(), angle.end()));
  EXPECT_EQ(json["below_10_degrees"], below(10.0));
  EXPECT_EQ(json["below_20_degrees"], below(20.0));
  const std::vector<double> aspect = column("M.vtp", "aspect_ratio");
  EXPECT_EQ(json["largest_aspect_ratio"], *std::max_element(aspect.begin(), aspect.end()));

  const std::vector<double> areas = column("M.vtp", "area"), element = column("M.vtp", "element");
  const auto smallest = std::min_element(areas.begin(), areas.end()) - areas.begin();
  EXPECT_EQ(json["smallest_element"]["area"], areas[smallest]);
  EXPECT_EQ(json["smallest_element"]["element"], element[smallest]);
  EXPECT_EQ(json["smallest_element"]["surface"], "ball");  // at one of the poles
  EXPECT_EQ(json["largest_element"]["area"], *std::max_element(areas.begin(), areas.end()));

  vtkPolyData* const poly = read("M.vtp");
  EXPECT_STREQ(poly->GetCellData()->GetScalars()->GetName(), "patch_rgb");
  const auto text = [poly](const char* name) {
    auto* const array = vtkStringArray::SafeDownCast(poly->GetFieldData()->GetAbstractArray(name));
    return array ? std::string(array->GetValue(0)) : "missing";
  };
  EXPECT_EQ(text("scene_file"), "ball.toml");
  EXPECT_EQ(text("options"), json["options"].get<std::string>());
  EXPECT_EQ(text("scene_hash"), run_json({"info", "ball.toml"})["scene_hash"].get<std::string>());
}

TEST_F(MeshCommand, TheMeshIsTheOneThatSolveUsesWhereItDoesNotRefine) {
  const Words size = {"--max-patch-size", "1", "--elements-per-patch-edge", "3"};
  const auto meshed = run_json(Words{"mesh", "room.toml", "-o", "M.vtp", "--both-sides"} + size);
  const auto solved = run_json(Words{"solve", "room.toml", "-o", "S.vtp", "--rays", "64",
                                     "--gather-rays", "32", "--refine", "off"} +
                               size);
  for (const char* key : {"patches", "elements", "cleaned", "notes"}) {
    EXPECT_EQ(meshed[key], solved[key]) << key;
  }
  EXPECT_EQ(read("S.vtp")->GetNumberOfPoints(), meshed["vertices"].get<int>());
  EXPECT_EQ(read("M.vtp")->GetNumberOfPoints(), meshed["vertices"].get<int>());
  for (const char* name : {"patch", "facet", "surface", "material", "area"}) {
    EXPECT_EQ(column("M.vtp", name), column("S.vtp", name)) << name;
  }
}

TEST_F(MeshCommand, WithoutAnOutputThereIsOnlyAReport) {
  const int files = folder.file_count();
  const Ended ended = run({"mesh", "room.toml"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  for (const char* part : {"patches", "60 m2", "90 degrees at least", "'panel'"}) {
    EXPECT_TRUE(says(ended.out, part));
  }
  EXPECT_EQ(folder.file_count(), files);
}

TEST_F(MeshCommand, EachPatchColorHasAColorOfItsOwn) {
  run_json({"mesh", "room.toml", "-o", "M.vtp"});
  vtkCellData* const data = read("M.vtp")->GetCellData();
  vtkDataArray *const color = data->GetArray("patch_color"), *const rgb = data->GetScalars();
  ASSERT_EQ(rgb->GetNumberOfComponents(), 3);
  std::map<double, std::array<double, 3>> rgb_of;
  std::map<std::array<double, 3>, double> color_of;
  for (vtkIdType i = 0; i < color->GetNumberOfTuples(); ++i) {
    std::array<double, 3> shown;
    rgb->GetTuple(i, shown.data());
    const double number = color->GetTuple1(i);
    EXPECT_EQ(rgb_of.emplace(number, shown).first->second, shown);
    EXPECT_EQ(color_of.emplace(shown, number).first->second, number);
  }
  EXPECT_GT(rgb_of.size(), 1u);
}

TEST_F(MeshCommand, BacksComeOnlyWhenAskedFor) {
  run_json({"mesh", "room.toml", "-o", "fronts.vtp"});
  const auto json = run_json({"mesh", "room.toml", "-o", "both.vtp", "--both-sides"});
  const double backs = sum(column("both.vtp", "is_back"));
  EXPECT_EQ(backs, json["elements"].get<int>() - json["front_elements"].get<int>());
  EXPECT_GT(backs, 0.0);
  EXPECT_EQ(column("fronts.vtp", "area").size() + backs, column("both.vtp", "area").size());
  EXPECT_LT(read("fronts.vtp")->GetNumberOfPoints(), json["vertices"].get<int>());
}

// Cleaning joins the 12 triangles of a cube to 6 squares, each of 2 x 2 patches of 2 x 2 elements.
TEST_F(MeshCommand, TellsWhatWasCleanedFirst) {
  std::string obj = unit_cube();
  obj.erase(obj.find("f "));
  obj += "f 1 2 4\nf 1 4 3\nf 5 7 8\nf 5 8 6\nf 1 5 6\nf 1 6 2\nf 3 4 8\nf 3 8 7\n";
  obj += "f 1 3 7\nf 1 7 5\nf 2 6 8\nf 2 8 4\n";
  folder.write("cube.obj", obj);
  const auto json = run_json({"mesh", "cube.obj", "--max-patch-size", "0.5"});
  EXPECT_EQ(json["cleaned"]["facets"], 6);
  EXPECT_EQ(json["front_patches"], 24);
  EXPECT_EQ(json["front_elements"], 96);
  EXPECT_DOUBLE_EQ(json["largest_element"]["area"].get<double>(), 1.0 / 16.0);
  EXPECT_TRUE(says(run({"mesh", "cube.obj"}).out, "12 facets became 6"));
}

// A floating block in a room of few large elements has more discontinuity lines than are allowed.
TEST_F(MeshCommand, NotesSayWhatMeshingLeftOut) {
  folder.write("block.toml", small_room() + R"(
[[surfaces]]
name = "block"
material = "white"
box = { min = [1.3, 1.2, 0.5], max = [2.2, 1.7, 1.1] }
)");
  const Words coarse = {"--max-patch-size", "2", "--elements-per-patch-edge", "1",
                        "--discontinuity"};
  const auto meshed = run_json(Words{"mesh", "block.toml"} + coarse);
  ASSERT_EQ(meshed["notes"].size(), 1u);
  EXPECT_TRUE(says(meshed["notes"][0], "discontinuity lines"));
  EXPECT_TRUE(says(run(Words{"mesh", "block.toml"} + coarse).err,
                   "note: " + meshed["notes"][0].get<std::string>()));
  const auto solved = run_json(Words{"solve", "block.toml", "-o", "S.vtp", "--rays", "64",
                                     "--gather-rays", "32", "--refine", "off"} +
                               coarse);
  EXPECT_EQ(solved["notes"], meshed["notes"]);
  EXPECT_EQ(solved["elements"], meshed["elements"]);
}

TEST_F(MeshCommand, TheSameBytesForAnyNumberOfThreads) {
  folder.write("ball.toml", small_room() + ball);
  for (const char* threads : {"1", "4"}) {
    run_json({"mesh", "ball.toml", "-o", std::string(threads) + ".vtp", "--threads", threads});
  }
  EXPECT_FALSE(content_of(folder / "1.vtp").empty());
  EXPECT_EQ(content_of(folder / "1.vtp"), content_of(folder / "4.vtp"));
}

TEST_F(MeshCommand, AMeshIsNoSolution) {
  run_json({"mesh", "room.toml", "-o", "M.vtp"});
  for (const Words& use :
       {Words{"info", "M.vtp"}, Words{"render", "room.toml", "M.vtp", "-o", "a.png"}}) {
    const Ended ended = run(use);
    EXPECT_EQ(ended.code, 3);
    EXPECT_TRUE(says(ended.err, "M.vtp"));
  }
}

}  // namespace
}  // namespace lightwell::mesh_test
