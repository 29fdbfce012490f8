#include "radiosity/solution_file.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <functional>
#include <sstream>

#include "radiosity/solution_seal.h"

namespace lightwell {
namespace {

namespace fs = std::filesystem;

/// A folder of its own that goes away with the test.
class SolutionFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("lightwell-" + std::string(info->name()) + "-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path file(const std::string& name = "s.vtp") const { return folder_ / name; }
  std::size_t file_count() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

/// Band values with every awkward bit pattern that must survive: signed zero, the smallest
/// denormal, the largest number, infinity, no number, and thirds that no short decimal can hold.
BandArray awkward(int rows, int bands, int seed) {
  const float special[] = {-0.0f,
                           std::numeric_limits<float>::denorm_min(),
                           std::numeric_limits<float>::max(),
                           std::numeric_limits<float>::infinity(),
                           1.0f / 3.0f,
                           std::numeric_limits<float>::quiet_NaN()};
  BandArray values(rows, bands);
  for (int i = 0; i < rows * bands; ++i) {
    const int n = i + seed;
    values.data()[i] = n % 3 == 0 ? special[n / 3 % 6] : static_cast<float>(n) / 7.0f;
  }
  return values;
}

/// One two-sided quad and a triangle beside it, in two patches a side, with a sphere grid that
/// borrows their elements: small, and with something in every array.
SolvedScene small_solution(int band_count) {
  SolvedScene solved;
  PatchMesh& mesh = solved.mesh;
  const std::vector<Eigen::Vector3d> positions = {
      {0, 0, 0.1}, {1, 0, 0.1}, {1, 1.0 / 3.0, 0.1}, {0, 1, 0.1}, {2, 0, 0.1},
      {0, 0, 0.1}, {0, 1, 0.1}, {1, 1.0 / 3.0, 0.1}, {1, 0, 0.1}};
  mesh.corners = {{0, 1, 2, 3}, {1, 4, 2, -1}, {5, 6, 7, 8}};
  mesh.patch = {0, 0, 1};
  mesh.element_area = Eigen::Array3d(2.0 / 3.0, 1.0 / 6.0, 2.0 / 3.0);
  mesh.twin = {2, -1, 0};
  mesh.first_element = {0, 2, 3};
  mesh.area = Eigen::Array2d(5.0 / 6.0, 2.0 / 3.0);
  mesh.reflectance = BandArray::Constant(2, band_count, 0.3f);
  mesh.emission = awkward(2, band_count, 4);
  mesh.surface = {4, 4};
  mesh.material = {1, 2};
  mesh.facet = {7, 7};
  mesh.is_back = {0, 1};
  mesh.sphere_grids = {
      {.facet = 3,
       .sphere = {{0.1, 0.2, 0.3}, 0.7},
       .rings = 1,
       .sectors = 3,
       .element = {0, 1, 2}},
      {.facet = 5, .sphere = {{1, 2, 3}, 0.1}, .rings = 2, .sectors = 1, .element = {2, 0}}};
  build_topology(mesh, positions);

  RadiositySolution& s = solved.solution;
  if (band_count == 3) {
    s.bands = rgb_bands(179.0);
  } else {
    s.bands = spectral_bands(400.0, 700.0, band_count);
  }
  s.bands.names[0] = "<\"a\" & 'b'>";
  s.metres_per_unit = 0.0254;
  s.unit_name = "in";
  s.patch_radiosity = awkward(2, band_count, 0);
  s.direct_irradiance = awkward(9, band_count, 1);
  s.indirect_irradiance = awkward(9, band_count, 2);
  s.history = {{1.0, 0.001}, {1.0 / 3.0, 0.002}, {1e-300, 0.003}};
  s.outcome = Outcome::max_sweeps_reached;
  s.residual = 0.1;
  s.energy = {100.0, 1.0 / 3.0, 2.0 / 3.0, 1e-17};
  s.error_estimate = 0.0123;
  s.seconds = {{"mesh", 0.1}, {"form factors", 1.0 / 7.0}};
  s.provenance = {"0.1.0", "räume/<box> ?> \"1\".toml", 0xfedcba9876543210u,
                  "solve --accuracy 1% -- '&'\n"};
  return solved;
}

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
  ASSERT_EQ(a.elements.n_vertices(), b.elements.n_vertices());
  ASSERT_EQ(a.elements.n_faces(), b.elements.n_faces());
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
  ASSERT_EQ(a.sphere_grids.size(), b.sphere_grids.size());
  for (std::size_t g = 0; g < a.sphere_grids.size(); ++g) {
    EXPECT_EQ(a.sphere_grids[g].facet, b.sphere_grids[g].facet);
    EXPECT_EQ(a.sphere_grids[g].sphere.center, b.sphere_grids[g].sphere.center);
    EXPECT_EQ(a.sphere_grids[g].sphere.radius, b.sphere_grids[g].sphere.radius);
    EXPECT_EQ(a.sphere_grids[g].rings, b.sphere_grids[g].rings);
    EXPECT_EQ(a.sphere_grids[g].sectors, b.sphere_grids[g].sectors);
    EXPECT_EQ(a.sphere_grids[g].element, b.sphere_grids[g].element);
  }
}

void expect_same_solution(const RadiositySolution& a, const RadiositySolution& b) {
  EXPECT_EQ(a.bands.names, b.bands.names);
  EXPECT_EQ(a.bands.wavelengths_nm, b.bands.wavelengths_nm);
  expect_same_bits(a.bands.xyz, b.bands.xyz, "xyz");
  EXPECT_EQ(a.bands.lumens_per_watt, b.bands.lumens_per_watt);
  EXPECT_EQ(a.metres_per_unit, b.metres_per_unit);
  EXPECT_EQ(a.unit_name, b.unit_name);
  expect_same_bits(a.patch_radiosity, b.patch_radiosity, "patch_radiosity");
  expect_same_bits(a.direct_irradiance, b.direct_irradiance, "direct_irradiance");
  expect_same_bits(a.indirect_irradiance, b.indirect_irradiance, "indirect_irradiance");
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
  ASSERT_EQ(a.seconds.size(), b.seconds.size());
  for (std::size_t i = 0; i < a.seconds.size(); ++i) {
    EXPECT_EQ(a.seconds[i].phase, b.seconds[i].phase);
    EXPECT_EQ(a.seconds[i].seconds, b.seconds[i].seconds);
  }
  EXPECT_EQ(a.provenance.version, b.provenance.version);
  EXPECT_EQ(a.provenance.scene_file, b.provenance.scene_file);
  EXPECT_EQ(a.provenance.scene_hash, b.provenance.scene_hash);
  EXPECT_EQ(a.provenance.options, b.provenance.options);
}

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void put(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// What read_solution says about a file it must refuse; also checks that it is the only one to
/// speak.
std::string refusal(const fs::path& path) {
  testing::internal::CaptureStderr();
  std::string message;
  try {
    read_solution(path);
  } catch (const InputError& e) {
    message = e.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  if (!message.empty()) {
    EXPECT_NE(message.find(path.string()), std::string::npos) << message;
  }
  return message;
}

void expect_refused(const fs::path& path, const std::string& reason) {
  const std::string message = refusal(path);
  EXPECT_NE(message.find(reason), std::string::npos) << "message: '" << message << "'";
}

class SolutionFileBands : public SolutionFile, public testing::WithParamInterface<int> {};

TEST_P(SolutionFileBands, RestoresEveryBit) {
  const SolvedScene solved = small_solution(GetParam());
  write_solution(folder_ / "s.vtp", solved);
  const SolvedScene again = read_solution(folder_ / "s.vtp");
  expect_same_mesh(solved.mesh, again.mesh);
  expect_same_solution(solved.solution, again.solution);
  EXPECT_EQ(file_count(), 1u) << "a temporary file was left behind";
}
INSTANTIATE_TEST_SUITE_P(Bands, SolutionFileBands, testing::Values(1, 3, 76, max_bands));

TEST_F(SolutionFile, RestoresASolutionWithoutHistoryOrSpheres) {
  SolvedScene solved = small_solution(3);
  solved.mesh.sphere_grids.clear();
  solved.solution.history.clear();
  solved.solution.seconds.clear();
  solved.solution.provenance = {};
  solved.solution.residual = std::numeric_limits<double>::quiet_NaN();
  write_solution(file(), solved);
  const SolvedScene again = read_solution(file());
  expect_same_mesh(solved.mesh, again.mesh);
  expect_same_solution(solved.solution, again.solution);
}

TEST_F(SolutionFile, IsPolyDataThatAnyVtkReaderOpens) {
  const SolvedScene solved = small_solution(3);
  write_solution(file(), solved);
  vtkNew<vtkXMLPolyDataReader> reader;
  EXPECT_TRUE(reader->CanReadFile(file().c_str()));
  reader->SetFileName(file().c_str());
  reader->Update();
  vtkPolyData* poly = reader->GetOutput();
  EXPECT_EQ(poly->GetNumberOfPoints(), 9);
  EXPECT_EQ(poly->GetNumberOfPolys(), 3);
  vtkPointData* light = poly->GetPointData();
  ASSERT_NE(light->GetScalars(), nullptr);
  EXPECT_STREQ(light->GetScalars()->GetName(), "rgb");
  EXPECT_EQ(light->GetScalars()->GetDataType(), VTK_UNSIGNED_CHAR);
  for (const char* name : {"irradiance", "direct_irradiance", "indirect_irradiance", "radiosity"}) {
    ASSERT_NE(light->GetArray(name), nullptr) << name;
    EXPECT_EQ(light->GetArray(name)->GetNumberOfComponents(), 3) << name;
    EXPECT_EQ(light->GetArray(name)->GetComponentName(0), std::string("__a_ _ _b__")) << name;
    EXPECT_STREQ(light->GetArray(name)->GetComponentName(2), "b") << name;
  }
  for (const char* name : {"patch", "twin", "surface", "material", "facet", "area"}) {
    EXPECT_NE(poly->GetCellData()->GetArray(name), nullptr) << name;
  }
}

/// E = 100 W/m^2 in every RGB band is 100 * 683 lx, because the luminance weights sum to 1; and a
/// grey vertex must look grey.
TEST_F(SolutionFile, HoldsIlluminanceInLuxAndColorsForDisplay) {
  SolvedScene solved = small_solution(3);
  solved.solution.bands = rgb_bands();
  solved.mesh.emission.setZero();
  solved.solution.direct_irradiance.setConstant(75.0f);
  solved.solution.indirect_irradiance.setConstant(25.0f);
  write_solution(file(), solved);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file().c_str());
  reader->Update();
  vtkPointData* light = reader->GetOutput()->GetPointData();
  // The three weights are rounded to float, each to half a unit in the last place.
  EXPECT_NEAR(light->GetArray("illuminance_lux")->GetComponent(0, 0), 68300.0, 68300.0 * 2e-7);
  // Every surface at the mean: x = 1/2, so x/(1+x) = 1/3, in sRGB 1.055 (1/3)^(1/2.4) - 0.055 =
  // 0.6125, and that is 156.2 of 255.
  for (int c = 0; c < 3; ++c) EXPECT_EQ(light->GetScalars()->GetComponent(4, c), 156.0);
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

TEST_F(SolutionFile, TornFilesAreRefusedWhereverTheyEnd) {
  write_solution(file(), small_solution(3));
  const std::string whole = contents(file());
  for (std::size_t length = 0; length < whole.size(); length += length < 100 ? 7 : 97) {
    put(file("torn.vtp"), whole.substr(0, length));
    const std::string message = refusal(file("torn.vtp"));
    EXPECT_NE(message, "") << length << " of " << whole.size() << " bytes were accepted";
  }
  put(file("torn.vtp"), whole.substr(0, whole.size() / 2));
  expect_refused(file("torn.vtp"), "torn");
}

TEST_F(SolutionFile, OneChangedByteIsNoticedAnywhere) {
  write_solution(file(), small_solution(3));
  const std::string whole = contents(file());
  for (std::size_t at = 0; at < whole.size(); at += 53) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    put(file("changed.vtp"), changed);
    EXPECT_NE(refusal(file("changed.vtp")), "") << "byte " << at;
  }
}

TEST_F(SolutionFile, ForeignFilesAreRefusedWithTheReason) {
  expect_refused(file("none.vtp"), "no such file");
  expect_refused(folder_, "folder");
  put(file("empty.vtp"), "");
  expect_refused(file("empty.vtp"), "empty");
  put(file("scene.toml"), "[camera]\nposition = [0, 0, 0]\n");
  expect_refused(file("scene.toml"), "not a Lightwell solution");
  put(file("noise.vtp"), std::string(5000, '\xff'));
  expect_refused(file("noise.vtp"), "not a Lightwell solution");
  put(file("other.vtp"), "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\"></VTKFile>\n");
  expect_refused(file("other.vtp"), "did not write");
  put(file("newer.vtp"), "<?lightwell-solution format=\"2\"\n?>\n<VTKFile/>\n");
  expect_refused(file("newer.vtp"), "solution format 2");
}

/// Someone who knows the format seals a file again after a change: its numbers are still checked.
class ResealedSolution : public SolutionFile {
 protected:
  void expect_refused_after(const std::function<void(vtkPolyData*)>& change,
                            const std::string& reason) {
    write_solution(file(), small_solution(3));
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(file().c_str());
    reader->Update();
    change(reader->GetOutput());
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(reader->GetOutput());
    writer->SetFileName(file("changed.vtp").c_str());
    writer->SetEncodeAppendedData(0);
    writer->Write();
    put(file("changed.vtp"), solution_preamble("") + contents(file("changed.vtp")));
    seal_solution(file("changed.vtp"));
    expect_refused(file("changed.vtp"), reason);
  }
};

TEST_F(ResealedSolution, IndicesOutOfRangeAreRefused) {
  const auto set = [](vtkFieldData* data, const char* name, vtkIdType row, double value) {
    data->GetArray(name)->SetComponent(row, 0, value);
  };
  using Poly = vtkPolyData*;
  expect_refused_after([&](Poly p) { set(p->GetCellData(), "twin", 0, 3); }, "'twin' holds 3");
  expect_refused_after([&](Poly p) { set(p->GetCellData(), "patch", 2, -1); }, "'patch' holds -1");
  expect_refused_after([&](Poly p) { set(p->GetCellData(), "patch", 2, 0); }, "whose elements");
  expect_refused_after([&](Poly p) { set(p->GetCellData(), "area", 1, 0.0); }, "not positive");
  expect_refused_after([&](Poly p) { set(p->GetFieldData(), "patch_material", 0, -4); },
                       "'patch_material' holds -4");
  expect_refused_after([&](Poly p) { set(p->GetFieldData(), "patch_first_element", 1, 9); },
                       "does not divide");
  expect_refused_after([&](Poly p) { set(p->GetFieldData(), "sphere_element", 1, 12); },
                       "'sphere_element' holds 12");
  expect_refused_after([&](Poly p) { set(p->GetFieldData(), "sphere_facet_rings_sectors", 1, -5); },
                       "sphere grid 1");
  expect_refused_after([&](Poly p) { set(p->GetFieldData(), "outcome", 0, 7); },
                       "'outcome' holds 7");
  expect_refused_after(
      [&](Poly p) { p->GetPolys()->GetConnectivityArray()->SetComponent(2, 0, 9); },
      "names point 9 of 9");
  expect_refused_after(
      [&](Poly p) { p->GetPolys()->GetConnectivityArray()->SetComponent(2, 0, 0); }, "twice");
  expect_refused_after(
      [&](Poly p) {
        vtkNew<vtkCellArray> pentagon_first;
        pentagon_first->InsertNextCell({0, 1, 4, 2, 3});
        pentagon_first->InsertNextCell({1, 4, 2});
        pentagon_first->InsertNextCell({5, 6, 7, 8});
        p->SetPolys(pentagon_first);
      },
      "polygon 0 has neither 3 nor 4");
}

TEST_F(ResealedSolution, MissingArraysAreNamed) {
  for (const char* name : {"patch_area", "patch_radiosity", "scene_hash",
                           "energy_emitted_absorbed_"
                           "escaped_unshot"}) {
    expect_refused_after([&](vtkPolyData* p) { p->GetFieldData()->RemoveArray(name); }, name);
  }
  for (const char* name : {"direct_irradiance", "normal"}) {
    expect_refused_after([&](vtkPolyData* p) { p->GetPointData()->RemoveArray(name); }, name);
  }
  expect_refused_after([](vtkPolyData* p) { p->Initialize(); }, "cannot read");
}

TEST_F(SolutionFile, AFailedWriteNamesTheFileAndKeepsTheOldOne) {
  const SolvedScene solved = small_solution(3);
  try {
    write_solution(folder_ / "absent" / "s.vtp", solved);
    FAIL() << "wrote into a folder that does not exist";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("absent/s.vtp'"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(std::strerror(ENOENT)), std::string::npos) << e.what();
  }
  fs::create_directories(file() / "occupied");
  EXPECT_THROW(write_solution(file(), solved), std::runtime_error);
  EXPECT_EQ(file_count(), 1u) << "a temporary file was left behind";
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
}  // namespace lightwell
