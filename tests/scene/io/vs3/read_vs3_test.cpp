#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numeric>

#include "scene/errors.h"
#include "scene/io/numbered_scene.h"
#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::read_vs3_test {
namespace {

NumberedScene read(const std::string& text) {
  const TemporaryFolder folder;
  return read_numbered_scene(folder.write("case.vs3", text));
}

std::vector<double> row_areas(const NumberedScene& numbered) {
  std::vector<double> area(numbered.rows.size(), 0.0);
  const auto facets = scene_facets(numbered.scene);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto& mesh = std::get<PolygonMesh>(
        numbered.scene.surfaces[static_cast<std::size_t>(facets[f].surface)].shape);
    const int row = numbered.row_of_facet[f];
    if (row < 0) continue;
    area[static_cast<std::size_t>(row)] +=
        facet_area(mesh, mesh.facets[static_cast<std::size_t>(facets[f].facet)]);
  }
  return area;
}

double total_area(const Surface& surface) {
  const auto& mesh = std::get<PolygonMesh>(surface.shape);
  return std::accumulate(
      mesh.facets.begin(), mesh.facets.end(), 0.0,
      [&](double sum, const Facet& facet) { return sum + facet_area(mesh, facet); });
}

// A floor 4 x 3 and eight points on it: a door at its edge, a window inside.
const std::string wall = R"(T  A wall ! with a title
F 3
V 1  0 0 0
V 2  4 0 0
V 3  4 3 0
V 4  0 3 0
V 5  1 0 0   ! door, on the edge
V 6  2 0 0
V 7  2 2 0
V 8  1 2 0
V 9  2.5 1 0
V 10 3.5 1 0
V 11 3.5 2 0
V 12 2.5 2 0
)";

TEST(ReadVs3, PlatesWithCommentsCommasAndTheirControlWords) {
  const NumberedScene numbered = read(R"(! comment
t  Two plates / one above the other
C  encl=1 list = 2, eps=1.0e-6
F  3
V,1,0.,0.,0.
V   2   1.00  0.00  0.00
/ another
v   3   1.00  1.00  0.00
V   4   0.00  1.00  0.00
V   5   0.00  0.00  1.00
V   6   1.00  0.00  1.00
V   7   1.00  1.00  1.00
!   #   v1  v2  v3  v4 base cmb emit  name
S   1    1   2   3   4   0   0  0.90  bottom/left ! faces up
S   2    7   6   5   0   0   0  0.25  top
End of data
S   3    what comes after the end is no data
)");
  EXPECT_EQ(numbered.scene.title, "Two plates / one above the other");
  EXPECT_TRUE(numbered.is_enclosure);
  ASSERT_EQ(numbered.rows.size(), 2u);
  EXPECT_EQ(numbered.rows[0].name, "bottom/left");
  EXPECT_EQ(numbered.rows[1].name, "top");
  EXPECT_DOUBLE_EQ(numbered.rows[1].emittance, 0.25);
  EXPECT_EQ(numbered.row_of_facet, (std::vector<int>{0, 1}));
  const Scene& scene = numbered.scene;
  const auto& bottom = std::get<PolygonMesh>(scene.surfaces[0].shape);
  const auto& top = std::get<PolygonMesh>(scene.surfaces[1].shape);
  EXPECT_TRUE(facet_normal(bottom, bottom.facets[0]).isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(facet_normal(top, top.facets[0]).isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(top.facets[0].boundary.size(), 3u) << "fourth vertex 0: a triangle";
  const Material& material = scene.materials[static_cast<std::size_t>(scene.surfaces[1].material)];
  EXPECT_TRUE(material.one_sided);
  EXPECT_TRUE((material.reflectance == 0.75f).all()) << "1 - emittance";
  EXPECT_TRUE(scene.notes.empty());
}

TEST(ReadVs3, IsASceneLikeAnyOther) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("a.VS3", wall + "S 1 1 2 3 4 0 0 0.9 floor\nE\n"));
  ASSERT_EQ(scene.surfaces.size(), 1u);
  EXPECT_DOUBLE_EQ(total_area(scene.surfaces[0]), 12.0);
}

TEST(ReadVs3, SubsurfacesAreCutOutOfTheirBase) {
  const NumberedScene numbered = read(wall + R"(
S 1  1  2  3  4  0 0 0.9 wall
S 2  5  6  7  8  1 0 0.9 door
S 3  9 10 11 12  1 0 0.9 window
)");
  const auto area = row_areas(numbered);
  ASSERT_EQ(area.size(), 3u);
  EXPECT_NEAR(area[0], 12.0 - 2.0 - 1.0, 1e-12);
  EXPECT_NEAR(area[1], 2.0, 1e-12);
  EXPECT_NEAR(area[2], 1.0, 1e-12);
  const auto& pieces = std::get<PolygonMesh>(numbered.scene.surfaces[0].shape);
  for (const Facet& facet : pieces.facets) {
    EXPECT_TRUE(facet_normal(pieces, facet).isApprox(Eigen::Vector3d::UnitZ()));
  }
}

TEST(ReadVs3, CombinedSurfacesAreOneRowAndNumbersCloseUp) {
  const NumberedScene numbered = read(wall + R"(
S 1  1  5  8  4  0 0 0.9 left
S 2  5  6  7  8  0 0 0.5 door
S 3  9 10 11 12  0 1 0.3 with-left
)");
  ASSERT_EQ(numbered.rows.size(), 2u);
  EXPECT_EQ(numbered.rows[1].name, "door");
  EXPECT_EQ(numbered.row_of_facet, (std::vector<int>{0, 1, 0}));
  EXPECT_NEAR(row_areas(numbered)[0], 2.5 + 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(numbered.rows[0].emittance, 0.9);
}

TEST(ReadVs3, NullSurfacesAndObstructionsAreOpaqueWithoutARow) {
  const NumberedScene numbered = read(wall + R"(
S 1  1  2  3  4  0 0 0.9 wall
N 2  9 10 11 12  1 0 0.9 gap
O 3  5  6  7  8
)");
  ASSERT_EQ(numbered.rows.size(), 1u);
  EXPECT_NEAR(row_areas(numbered)[0], 11.0, 1e-12);
  double without_row = 0.0;
  for (std::size_t s = 1; s < numbered.scene.surfaces.size(); ++s) {
    const Surface& surface = numbered.scene.surfaces[s];
    without_row += total_area(surface);
    const Material& black = numbered.scene.materials[static_cast<std::size_t>(surface.material)];
    EXPECT_TRUE((black.reflectance == 0.0f).all());
  }
  EXPECT_NEAR(without_row, 1.0 + 2.0, 1e-12);
  EXPECT_EQ(numbered.row_of_facet.back(), -1);
}

TEST(ReadVs3, SurfacesMayLieOnAnObstruction) {
  const NumberedScene numbered = read(wall + R"(
S 1  9 10 11 12  2 0 0.9 panel
O 2  1  2  3  4
)");
  EXPECT_NEAR(row_areas(numbered)[0], 1.0, 1e-12);
  EXPECT_NEAR(total_area(numbered.scene.surfaces[1]), 11.0, 1e-12);
}

TEST(ReadVs3, PlanesWithShapesAreTheSamePolygons) {
  // Azimuth 90 faces east (+x); tilt 0 faces up. u points to the right as seen from the front.
  const NumberedScene numbered = read(R"(F 3a
S 1 R 0 0 0.9 east
  1. 2. 3.   90. 90.   4. 5.
S 2 q 0 0 0.9 floor
  0. 0. 0.  180.  0.
  0. 0.  2. 0.  2. 3.  0. 3.
O 3 T
  0. 0. 1.  0. 45.  0. 0.  1. 0.  0. 1.
)");
  const auto corners = [&](std::size_t s) {
    return std::get<PolygonMesh>(numbered.scene.surfaces[s].shape).vertices;
  };
  const auto normal = [&](std::size_t s) {
    const auto& mesh = std::get<PolygonMesh>(numbered.scene.surfaces[s].shape);
    return facet_normal(mesh, mesh.facets[0]);
  };
  // Seen from the east, looking west at the east face, north (+y) is on the right.
  const std::vector<Eigen::Vector3d> east = {{1, 2, 8}, {1, 2, 3}, {1, 6, 3}, {1, 6, 8}};
  const std::vector<Eigen::Vector3d> floor = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((corners(0)[i] - east[i]).norm(), 1e-14);
    EXPECT_LT((corners(1)[i] - floor[i]).norm(), 1e-14);
  }
  EXPECT_TRUE(normal(0).isApprox(Eigen::Vector3d::UnitX(), 1e-12));
  EXPECT_TRUE(normal(1).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
  const double half = std::sqrt(0.5);  // north, half way up
  EXPECT_TRUE(normal(2).isApprox(Eigen::Vector3d(0, half, half), 1e-12));
  EXPECT_EQ(numbered.row_of_facet, (std::vector<int>{0, 1, -1}));
}

TEST(ReadVs3, ASurfaceWithoutAreaKeepsItsNumber) {
  const NumberedScene numbered = read(wall + R"(
S 1  1  2  2  1  0 0 0.9 nothing
S 2  1  2  3  4  0 0 0.9 floor
)");
  ASSERT_EQ(numbered.rows.size(), 2u);
  EXPECT_EQ(numbered.row_of_facet, (std::vector<int>{1}));
  ASSERT_FALSE(numbered.scene.notes.empty());
  EXPECT_TRUE(says(numbered.scene.notes[0], "Surface 1 'nothing'"));
}

TEST(ReadVs3, EmittancesAskedForInFactorsAreSpokenOf) {
  const NumberedScene numbered = read("C emit=1\n" + wall + "S 1 1 2 3 4 0 0 0.9 a\n");
  ASSERT_EQ(numbered.scene.notes.size(), 1u);
  EXPECT_TRUE(says(numbered.scene.notes[0], "emit=1"));
}

TEST(NumberedScene, FacesOfAnObjKeepTheirPlacesInTheFile) {
  const TemporaryFolder folder;
  const NumberedScene numbered = read_numbered_scene(folder.write("a.obj", R"(
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0.2
g first
f 1 2 3
g second
f 1 2 2
f 3 2 1
g first
f 1 2 3 4
)"));
  // The last polygon is not planar and becomes two triangles of one row; the second has no area.
  ASSERT_EQ(numbered.rows.size(), 4u);
  EXPECT_EQ(numbered.rows[0].name, "first");
  EXPECT_EQ(numbered.rows[1].name, "");
  EXPECT_EQ(numbered.rows[2].name, "second");
  EXPECT_EQ(numbered.row_of_facet, (std::vector<int>{0, 3, 3, 2}));
}

struct BadCase {
  const char* name;
  std::string text;
  std::vector<const char*> message;
};

void PrintTo(const BadCase& bad, std::ostream* out) {
  *out << bad.name;
}

class BadVs3 : public testing::TestWithParam<BadCase> {};

TEST_P(BadVs3, SaysWhatIsWrongAndWhere) {
  const TemporaryFolder folder;
  const auto file = folder.write("bad.vs3", GetParam().text);
  const std::string message = message_of<InputError>([&] { read_numbered_scene(file); });
  for (const char* part : GetParam().message) EXPECT_TRUE(says(message, part));
}

// The wall has lines 1 to 14, so the first surface is on line 15 ("\n" begins each text).
const std::vector<BadCase> bad_cases = {
    {"TwoDimensional", "F 2\n", {"bad.vs3:1:", "'2'", "3 and 3a"}},
    {"TwoDimensionalG", "G 2\n", {"bad.vs3:1:", "two-dimensional"}},
    {"NoFormat", "V 1 0 0 0\n", {"bad.vs3:1:", "F record"}},
    {"NoSurface", wall, {"without a surface"}},
    {"Empty", "", {"without a surface"}},
    {"UnknownRecord", wall + "Q 1\n", {"bad.vs3:15:", "'Q'"}},
    {"ShortVertex", "F 3\nV 1 0 0\n", {"bad.vs3:2:", "three coordinates"}},
    {"VertexNotANumber", "F 3\nV 1 0 x 0\n", {"bad.vs3:2:", "y coordinate is 'x'"}},
    {"VertexNan", "F 3\nV 1 0 nan 0\n", {"bad.vs3:2:", "'nan'"}},
    {"VertexOutOfSequence", "F 3\nV 2 0 0 0\n", {"bad.vs3:2:", "1 is next"}},
    {"ShortSurface", wall + "S 1 1 2 3 4\n", {"bad.vs3:15:", "too short"}},
    {"SurfaceOutOfSequence", wall + "S 2 1 2 3 4 0 0 0.9 a\n", {"bad.vs3:15:", "1 is next"}},
    {"VertexOutOfRange",
     wall + "S 1 1 2 3 40 0 0 0.9 a\n",
     {"bad.vs3:15:", "vertex 40", "1 to 12"}},
    {"VertexZero", wall + "S 1 0 2 3 4 0 0 0.9 a\n", {"bad.vs3:15:", "vertex 0"}},
    {"Emittance", wall + "S 1 1 2 3 4 0 0 1.5 a\n", {"bad.vs3:15:", "emittance is 1.5"}},
    {"Mask", wall + "S 1 1 2 3 4 0 0 .9 a\nM 2 9 10 11 12 1 0 .9 m\n", {"bad.vs3:16:", "mask"}},
    {"NullWithoutBase", wall + "N 1 1 2 3 4 0 0 .9 a\n", {"bad.vs3:15:", "base surface"}},
    {"BaseMissing", wall + "S 1 1 2 3 4 9 0 .9 a\n", {"bad.vs3:15:", "base surface 9"}},
    {"BaseLater",
     wall + "S 1 9 10 11 12 2 0 .9 a\nS 2 1 2 3 4 0 0 .9 b\n",
     {"bad.vs3:15:", "must come before"}},
    {"BaseOfBase",
     wall + "S 1 1 2 3 4 0 0 .9 a\nS 2 5 6 7 8 1 0 .9 b\nS 3 5 6 7 0 2 0 .9 c\n",
     {"bad.vs3:17:", "name surface 1"}},
    {"SubsurfaceFacesAway",
     wall + "S 1 1 2 3 4 0 0 .9 a\nS 2 8 7 6 5 1 0 .9 b\n",
     {"bad.vs3:16:", "faces away"}},
    {"SubsurfaceBeyondItsBase",
     wall + "S 1 5 6 7 8 0 0 .9 a\nS 2 1 2 3 4 1 0 .9 b\n",
     {"bad.vs3:16:", "reaches beyond"}},
    {"SubsurfacesOverlap",
     wall + "S 1 1 2 3 4 0 0 .9 a\nS 2 5 6 7 8 1 0 .9 b\nS 3 5 6 7 0 1 0 .9 c\n",
     {"bad.vs3:17:", "overlaps"}},
    {"SubsurfaceOffThePlane",
     wall + "V 13 3 2 1\nS 1 1 2 3 4 0 0 .9 a\nS 2 5 6 13 0 1 0 .9 b\n",
     {"bad.vs3:17:", "plane of its base"}},
    {"CombineLater",
     wall + "S 1 1 2 3 4 0 2 .9 a\nS 2 9 10 11 12 0 0 .9 b\n",
     {"bad.vs3:15:", "name one before it"}},
    {"CombineChained",
     wall + "S 1 1 2 3 4 0 0 .9 a\nS 2 5 6 7 8 0 1 .9 b\nS 3 9 10 11 12 0 2 .9 c\n",
     {"bad.vs3:17:", "name surface 1"}},
    {"ObstructionBeforeSurface",
     wall + "O 1 1 2 3 4\nS 2 5 6 7 8 0 0 .9 b\n",
     {"bad.vs3:16:", "after all other surfaces"}},
    {"ShapeUnknown", "F 3a\nS 1 X 0 0 .9 a\n", {"bad.vs3:2:", "'X'", "R (rectangle)"}},
    {"ShapeCutOff", "F 3a\nS 1 R 0 0 .9 a\n0 0 0 0\n", {"bad.vs3:3:", "ends before"}},
    {"NothingHasArea", wall + "S 1 1 2 2 1 0 0 .9 a\n", {"bad.vs3:15:", "no surface"}},
};
INSTANTIATE_TEST_SUITE_P(Files, BadVs3, testing::ValuesIn(bad_cases),
                         [](const auto& p) { return std::string(p.param.name); });

}  // namespace
}  // namespace lightwell::read_vs3_test
