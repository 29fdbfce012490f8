// The files of OpenFOAM and MOOSE, read back.
#include "radiosity/form_factors/heat_solver_files.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "scene/errors.h"
#include "tests/temporary_folder.h"

namespace lightwell::heat_solver_files_test {
namespace {

// Four rows of the areas 1, 2, 4 and 2 m^2, closed and reciprocal. A_i F_ij: 0.5 between 0 and 1,
// 0.5 between 0 and 2, 1.5 between 1 and 2, 2 between 2 and 3. The floor has the rows 0 and 1.
ViewFactors closed() {
  ViewFactors F(4);
  F.area = {1.0, 2.0, 4.0, 2.0};
  const std::vector<std::vector<FormFactor>> rows = {{{1, 0.5f}, {2, 0.5f}},
                                                     {{0, 0.25f}, {2, 0.75f}},
                                                     {{0, 0.125f}, {1, 0.375f}, {3, 0.5f}},
                                                     {{2, 1.0f}}};
  for (std::size_t i = 0; i < rows.size(); ++i) F.factors.append(static_cast<int>(i), rows[i]);
  F.factors.close();
  return F;
}
ViewFactorRows named() {
  return {.name = {"floor", "floor", "side wall", "side_wall"}};
}

// A list of lists of OpenFOAM behind the head of its file, N ( n(a b) ... ), or one list.
std::vector<std::vector<double>> foam_lists(const std::string& text, const std::string& type,
                                            const std::string& object) {
  EXPECT_TRUE(says(text, "FoamFile\n{"));
  EXPECT_TRUE(says(text, "format      ascii;"));
  EXPECT_TRUE(says(text, "class       " + type + ";"));
  EXPECT_TRUE(says(text, "object      " + object + ";"));
  std::istringstream in(text.substr(text.find("}\n") + 2));
  const auto expect = [&](char wanted) {
    char c = ' ';
    in >> c;
    EXPECT_EQ(c, wanted) << object;
  };
  std::size_t count = 0;
  in >> count;
  expect('(');
  std::vector<std::vector<double>> lists(type == "labelList" ? 1 : count);
  for (auto& list : lists) {
    std::size_t length = count;
    if (type != "labelList") {
      in >> length;
      expect('(');
    }
    list.resize(length);
    for (double& value : list) in >> value;
    expect(')');
  }
  if (type != "labelList") expect(')');
  EXPECT_TRUE(in) << object;
  return lists;
}

struct Openfoam {
  std::vector<std::vector<double>> F, faces, agglomeration, sub_map, construct_map, size;

  explicit Openfoam(const TemporaryFolder& folder) {
    const auto read = [&](const char* type, const char* name) {
      return foam_lists(content_of(folder / name), type, name);
    };
    F = read("scalarListList", "F");
    faces = read("labelListList", "globalFaceFaces");
    agglomeration = read("labelListList", "finalAgglom");
    sub_map = read("labelListList", "subMap");
    construct_map = read("labelListList", "constructMap");
    size = read("labelList", "constructMapDim");
  }
  double factor(std::size_t i, std::size_t j) const {
    for (std::size_t k = 0; k < faces[i].size(); ++k) {
      if (faces[i][k] == static_cast<double>(j)) return F[i][k];
    }
    return 0.0;
  }
};

using Lists = std::vector<std::vector<double>>;

TEST(Openfoam, ListsCloseAndAreReciprocalWhenReadBack) {
  const TemporaryFolder folder;
  const ViewFactors F = closed();
  write_openfoam(folder.path(), F, named());
  EXPECT_EQ(folder.file_count(), static_cast<int>(openfoam_file_names().size()));
  const Openfoam read(folder);
  ASSERT_EQ(read.F.size(), 4u);
  ASSERT_EQ(read.faces.size(), 4u);
  // The factors are binary fractions, which nine digits restore.
  for (std::size_t i = 0; i < 4; ++i) {
    ASSERT_EQ(read.F[i].size(), read.faces[i].size());
    double sum = 0.0;
    for (std::size_t j = 0; j < 4; ++j) {
      sum += read.factor(i, j);
      EXPECT_EQ(F.area[i] * read.factor(i, j), F.area[j] * read.factor(j, i)) << i << ", " << j;
    }
    EXPECT_EQ(sum, 1.0) << i;
  }
  EXPECT_EQ(read.factor(2, 3), 0.5);
  EXPECT_EQ(read.agglomeration, (Lists{{0, 1}, {0}, {0}})) << "a patch for each surface";
  EXPECT_EQ(read.sub_map, (Lists{{0, 1, 2, 3}})) << "one processor";
  EXPECT_EQ(read.construct_map, read.sub_map);
  EXPECT_EQ(read.size, (Lists{{4}}));
}

TEST(Openfoam, FacesCountFromTheFirstOfTheRowsThatAreWritten) {
  const TemporaryFolder folder;
  write_openfoam(folder.path(), closed(), named(), 2);
  const Openfoam read(folder);
  EXPECT_EQ(read.F, (Lists{{0.5}, {1.0}}));
  EXPECT_EQ(read.faces, (Lists{{1}, {0}}));
  EXPECT_EQ(read.agglomeration, (Lists{{0}, {0}}));
  EXPECT_EQ(read.size, (Lists{{2}}));
}

// Areas: floor 3, walls 4 and 2. A_I F_IJ: 1 within the floor, 2 between floor and wall, 2 between
// the walls.
TEST(Moose, RowsOfASurfaceAreAddedByArea) {
  const SurfaceViewFactors surfaces = surface_view_factors("F.csv", closed(), named());
  EXPECT_EQ(surfaces.name, (std::vector<std::string>{"floor", "side_wall", "side_wall_2"}))
      << "words, each once";
  EXPECT_EQ(surfaces.area, (std::vector<double>{3.0, 4.0, 2.0}));
  const Lists exchange = {{1.0, 2.0, 0.0}, {2.0, 0.0, 2.0}, {0.0, 2.0, 0.0}};
  for (std::size_t i = 0; i < 3; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < 3; ++j) {
      // Two additions and divisions of doubles below 3.
      EXPECT_NEAR(surfaces.area[i] * surfaces.factor[i][j], exchange[i][j], 4e-15);
      sum += surfaces.factor[i][j];
    }
    EXPECT_NEAR(sum, 1.0, 4e-15);
  }
}

TEST(Moose, UserObjectsAndTablesReadBack) {
  const TemporaryFolder folder;
  write_moose(folder / "F.csv", closed(), named());
  std::istringstream table(content_of(folder / "F.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "boundary,area,floor,side_wall,side_wall_2");
  const SurfaceViewFactors surfaces = surface_view_factors("F.csv", closed(), named());
  for (std::size_t i = 0; std::getline(table, line); ++i) {
    ASSERT_LT(i, 3u);
    std::istringstream cells(line);
    std::string cell;
    std::getline(cells, cell, ',');
    EXPECT_EQ(cell, surfaces.name[i]);
    std::getline(cells, cell, ',');
    EXPECT_EQ(std::stod(cell), surfaces.area[i]);
    for (const double factor : surfaces.factor[i]) {
      ASSERT_TRUE(std::getline(cells, cell, ','));
      EXPECT_NEAR(std::stod(cell), factor, 0.5e-9) << "nine digits of numbers up to 1";
    }
  }
  write_moose(folder / "F.i", closed(), named());
  const std::string object = content_of(folder / "F.i");
  EXPECT_TRUE(
      says(object, "type = SpecifiedViewFactor\n    boundary = 'floor side_wall side_wall_2'"));
  EXPECT_TRUE(says(object,
                   "view_factors = '\n      0.333333333 0.666666667 0;\n      0.5 0 0.5;\n"
                   "      0 1 0'\n"));
}

TEST(Moose, TooManySurfacesAreRefused) {
  constexpr int count = most_moose_surfaces + 1;
  ViewFactors F(count);
  ViewFactorRows rows;
  for (int i = 0; i < count; ++i) {
    F.area[static_cast<std::size_t>(i)] = 1.0;
    rows.name.push_back(std::to_string(i));
  }
  F.factors.close();
  EXPECT_TRUE(says(message_of<InputError>([&] { surface_view_factors("F.i", F, rows); }),
                   "F.i: view factors between 2001 surfaces"));
}

}  // namespace
}  // namespace lightwell::heat_solver_files_test
