// DIALux's exchange format STF.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "scene/errors.h"
#include "scene/io/lighting_design.h"
#include "scene/io/luminaires/luminaire_file.h"
#include "scene/io/stf/stf_openings.h"
#include "tests/scene/expected_messages.h"
#include "tests/scene/scene_file_test.h"

namespace lightwell::read_stf_test {
namespace {

const std::string heading =
    "[VERSION]\nSTFF=1.0.5\n[PROJECT]\nName=House\nNrRooms=1\nRoom1=ROOM.R1\n";
// 4 m along x, 3 m along y.
const std::string room =
    "[ROOM.R1]\nName=Office\nHeight=2.5\nWorkingPlane=0.8\nNrPoints=4\n"
    "Point1=0 0\nPoint2=4 0\nPoint3=4 3\nPoint4=0 3\nR_Ceiling=0.7\nR_Floor=0.2\n"
    "R_Wall1=0.5\nR_Wall2=0.5\nR_Wall3=0.5\nR_Wall4=0.5\n";
const std::string lamp = "Lum1=LUM.A\nLum1.Pos=1 1 2.5\nLum1.Rot=0 0 90\nNrLums=1\n";
const std::string lamp_type =
    "[LUM.A]\nName=Panel\nOrderNr=B-17\nBox=1.2 0.6 0.1\nFlux=3000\nLoad=25\n";
// A window of 2 m by 1 m in the wall at y = 3, a door of 0.9 m by 2.1 m in that at x = 4.
const std::string openings =
    "NrFurns=2\nFurn1=win\nFurn1.Pos=2 2.9 1\nFurn1.Size=2 1 0\nFurn2=door\nFurn2.Pos=4 1 0\n"
    "Furn2.Size=0.9 2.1 0\n";

class ReadStf : public test::SceneFileTest {
 protected:
  Scene read(const std::string& text) const { return read_file("house.stf", text); }
  std::string refused(const std::string& text) const {
    return message_of<InputError>([&] { read(text); });
  }
  void write_photometry(const std::string& name) const {
    folder.write(name, content_of(LIGHTWELL_DOCS "/luminaires/bracket.ies"));
  }
};

std::string notes_of(const Scene& scene) {
  std::string all;
  for (const std::string& note : scene.notes) all += note + "\n";
  return all;
}

std::string losses_of(const Scene& scene) {
  std::string all;
  for (const std::string& loss : scene.losses) all += loss + "\n";
  return all;
}

std::map<std::string, double> areas(const Scene& scene) {
  std::map<std::string, double> result;
  for (const Surface& surface : scene.surfaces) result[surface.name] = surface_area(surface);
  return result;
}

// Areas and volumes are sums of a few products of numbers below 100, in double.
constexpr double rounding = 1e-11;

// Vector area of all facets and, by Gauss, the volume that they enclose with their fronts outside.
struct Enclosed {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  double volume = 0.0;
};

Enclosed enclosed_by(const Scene& scene, const std::string& prefix) {
  Enclosed result;
  for (const Surface& surface : scene.surfaces) {
    if (!surface.name.starts_with(prefix)) continue;
    const auto& mesh = std::get<PolygonMesh>(surface.shape);
    for (const Facet& facet : mesh.facets) {
      const Eigen::Vector3d a = facet_area(mesh, facet) * facet_normal(mesh, facet);
      const auto& corner = mesh.vertices[static_cast<std::size_t>(facet.boundary[0])];
      result.area += a;
      result.volume += corner.dot(a) / 3.0;
    }
  }
  return result;
}

TEST_F(ReadStf, TheSameRoomInTomlIsTheSameScene) {
  write_photometry("B-17.ies");
  const std::string window = "NrFurns=1\nFurn1=win\nFurn1.Pos=2 3 1\nFurn1.Size=2 1 0\n";
  const Scene stf = read(heading + room + lamp + window + lamp_type);
  const Scene toml = read_file("house.toml", R"(
[materials.a-floor]
reflectance = 0.2
sides = "one"
[materials.b-ceiling]
reflectance = 0.7
sides = "one"
[materials.c-wall]
reflectance = 0.5
sides = "one"
[materials.d-glass]
glass = { ior = 1.52, thin = true }
[[surfaces]]
material = "a-floor"
polygon = [[0,0,0],[4,0,0],[4,3,0],[0,3,0]]
[[surfaces]]
material = "b-ceiling"
polygon = [[0,3,2.5],[4,3,2.5],[4,0,2.5],[0,0,2.5]]
[[surfaces]]
material = "c-wall"
polygon = [[4,0,0],[0,0,0],[0,0,2.5],[4,0,2.5]]
[[surfaces]]
material = "c-wall"
polygon = [[4,3,0],[4,0,0],[4,0,2.5],[4,3,2.5]]
[[surfaces]]
material = "c-wall"
polygon = [[0,3,0],[4,3,0],[4,3,2.5],[0,3,2.5]]
holes = [[[1,3,1],[3,3,1],[3,3,2],[1,3,2]]]
[[surfaces]]
material = "d-glass"
polygon = [[1,3,1],[3,3,1],[3,3,2],[1,3,2]]
[[surfaces]]
material = "c-wall"
polygon = [[0,0,0],[0,3,0],[0,3,2.5],[0,0,2.5]]
[[lamps]]
file = "B-17.ies"
position = [1, 1, 2.5]
aim = [0, 0, -1]
c0 = [0, 1, 0]
)");
  // scene_hash() is over all that decides the light, so both have the same lux to the last bit. The
  // axes of the lamp alone differ by the rounding of a rotation by 90 degrees.
  Scene turned = stf;
  ASSERT_EQ(stf.lamps.size(), 1u);
  EXPECT_LT((stf.lamps[0].axes - toml.lamps.at(0).axes).norm(), 1e-15);
  turned.lamps[0].axes = toml.lamps[0].axes;
  EXPECT_EQ(scene_hash(turned), scene_hash(toml));
}

TEST_F(ReadStf, RoomsAreClosedAndTheirFrontsFaceInward) {
  // An L of 6 m x 4 m without its corner of 3 m x 2 m, in both directions around.
  const std::vector<std::string> corners = {"0 0", "6 0", "6 2", "3 2", "3 4", "0 4"};
  for (const bool is_turned : {false, true}) {
    std::string text = heading + "[ROOM.R1]\nHeight=3\nNrPoints=6\n";
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::size_t at = is_turned ? corners.size() - 1 - i : i;
      text += fmt::format("Point{}={}\n", i + 1, corners[at]);
    }
    const Scene scene = read(text +
                             "NrFurns=3\nFurn1=door\nFurn1.Pos=2 0 0\nFurn1.Size=0.9 2 0\n"
                             "Furn2=win\nFurn2.Pos=0 2 1\nFurn2.Size=1 1 0\n"
                             "Furn3=skylight\nFurn3.Pos=1 1 0\nFurn3.Size=1 0.5 0\n");
    const Enclosed room_of = enclosed_by(scene, "");
    EXPECT_LT(room_of.area.norm(), rounding);
    EXPECT_NEAR(room_of.volume, -(6.0 * 4.0 - 3.0 * 2.0) * 3.0, rounding);
    const auto area = areas(scene);
    EXPECT_NEAR(area.at("ROOM.R1 door"), 1.8, rounding);
    EXPECT_NEAR(area.at("ROOM.R1 skylight"), 0.5, rounding);
    EXPECT_NEAR(area.at("ROOM.R1 ceiling"), 18.0 - 0.5, rounding);
  }
}

TEST_F(ReadStf, WallsHaveTheirOwnReflectanceInBothDirectionsAround) {
  for (const bool is_turned : {false, true}) {
    const Scene scene = read(heading + "[ROOM.R1]\nHeight=2\nNrPoints=3\n" +
                             (is_turned ? "Point1=0 0\nPoint2=0 1\nPoint3=1 0\nR_Wall3=0.9\n"
                                        : "Point1=0 0\nPoint2=1 0\nPoint3=0 1\nR_Wall1=0.9\n"));
    for (const Surface& surface : scene.surfaces) {
      const auto& mesh = std::get<PolygonMesh>(surface.shape);
      const bool is_first = facet_normal(mesh, mesh.facets.at(0)).y() > 0.99;
      const float rho = scene.materials[static_cast<std::size_t>(surface.material)].reflectance[0];
      EXPECT_EQ(rho == 0.9f, is_first) << surface.name;
    }
  }
}

TEST_F(ReadStf, OpeningsLieInTheNearestWallAndAreCutOutOfIt) {
  const Scene scene = read(heading + room + openings);
  const auto area = areas(scene);
  EXPECT_NEAR(area.at("Office window"), 2.0, rounding);
  EXPECT_NEAR(area.at("Office wall 3"), 4.0 * 2.5 - 2.0, rounding);
  EXPECT_NEAR(area.at("Office door"), 0.9 * 2.1, rounding);
  EXPECT_NEAR(area.at("Office wall 2"), 3.0 * 2.5 - 0.9 * 2.1, rounding);
  EXPECT_TRUE(says(notes_of(scene), "clear panes of glass"));
  EXPECT_EQ(losses_of(scene), "");
  const Scene beyond = read(heading + room +
                            "NrFurns=3\nFurn1=win\nFurn1.Pos=0.5 0 1\nFurn1.Size=2 2 0\n"
                            "Furn2=door\nFurn2.Pos=1 0 0\nFurn2.Size=0.9 2 0\n"
                            "Furn3=win\nFurn3.Pos=2 3 4\nFurn3.Size=1 1 0\n");
  // 1 m of the window's width of 2 m lies beyond the corner, and 0.5 m of its height above.
  EXPECT_NEAR(areas(beyond).at("Office window"), 1.5 * 1.5, rounding);
  EXPECT_TRUE(says(losses_of(beyond),
                   "reach beyond their wall were cut off at its edge: '[ROOM.R1] Furn1'"));
  EXPECT_TRUE(says(losses_of(beyond), "overlap an earlier one were left out: '[ROOM.R1] Furn2'"));
  EXPECT_TRUE(says(losses_of(beyond), "beside their wall were left out: '[ROOM.R1] Furn3'"));
}

TEST_F(ReadStf, FurnitureIsABoxAboutItsPositionOrOnIt) {
  const Scene scene = read(heading + room +
                           "NrFurns=2\nFurn1=column\nFurn1.Pos=2 1 1.25\nFurn1.Rot=0 0 30\n"
                           "Furn1.Size=0.6 0.4 2.5\nFurn1.Ref=ROOM.R1.F1\n"
                           "Furn2=desk\nFurn2.Pos=1 1 0\nFurn2.Size=1.6 0.8 0.72\n"
                           "[ROOM.R1.F1]\nPoly.Color=52 215 164 63\n");
  const Enclosed column = enclosed_by(scene, "Office column");
  EXPECT_LT(column.area.norm(), rounding);
  EXPECT_NEAR(column.volume, 0.6 * 0.4 * 2.5, rounding);
  const Enclosed desk = enclosed_by(scene, "Office desk");
  EXPECT_NEAR(desk.volume, 1.6 * 0.8 * 0.72, rounding);
  for (const Surface& surface : scene.surfaces) {
    const auto& mesh = std::get<PolygonMesh>(surface.shape);
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& v : mesh.vertices) box.extend(v);
    const float rho = scene.materials[static_cast<std::size_t>(surface.material)].reflectance[0];
    if (surface.name == "Office column") {
      EXPECT_FLOAT_EQ(rho, 0.52f);
      // The width of a rectangle turned by 30 degrees.
      EXPECT_NEAR(box.sizes().x(), 0.6 * std::sqrt(0.75) + 0.4 * 0.5, rounding);
      EXPECT_NEAR(box.center().z(), 1.25, rounding);
    }
    if (surface.name == "Office desk") {
      EXPECT_FLOAT_EQ(rho, 0.5f);
      EXPECT_NEAR(box.min().z(), 0.0, rounding);
    }
  }
  EXPECT_TRUE(says(notes_of(scene), "stands on its position: '[ROOM.R1] Furn2'"));
}

TEST_F(ReadStf, LuminairesWithoutAFileAreEvenOpeningsOfTheirFlux) {
  const Scene scene = read(heading + room + lamp + lamp_type);
  ASSERT_EQ(scene.lamps.size(), 1u);
  const Lamp& panel = scene.lamps[0];
  EXPECT_EQ(panel.name, "Panel");
  EXPECT_TRUE(panel.position.isApprox(Eigen::Vector3d(1, 1, 2.5)));
  EXPECT_EQ(panel.opening.along_c0, 1.2);
  EXPECT_EQ(panel.opening.along_c90, 0.6);
  EXPECT_TRUE(panel.axes.col(0).isApprox(Eigen::Vector3d::UnitY()));
  // Intensities are floats, of 24 bits, and so is each of the three products of luminous().
  EXPECT_NEAR(luminous(scene.bands, lamp_flux(panel)), 3000.0, 3000.0 * 4 * 0x1p-24);
  const auto candela = [&](double angle) {
    const Eigen::Vector3d way(0.0, std::sin(angle), -std::cos(angle));
    return luminous(scene.bands, panel.intensity) * relative_intensity(panel, way);
  };
  // Half a degree between the values of the table leaves h^2 / 8 = 1e-5 of a cosine.
  const double axis = 3000.0 / std::numbers::pi;
  EXPECT_NEAR(candela(0.0), axis, 2e-5 * axis);
  EXPECT_NEAR(candela(std::numbers::pi / 3.0), 0.5 * axis, 2e-5 * axis);
  EXPECT_EQ(candela(0.6 * std::numbers::pi), 0.0);
  EXPECT_TRUE(says(losses_of(scene), "became even openings"));
}

TEST_F(ReadStf, PhotometricFilesAreFoundByOrderNumberNameAndSection) {
  const LuminaireFile bracket = read_luminaire(LIGHTWELL_DOCS "/luminaires/bracket.ies");
  for (const char* name : {"B-17.ies", "Panel.IES", "LUM.A.ies"}) {
    const TemporaryFolder own;
    own.write(name, content_of(bracket.file));
    const Scene scene = read_scene(own.write("house.stf", heading + room + lamp + lamp_type));
    ASSERT_EQ(scene.lamps.size(), 1u) << name;
    // Sums of a table in double, times an intensity in float.
    EXPECT_NEAR(luminous(scene.bands, lamp_flux(scene.lamps[0])), bracket.flux(),
                bracket.flux() * 4 * 0x1p-24)
        << name;
    EXPECT_EQ(losses_of(scene), "") << name;
    EXPECT_TRUE(says(notes_of(scene), "have that of the file: 'LUM.A'")) << name;
  }
  // A name with folders is none of a file beside the scene.
  const Scene scene = read(heading + room + lamp + "[LUM.A]\nOrderNr=../B-17\nFlux=100\n");
  EXPECT_TRUE(says(losses_of(scene), "became even openings"));
}

TEST_F(ReadStf, RoomsStandAsPlacedAndThoseOverOthersOnThem) {
  const std::string rooms = "[PROJECT]\nNrRooms=3\nRoom1=ROOM.R1\nRoom2=ROOM.R2\nRoom3=ROOM.R3\n" +
                            room +
                            "[ROOM.R2]\nName=Office\nHeight=3\nNrPoints=4\nPoint1=4 0\nPoint2=6 0\n"
                            "Point3=6 3\nPoint4=4 3\n"
                            "[ROOM.R3]\nName=Above\nHeight=2\nNrPoints=4\nPoint1=0 2\nPoint2=5 2\n"
                            "Point3=5 5\nPoint4=0 5\nWorkingPlane=0.75\n";
  const Scene scene = read(rooms);
  const auto area = areas(scene);
  EXPECT_NEAR(area.at("Office floor"), 12.0, rounding);
  EXPECT_NEAR(area.at("Office 2 floor"), 6.0, rounding);
  for (const Surface& surface : scene.surfaces) {
    const double z = std::get<PolygonMesh>(surface.shape).vertices[0].z();
    // The second room shares a wall alone; the third stands on the higher of both.
    const double level = surface.name.starts_with("Above") ? 3.0 : 0.0;
    if (surface.name.ends_with("floor")) {
      EXPECT_EQ(z, level) << surface.name;
    }
  }
  EXPECT_TRUE(says(notes_of(scene), "were set onto it: 'Above'"));
}

TEST_F(ReadStf, WorkingPlanesAreGridsOfReports) {
  const Scene scene = read(
      "[project]\nNAME=House\nOperator=A. Planner\nDate=2026-03-01\n"
      "NrRooms=1\nRoom1=room.r1\n" +
      room + "MF=0.8\n" + lamp + lamp_type);
  EXPECT_EQ(scene.title, "House");
  const LightingDesign design = read_lighting_design(scene);
  ASSERT_EQ(design.grids.size(), 1u);
  EXPECT_EQ(design.grids[0].name, "Office");
  EXPECT_EQ(scene.surfaces.at(static_cast<std::size_t>(design.grids[0].surface)).name,
            "Office floor");
  EXPECT_EQ(design.grids[0].height, 0.8);
  EXPECT_EQ(maintenance_factor({}, design), 0.8);
  EXPECT_EQ(design.watts, std::vector<double>{25.0});
  EXPECT_EQ(design.heading.author, "A. Planner");
  EXPECT_EQ(design.heading.date, "2026-03-01");
}

TEST_F(ReadStf, FaultsOfRoomsAreSentencesWithTheirLine) {
  const auto with = [&](const std::string& key, const std::string& line) {
    std::string text = heading + room;
    const std::size_t at = text.find("\n" + key + "=") + 1;
    text.replace(at, text.find('\n', at) - at, line);
    return refused(text);
  };
  EXPECT_TRUE(says(with("Height", ""), "house.stf:7: [ROOM.R1] lacks the key 'Height'"));
  EXPECT_TRUE(says(with("Height", "Height=-1"),
                   "house.stf:9: Height of [ROOM.R1] is -1; it must be above 0"));
  EXPECT_TRUE(says(with("Height", "Height=2500"), "lengths of STF are in metres"));
  EXPECT_TRUE(says(with("Height", "Height=8 ft"),
                   "has '8 ft', which is not a finite number; write numbers alone"));
  EXPECT_TRUE(says(with("Height", "Height=nan"), "not a finite number"));
  EXPECT_TRUE(says(with("Point2", "Point2=400000 0"), "lengths of STF are in metres"));
  EXPECT_TRUE(says(with("Point2", "Point2=4"), "Point2 of [ROOM.R1] has 1 numbers; 2 are needed"));
  EXPECT_TRUE(says(with("Point2", "Point2=0 3\n"), "outline"));
  EXPECT_TRUE(says(with("NrPoints", ""), "lacks the key 'NrPoints'"));
  EXPECT_TRUE(says(with("NrPoints", "NrPoints=2"), "fewer than three corners"));
  EXPECT_TRUE(says(with("NrPoints", "NrPoints=2.5"), "a whole number is needed"));
  EXPECT_TRUE(says(with("R_Ceiling", "R_Ceiling=70"), "write a share between 0 and 1"));
  // Corners 2 and 3 exchanged: edges 1-2 and 3-4 cross.
  EXPECT_TRUE(says(refused(heading + "[ROOM.R1]\nHeight=2\nNrPoints=4\nPoint1=0 0\nPoint2=4 3\n"
                                     "Point3=4 0\nPoint4=0 3\n"),
                   "its outline has edges 1 and 3 that cross"));
}

TEST_F(ReadStf, FilesThatAreNoneAreRefused) {
  EXPECT_TRUE(says(refused(""), "house.stf:1: there is no section [PROJECT]"));
  EXPECT_TRUE(says(refused("[PROJECT]\nName=x\n"), "[PROJECT] lacks the key 'NrRooms'"));
  EXPECT_TRUE(says(refused("[PROJECT]\nNrRooms=0\n"), "no room that can be read"));
  EXPECT_TRUE(says(refused(heading), "Rooms without a section were left out: 'ROOM.R1'"));
  EXPECT_TRUE(says(refused(std::string("\xff\xfe[\0P\0", 6)), "save it as UTF-8, not as UTF-16"));
}

TEST_F(ReadStf, CountsThatLieTakeNoMemory) {
  // Memory for a billion corners, rooms or luminaires would not be there.
  std::string text = heading + room;
  text.replace(text.find("NrPoints=4"), 10, "NrPoints=1000000000");
  EXPECT_TRUE(
      says(refused(text), "NrPoints of [ROOM.R1] is 1000000000, but there is no Point5; write 4"));
  const Scene scene = read("[PROJECT]\nNrRooms=1000000000\nRoom1=ROOM.R1\n" + room +
                           "NrLums=1000000000\nNrFurns=1e9\nNrStruct=-3\n");
  EXPECT_TRUE(says(losses_of(scene), "[PROJECT] NrRooms=1000000000, of which 1 is described"));
  EXPECT_TRUE(says(losses_of(scene), "[ROOM.R1] NrLums=1000000000, of which 0 are described"));
  EXPECT_TRUE(says(losses_of(scene), "Counts that cannot be used were taken as 0: '[ROOM.R1]'"));
}

TEST_F(ReadStf, RoomsOfTooManyOpeningsAreRefusedInAll) {
  std::string text = heading + room + fmt::format("NrFurns={}\n", StfOpenings::most + 1);
  for (std::size_t i = 1; i <= StfOpenings::most + 1; ++i) text += fmt::format("Furn{}=win\n", i);
  const TemporaryFolder own;
  const auto path = own.write("house.stf", text);
  EXPECT_THROW(read_scene(path), LimitError);
}

TEST_F(ReadStf, PartsThatAreNotUnderstoodAreNamedOnce) {
  const Scene scene = read(heading + room +
                           "Height=3\nPoint5=9 9\nNrStruct=1\nStruct1=beam\nno key\n"
                           "NrLums=2\nLum1=LUM.B\nLum1.Pos=1 1 2\nLum2=LUM.A\nLum2.Pos=1 1\n"
                           "[LUM.A]\nFlux=many\nKelvin=4000\n[STOREY.S1]\nElevation=3\n");
  const std::string losses = losses_of(scene);
  EXPECT_TRUE(says(losses, "Keys that repeat an earlier one were left out: '[ROOM.R1] Height'"));
  EXPECT_TRUE(says(losses,
                   "Keys that are not understood were left out: '[ROOM.R1] Point5', '[ROOM.R1] "
                   "Struct1', '[LUM.A] Kelvin'"));
  EXPECT_TRUE(says(losses, "Structures, such as beams and columns (NrStruct), were left out"));
  EXPECT_TRUE(says(losses, "neither a section nor a key in one were left out: 'line 26'"));
  EXPECT_TRUE(says(losses, "without flux and without a photometric file were left out: 'LUM.B'"));
  EXPECT_TRUE(says(losses, "Flux of [LUM.A] has 'many'"));
  EXPECT_TRUE(says(losses, "Lum2.Pos of [ROOM.R1] has 2 numbers; 3 are needed"));
  EXPECT_TRUE(says(notes_of(scene), "no room refers to were passed over: 'STOREY.S1'"));
  EXPECT_TRUE(scene.lamps.empty());
}

TEST_F(ReadStf, TextOfOtherCodesAndDecimalCommasAreRead) {
  std::string text = heading + room;
  text.replace(text.find("Name=Office"), 11, "Name=B\xfcro");
  text.replace(text.find("Height=2.5"), 10, "Height=2,5");
  const Scene scene = read(text);
  EXPECT_NEAR(areas(scene).at("B\xc3\xbcro wall 1"), 10.0, rounding);
  EXPECT_TRUE(says(notes_of(scene), "not UTF-8 was read as Latin-1: 'line 8'"));
  EXPECT_TRUE(says(notes_of(scene), "Commas in numbers were read as decimal points"));
  EXPECT_EQ(losses_of(scene), "");
}

}  // namespace
}  // namespace lightwell::read_stf_test
