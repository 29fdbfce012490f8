#include "radiosity/form_factors/form_factor_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "mesh/build_patches.h"
#include "radiosity/solution/poly_data_file.h"
#include "scene/errors.h"
#include "tests/temporary_folder.h"

namespace lightwell::form_factor_file_test {
namespace {

/// A given matrix of form factors, whose rows close by the escaped share.
class GivenFactors : public FormFactors {
 public:
  explicit GivenFactors(std::vector<std::vector<FormFactor>> rows) : rows_(std::move(rows)) {}
  int patch_count() const override { return static_cast<int>(rows_.size()); }
  std::span<const FormFactor> row(int i) const override {
    return rows_[static_cast<std::size_t>(i)];
  }
  SpecularRow specular_row(int) const override { return {}; }
  Spectrum escaped(int i) const override {
    float sum = 0.0f;
    for (const auto [j, F] : row(i)) sum += F;
    return Spectrum::Constant(1, 1.0f - sum);
  }
  Spectrum absorbed_by_specular(int) const override { return Spectrum::Zero(1); }

 private:
  std::vector<std::vector<FormFactor>> rows_;
};

// Patches 0 and 1, of areas 1 and 3, see patch 2, of area 2; patch 3, of area 1, belongs to no row.
// A_i F_ij: 0.25 between 0 and 2, 0.75 between 1 and 2, 0.5 between 2 and 3.
PatchMesh mesh_of_areas() {
  PatchMesh mesh;
  mesh.area.resize(4);
  mesh.area << 1.0, 3.0, 2.0, 1.0;
  return mesh;
}
GivenFactors given() {
  return GivenFactors(
      {{{2, 0.25f}}, {{2, 0.25f}}, {{0, 0.125f}, {1, 0.375f}, {3, 0.25f}}, {{2, 0.5f}}});
}

/// Given view factors.
ViewFactors view_factors(const std::vector<double>& area,
                         const std::vector<std::vector<FormFactor>>& rows) {
  ViewFactors F(static_cast<int>(area.size()));
  F.area = area;
  for (std::size_t i = 0; i < rows.size(); ++i) F.factors.append(static_cast<int>(i), rows[i]);
  F.factors.close();
  return F;
}

TEST(ViewFactors, PatchesOfARowAreAddedByArea) {
  GivenFactors factors = given();
  const ViewFactors F = sum_form_factors(factors, mesh_of_areas(), {0, 0, 1, -1}, 3);
  ASSERT_EQ(F.row_count(), 3);
  EXPECT_EQ(F.area, (std::vector<double>{4.0, 2.0, 0.0}));
  EXPECT_FLOAT_EQ(F.factor(0, 1), (0.25f + 0.75f) / 4.0f);
  EXPECT_FLOAT_EQ(F.factor(1, 0), (0.25f + 0.75f) / 2.0f);
  EXPECT_EQ(F.factor(0, 0), 0.0f);
  EXPECT_TRUE(F.row(2).empty());
  EXPECT_DOUBLE_EQ(F.open[0], 0.75);
  EXPECT_DOUBLE_EQ(F.blocked[1], 0.25) << "what meets a patch of no row";
  EXPECT_LT(closure_error(F), 1e-7);
  EXPECT_EQ(reciprocity_error(F), 0.0);
}

TEST(ViewFactors, ErrorsOfClosureAndReciprocityAreSeen) {
  // A_0 F_01 = 1 and A_1 F_10 = 1, apart from the error added to the first.
  ViewFactors F = view_factors({4.0, 2.0}, {{{1, 0.25f + 0.125f}}, {{0, 0.5f}}});
  F.open = {0.75, 0.5};
  EXPECT_NEAR(closure_error(F), 0.125, 1e-7);
  EXPECT_NEAR(reciprocity_error(F), 0.125 * 4.0 / 2.0, 1e-7) << "over the smaller area";
  EXPECT_NEAR(reciprocity_error(view_factors({4.0, 2.0}, {{}, {{0, 0.5f}}})), 0.5, 1e-7)
      << "one of the two is missing";
  EXPECT_NEAR(reciprocity_error(view_factors({4.0, 2.0}, {{{1, 0.25f}}, {}})), 0.5, 1e-7);
}

TEST(ViewFactors, ErrorsOfIndependentPatchesAddUpAsSquares) {
  // Row 0 holds two patches of one factor each, row 1 one patch with two factors to row 0.
  const double row_0 = 1e-3 * std::sqrt(1.0 + 9.0) / 4.0, row_1 = 1e-3 * std::sqrt(2.0);
  EXPECT_NEAR(error_estimate({.row_error = {1e-3f, 1e-3f, 0.0f, 1.0f}}, given(), mesh_of_areas(),
                             {0, 0, 1, -1}),
              row_0, 1e-9);
  EXPECT_NEAR(error_estimate({.row_error = {0.0f, 0.0f, 1e-3f, 1.0f}}, given(), mesh_of_areas(),
                             {0, 0, 1, -1}),
              row_1, 1e-9);
}

// The two factors of row 1 are parts of one count: their sum has the variance of a share of the
// rays. Floats near 0.01 are rounded by 4.7e-10.
TEST(ViewFactors, ErrorsOfCountsAreThoseOfTheirSum) {
  const auto row_1 = [](float count_error) {
    return error_estimate(
        {.row_error = {0.0f, 0.0f, 1e-3f, 1.0f}, .count_error = {0.0f, 0.0f, count_error, 1.0f}},
        given(), mesh_of_areas(), {0, 0, 1, -1});
  };
  EXPECT_NEAR(row_1(1.2e-3f), 1.2e-3, 1e-9);
  EXPECT_NEAR(row_1(1e-2f), 1e-3 * std::sqrt(2.0), 1e-9) << "no more than the sum of variances";
  EXPECT_NEAR(row_1(1e-6f), 1e-3, 1e-9) << "no less than one of them";
}

std::string content(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// Numbers without a short decimal form.
ViewFactors thirds() {
  return view_factors({1.0, 2.0, 0.0, 0.5}, {{{1, 2.0f / 3.0f}, {3, 1e-30f}},
                                             {{0, 1.0f / 3.0f}, {3, std::nextafter(0.1f, 1.0f)}},
                                             {},
                                             {{1, 1.0f}}});
}

TEST(MatrixMarket, NumbersComeBackBitForBit) {
  const TemporaryFolder folder;
  const ViewFactors F = thirds();
  write_matrix_market(folder / "F.mtx", F, "two\nlines");
  std::ifstream in(folder / "F.mtx");
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "%%MatrixMarket matrix coordinate real general");
  std::getline(in, line);
  EXPECT_EQ(line, "% two");
  std::getline(in, line);
  EXPECT_EQ(line, "% lines");
  std::size_t rows = 0, columns = 0, entries = 0;
  in >> rows >> columns >> entries;
  EXPECT_EQ(rows, 4u);
  EXPECT_EQ(columns, 4u);
  ASSERT_EQ(entries, 5u);
  ASSERT_EQ(F.entry_count(), 5);
  std::size_t last_row = 0;
  for (std::size_t k = 0; k < entries; ++k) {
    std::size_t i = 0, j = 0;
    std::string value;
    in >> i >> j >> value;
    ASSERT_TRUE(i >= 1 && i <= 4 && j >= 1 && j <= 4) << "counted from 1";
    EXPECT_GE(i, last_row);
    EXPECT_EQ(std::stof(value), F.factor(static_cast<int>(i) - 1, static_cast<int>(j) - 1));
    last_row = i;
  }
  EXPECT_TRUE(in >> std::ws && in.eof());
}

TEST(MatrixMarket, NoFactorsAreAMatrixOfZeros) {
  const TemporaryFolder folder;
  const ViewFactors F = view_factors({1.0}, {});
  write_matrix_market(folder / "F.mtx", F, "");
  EXPECT_EQ(content(folder / "F.mtx"), "%%MatrixMarket matrix coordinate real general\n1 1 0\n");
}

TEST(View3dResult, IsTheHeaderAreasMatrixAndEmittances) {
  const TemporaryFolder folder;
  write_view3d(folder / "F.txt", thirds(), {0.9, 0.5, 1.0, 0.25}, 0.5,
               {.program = "Lightwell", .version = "1.2", .is_enclosure = true});
  EXPECT_EQ(content(folder / "F.txt"),
            "Lightwell 1.2 0 1 0 4         \n"
            "4 8 0 2\n"
            "0.000000 0.666667 0.000000 0.000000\n"
            "0.333333 0.000000 0.000000 0.100000\n"
            "0.000000 0.000000 0.000000 0.000000\n"
            "0.000000 1.000000 0.000000 0.000000\n"
            "0.900 0.500 1.000 0.250\n");
}

TEST(View3dResult, TooManyRowsAreRefusedBeforeAnythingIsWritten) {
  const TemporaryFolder folder;
  const ViewFactors F(most_view3d_rows + 1);
  const std::string message = message_of<InputError>(
      [&] { write_view3d(folder / "F.txt", F, std::vector<double>(F.area.size()), 1.0, {}); });
  EXPECT_TRUE(says(message, "30001"));
  EXPECT_EQ(folder.file_count(), 0);
}

// Two squares that face each other, one patch each.
PatchMesh two_squares() {
  Scene scene;
  scene.materials.push_back({.reflectance = constant_spectrum(scene.bands, 0.5f),
                             .specular = constant_spectrum(scene.bands, 0.0f),
                             .emission = constant_spectrum(scene.bands, 0.0f),
                             .one_sided = true});
  PolygonMesh mesh{
      .vertices = {
          {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}};
  mesh.facets = {{.boundary = {0, 1, 2, 3}}, {.boundary = {4, 5, 6, 7}}};
  scene.surfaces.push_back({.name = "squares", .shape = mesh});
  return build_patches(scene, {.max_patch_size = 10.0, .elements_per_patch_edge = 1});
}

TEST(RowPicture, HoldsTheRowsFactorsForEveryElement) {
  const TemporaryFolder folder;
  const ViewFactors F = view_factors({1.0, 1.0}, {{{1, 0.2f}}, {{0, 0.2f}}});
  write_row(folder / "row.vtp", two_squares(), {0, 1}, F, 1);
  EXPECT_EQ(folder.file_count(), 1);
  PolyDataFile file(folder / "row.vtp");
  ASSERT_EQ(file.polygon_count(), 2);
  const auto column = [&]<class T>(const char* name, T /*kind*/) {
    const StoredArray* array = file.find(PolyDataFile::Place::polygons, name);
    return array ? file.values<T>(*array) : std::vector<T>();
  };
  EXPECT_EQ(column("view_factor", 0.0f), (std::vector<float>{0.2f, 0.0f}));
  EXPECT_EQ(column("row", 0), (std::vector<int>{1, 2}));
  EXPECT_EQ(column("is_row", 0), (std::vector<int>{0, 1}));
}

TEST(FormFactorFiles, AFailedWriteNamesTheFileAndLeavesNothing) {
  const TemporaryFolder folder;
  const auto lost = folder / "no-such-folder" / "F.x";
  const ViewFactors F = thirds();
  EXPECT_TRUE(
      says(message_of<std::runtime_error>([&] { write_matrix_market(lost, F, ""); }), "F.x"));
  EXPECT_TRUE(says(message_of<std::runtime_error>(
                       [&] { write_view3d(lost, F, std::vector<double>(4), 1.0, {}); }),
                   "F.x"));
  EXPECT_TRUE(says(message_of<std::runtime_error>([&] {
                     write_row(lost, two_squares(), {0, 1}, F, 0);
                   }),
                   "F.x"));
  EXPECT_EQ(folder.file_count(), 0);
}

TEST(FormFactorFiles, ADiskThatFillsUpLeavesTheOldFile) {
  const TemporaryFolder folder;
  folder.write("F.mtx", "old");
  // The temporary file is a link to /dev/full, which acts as a full disk.
  const auto part = folder / ("F.mtx." + std::to_string(::getpid()) + ".part");
  std::filesystem::create_symlink("/dev/full", part);
  const std::string message =
      message_of<std::runtime_error>([&] { write_matrix_market(folder / "F.mtx", thirds(), ""); });
  EXPECT_TRUE(says(message, "F.mtx"));
  EXPECT_EQ(content(folder / "F.mtx"), "old");
  EXPECT_EQ(folder.file_count(), 1) << "the temporary is gone";
}

}  // namespace
}  // namespace lightwell::form_factor_file_test
