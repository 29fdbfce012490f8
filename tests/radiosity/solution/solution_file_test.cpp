#include "radiosity/solution/solution_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <sstream>

#include "tests/radiosity/small_solution.h"

namespace lightwell::solution_file_test {
namespace {

template <class A>
void expect_same_bits(const A& a, const A& b, const char* what) {
  ASSERT_EQ(a.rows(), b.rows()) << what;
  ASSERT_EQ(a.cols(), b.cols()) << what;
  EXPECT_EQ(0,
            std::memcmp(a.data(), b.data(), sizeof(*a.data()) * static_cast<std::size_t>(a.size())))
      << what;
}

void expect_same_mesh(const PatchMesh& a, const PatchMesh& b) {
  ASSERT_EQ(a.vertex_count(), b.vertex_count());
  ASSERT_EQ(a.elements->n_vertices(), b.elements->n_vertices());
  ASSERT_EQ(a.elements->n_faces(), b.elements->n_faces());
  for (int v = 0; v < a.vertex_count(); ++v) {
    EXPECT_EQ(a.position(v), b.position(v));
    EXPECT_EQ(a.vertex_normal[v], b.vertex_normal[v]);
  }
  EXPECT_EQ(a.corners, b.corners);
  EXPECT_EQ(a.patch, b.patch);
  EXPECT_EQ(a.twin, b.twin);
  EXPECT_EQ(a.first_element, b.first_element);
  EXPECT_EQ(a.surface, b.surface);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(a.facet, b.facet);
  EXPECT_EQ(a.is_back, b.is_back);
  expect_same_bits(a.element_area, b.element_area, "element_area");
  expect_same_bits(a.area, b.area, "area");
  expect_same_bits(a.reflectance, b.reflectance, "reflectance");
  expect_same_bits(a.emission, b.emission, "emission");
  ASSERT_EQ(a.round_grids.size(), b.round_grids.size());
  for (std::size_t g = 0; g < a.round_grids.size(); ++g) {
    EXPECT_EQ(a.round_grids[g].facet, b.round_grids[g].facet);
    EXPECT_EQ(bounds(a.round_grids[g].shape).min(), bounds(b.round_grids[g].shape).min());
    EXPECT_EQ(bounds(a.round_grids[g].shape).max(), bounds(b.round_grids[g].shape).max());
    EXPECT_EQ(a.round_grids[g].rings, b.round_grids[g].rings);
    EXPECT_EQ(a.round_grids[g].sectors, b.round_grids[g].sectors);
    EXPECT_EQ(a.round_grids[g].element, b.round_grids[g].element);
  }
}

void expect_same_solution(const RadiositySolution& a, const RadiositySolution& b) {
  EXPECT_EQ(a.bands.names, b.bands.names);
  EXPECT_EQ(a.bands.wavelengths_nm, b.bands.wavelengths_nm);
  expect_same_bits(a.bands.xyz, b.bands.xyz, "xyz");
  EXPECT_EQ(a.bands.lumens_per_watt, b.bands.lumens_per_watt);
  EXPECT_EQ(a.metres_per_unit, b.metres_per_unit);
  EXPECT_EQ(a.unit_name, b.unit_name);
  EXPECT_EQ(a.relative_units, b.relative_units);
  expect_same_bits(a.patch_radiosity, b.patch_radiosity, "patch_radiosity");
  expect_same_bits(a.direct_irradiance, b.direct_irradiance, "direct_irradiance");
  expect_same_bits(a.indirect_irradiance, b.indirect_irradiance, "indirect_irradiance");
  expect_same_bits(a.caustic_irradiance, b.caustic_irradiance, "caustic_irradiance");
  ASSERT_EQ(a.interpolation_error.size(), b.interpolation_error.size());
  EXPECT_TRUE((a.interpolation_error == b.interpolation_error).all());
  ASSERT_EQ(a.history.size(), b.history.size());
  for (std::size_t i = 0; i < a.history.size(); ++i) {
    EXPECT_EQ(a.history[i].residual, b.history[i].residual);
    EXPECT_EQ(a.history[i].seconds, b.history[i].seconds);
  }
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a.residual), std::bit_cast<std::uint64_t>(b.residual));
  EXPECT_EQ(a.energy.emitted, b.energy.emitted);
  EXPECT_EQ(a.energy.absorbed, b.energy.absorbed);
  EXPECT_EQ(a.energy.escaped, b.energy.escaped);
  EXPECT_EQ(a.energy.unshot, b.energy.unshot);
  EXPECT_EQ(a.error_estimate, b.error_estimate);
  EXPECT_EQ(a.parts.of_patch, b.parts.of_patch);
  ASSERT_EQ(a.parts.count(), b.parts.count());
  for (int p = 0; p < a.parts.count(); ++p) {
    EXPECT_EQ(a.parts.parts[p].name, b.parts.parts[p].name);
    EXPECT_EQ(a.parts.parts[p].area, b.parts.parts[p].area);
    EXPECT_EQ(a.parts.parts[p].error_estimate, b.parts.parts[p].error_estimate);
    EXPECT_EQ(a.parts.parts[p].is_lit_by_cracks, b.parts.parts[p].is_lit_by_cracks);
  }
  ASSERT_EQ(a.seconds.size(), b.seconds.size());
  for (std::size_t i = 0; i < a.seconds.size(); ++i) {
    EXPECT_EQ(a.seconds[i].phase, b.seconds[i].phase);
    EXPECT_EQ(a.seconds[i].seconds, b.seconds[i].seconds);
  }
  EXPECT_EQ(a.provenance.version, b.provenance.version);
  EXPECT_EQ(a.provenance.scene_file, b.provenance.scene_file);
  EXPECT_EQ(a.provenance.scene_hash, b.provenance.scene_hash);
  EXPECT_EQ(a.provenance.options, b.provenance.options);
  EXPECT_EQ(a.provenance.refinement, b.provenance.refinement);
  EXPECT_EQ(a.provenance.looked_from, b.provenance.looked_from);
}

class SolutionFileBands : public SolutionFile, public testing::WithParamInterface<int> {};

TEST_P(SolutionFileBands, RestoresEveryBit) {
  const SolvedScene solved = small_solution(GetParam());
  write_solution(folder_ / "s.vtp", solved);
  const SolvedScene again = read_solution(folder_ / "s.vtp");
  expect_same_mesh(solved.mesh, again.mesh);
  expect_same_solution(solved.solution, again.solution);
  EXPECT_EQ(folder_.file_count(), 1) << "a temporary file was left behind";
}
INSTANTIATE_TEST_SUITE_P(Bands, SolutionFileBands, testing::Values(1, 3, 76, max_bands));

TEST_F(SolutionFile, RestoresWhatRefinementFound) {
  SolvedScene solved = small_solution(3);
  solved.solution.interpolation_error =
      Eigen::ArrayXf::LinSpaced(solved.mesh.element_count(), 0.0f, 0.3f);
  solved.solution.provenance.refinement = "the tolerance is reached";
  solved.solution.provenance.looked_from = {"desk.csv", "door"};
  write_solution(folder_ / "s.vtp", solved);
  expect_same_solution(solved.solution, read_solution(folder_ / "s.vtp").solution);
}

TEST_F(SolutionFile, RestoresTheParts) {
  SolvedScene solved = small_solution(3);
  solved.solution.parts = {.of_patch = {1, -1},
                           .parts = {{.name = "floor, wall", .area = 3.25},
                                     {.name = "küche (2)", .area = 0.1, .error_estimate = 0.03}}};
  write_solution(folder_ / "s.vtp", solved);
  expect_same_solution(solved.solution, read_solution(folder_ / "s.vtp").solution);
  solved.solution.parts.of_patch = {1, 2};
  write_solution(folder_ / "s.vtp", solved);
  EXPECT_THROW(read_solution(folder_ / "s.vtp"), InputError) << "there is no third part";
}

// Names come in any encoding from file systems and old programs, and hold what no XML may hold.
TEST_F(SolutionFile, RestoresNamesThatAreNotUtf8) {
  SolvedScene solved = small_solution(3);
  RadiositySolution& solution = solved.solution;
  solution.provenance.scene_file = "B\xfcro \x01<&>?>\xef\xbf\xbf.obj";
  solution.provenance.looked_from = {"fen\xeatre"};
  solution.bands.names = {"\xfc", "gr\xfcn", "\x02"};
  solution.parts = {.of_patch = {1, 0},
                    .parts = {{.name = "K\xfc"
                                       "che"},
                              {.name = "\xc3", .is_lit_by_cracks = true}}};
  write_solution(file(), solved);
  const SolvedScene again = read_solution(file());
  expect_same_solution(solution, again.solution);
  EXPECT_EQ(again.solution.parts.parts.front().name,
            "K\xfc"
            "che");
}

TEST_F(SolutionFile, RestoresFrustumsAmongSpheres) {
  SolvedScene solved = small_solution(3);
  const Frustum ring{.base = {1, 2, 3},
                     .axis = Eigen::Vector3d(1, -2, 2) / 3.0,
                     .height = 0.0,
                     .base_radius = 0.7,
                     .top_radius = 0.2,
                     .inward = true};
  solved.mesh.round_grids[0].shape = ring;
  write_solution(file(), solved);
  const SolvedScene again = read_solution(file());
  expect_same_mesh(solved.mesh, again.mesh);
  const auto& found = std::get<Frustum>(again.mesh.round_grids[0].shape);
  EXPECT_EQ(found.axis, ring.axis);
  EXPECT_EQ(found.top_radius, ring.top_radius);
  EXPECT_TRUE(found.inward);
  EXPECT_TRUE(std::holds_alternative<Sphere>(again.mesh.round_grids[1].shape));
}

TEST_F(SolutionFile, RestoresASolutionWithoutHistoryOrSpheres) {
  SolvedScene solved = small_solution(3);
  solved.mesh.round_grids.clear();
  solved.solution.history.clear();
  solved.solution.seconds.clear();
  solved.solution.provenance = {};
  solved.solution.residual = std::numeric_limits<double>::quiet_NaN();
  write_solution(file(), solved);
  const SolvedScene again = read_solution(file());
  expect_same_mesh(solved.mesh, again.mesh);
  expect_same_solution(solved.solution, again.solution);
}

TEST_F(SolutionFile, BeginsWithTextForPeople) {
  write_solution(file(), small_solution(3));
  std::istringstream start(contents(file()).substr(0, 600));
  std::string line;
  std::getline(start, line);
  EXPECT_EQ(line, "<?lightwell-solution format=\"1\"");
  EXPECT_NE(start.str().find("2 patches, 3 elements, 9 vertices"), std::string::npos);
  EXPECT_NE(start.str().find("options: solve --accuracy 1%"), std::string::npos);
}

TEST_F(SolutionFile, SaysWhetherItsLightIsInWatts) {
  SolvedScene solved = small_solution(3);
  for (const bool is_relative : {false, true}) {
    solved.solution.relative_units = is_relative;
    write_solution(file(), solved);
    EXPECT_EQ(read_solution(file()).solution.relative_units, is_relative);
    const std::string start = contents(file()).substr(0, 800);
    EXPECT_EQ(start.find("energy: 100 W emitted") == std::string::npos, is_relative) << start;
    EXPECT_EQ(start.find("energy: 100 (no known unit) emitted") != std::string::npos, is_relative);
  }
}

TEST_F(SolutionFile, AFailedWriteNamesTheFileAndKeepsTheOldOne) {
  const SolvedScene solved = small_solution(3);
  try {
    write_solution(folder_ / "absent" / "s.vtp", solved);
    FAIL() << "wrote into a folder that does not exist";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("absent/s.vtp"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(std::strerror(ENOENT)), std::string::npos) << e.what();
  }
  fs::create_directories(file() / "occupied");
  EXPECT_THROW(write_solution(file(), solved), std::runtime_error);
  EXPECT_EQ(folder_.file_count(), 1) << "a temporary file was left behind";
}

TEST_F(SolutionFile, ASolutionOfAnotherSceneIsRefused) {
  Scene scene;
  scene.file = "mine.toml";
  scene.materials.push_back({.name = "m", .reflectance = constant_spectrum(scene.bands, 0.5f)});
  RadiositySolution s;
  s.provenance.scene_file = "other.toml";
  s.provenance.scene_hash = scene_hash(scene);
  EXPECT_NO_THROW(check_matches(scene, s));
  scene.materials[0].reflectance[1] = 0.6f;
  try {
    check_matches(scene, s);
    FAIL() << "accepted a solution for other materials";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("other.toml"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("mine.toml"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace lightwell::solution_file_test
