#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::read_obj_test {
namespace {

const Scene& room() {
  static const Scene scene = read_scene(LIGHTWELL_TEST_DATA "/scene/room.obj");
  return scene;
}

const Material& material(const Scene& scene, const std::string& name) {
  for (const Material& m : scene.materials) {
    if (m.name == name) return m;
  }
  throw std::runtime_error("no material " + name);
}

const PolygonMesh& mesh(const Scene& scene, const std::string& name) {
  for (const Surface& s : scene.surfaces) {
    if (s.name == name) return std::get<PolygonMesh>(s.shape);
  }
  throw std::runtime_error("no surface " + name);
}

bool is_noted(const Scene& scene, const std::string& what) {
  return std::any_of(scene.notes.begin(), scene.notes.end(),
                     [&](const std::string& note) { return note.find(what) != std::string::npos; });
}

void expect_rgb(const Spectrum& actual, float r, float g, float b) {
  ASSERT_EQ(actual.size(), 3);
  EXPECT_FLOAT_EQ(actual[0], r);
  EXPECT_FLOAT_EQ(actual[1], g);
  EXPECT_FLOAT_EQ(actual[2], b);
}

// Reads an OBJ file (and an MTL file) with these lines from one folder.
Scene read_text(const std::string& obj, const std::string& mtl = "") {
  const TemporaryFolder folder;
  if (!mtl.empty()) folder.write("text.mtl", mtl);
  return read_scene(folder.write("text.obj", "mtllib text.mtl\n" + obj));
}

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";

TEST(ReadObj, MakesASurfaceOfEachGroupAndMaterial) {
  std::vector<std::string> names;
  for (const Surface& s : room().surfaces) names.push_back(s.name);
  EXPECT_EQ(names, (std::vector<std::string>{"box (wall)", "box (mirror)", "box (shiny)",
                                             "fittings/left (pane)", "fittings/left (haze)",
                                             "fittings/right (lamp)", "fittings/right (forgotten)",
                                             "fittings/repaired"}));
}

TEST(ReadObj, KeepsPolygonsAsTheyAre) {
  const PolygonMesh& floor_and_ceiling = mesh(room(), "box (wall)");
  ASSERT_EQ(floor_and_ceiling.facets.size(), 2u);
  EXPECT_EQ(floor_and_ceiling.facets[0].boundary.size(), 4u);
  EXPECT_DOUBLE_EQ(facet_area(floor_and_ceiling, floor_and_ceiling.facets[0]), 12.0);
  // Backwards indices in reverse order: the ceiling faces down.
  EXPECT_EQ(facet_normal(floor_and_ceiling, floor_and_ceiling.facets[1]),
            -Eigen::Vector3d::UnitZ());
  const PolygonMesh& concave = mesh(room(), "fittings/right (forgotten)");
  ASSERT_EQ(concave.facets.size(), 1u);
  EXPECT_EQ(concave.facets[0].boundary.size(), 5u);
  EXPECT_DOUBLE_EQ(facet_area(concave, concave.facets[0]), 0.75);
}

TEST(ReadObj, JoinsContinuedLines) {
  EXPECT_DOUBLE_EQ(facet_area(mesh(room(), "box (mirror)"), mesh(room(), "box (mirror)").facets[0]),
                   10.0);
}

TEST(ReadObj, NamesTheLineWhereAContinuedOneBegins) {
  const auto line_of = [](const std::string& obj) -> std::string {
    try {
      read_text(obj);
    } catch (const InputError& refused) {
      const std::string message = refused.what(), file = "text.obj:";
      const std::size_t begin = message.find(file) + file.size();
      return message.substr(begin, message.find(':', begin) - begin);
    }
    return "nothing was refused";
  };
  // An mtllib line precedes these lines.
  EXPECT_EQ(line_of("v 0 0 0\nv 1 0\\\nx\nv 0 1 0\n"), "3");
  EXPECT_EQ(line_of("v 0 0 0\nv 1 0 0\nv 1 0\\\n x \\\n"), "4") << "where the file ends";
}

TEST(ReadObj, RepairsWhatItCanAndCountsIt) {
  EXPECT_EQ(mesh(room(), "fittings/repaired").facets.size(), 2u + 2u);
  EXPECT_TRUE(is_noted(room(), "1 polygon was not planar and was split"));
  EXPECT_TRUE(is_noted(room(), "1 polygon without area was dropped"));
  EXPECT_TRUE(is_noted(room(), "1 polygon that crosses itself was cut"));
}

// Programs write vertices that they could not compute in several ways.
TEST(ReadObj, AVertexWithoutNumbersCostsItsPolygonsAlone) {
  for (const std::string word : {"nan", "-inf", "-nan(ind)", "1.#QNAN", "1e999"}) {
    const std::string vertex = "v 1 " + word + " 0\n";
    const Scene scene =
        read_text(vertex + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\nf 1 3 4\nf 4 2 1\n");
    EXPECT_EQ(std::get<PolygonMesh>(scene.surfaces.at(0).shape).facets.size(), 1u) << word;
    EXPECT_EQ(scene.dropped_polygons, 2);
    EXPECT_TRUE(is_noted(scene,
                         "2 polygons with vertices that have no finite coordinates were "
                         "dropped; the first such vertex: "));
    EXPECT_TRUE(is_noted(scene, "text.obj:2: coordinate '" + word + "'"));
    EXPECT_EQ(scene.losses.size(), scene.notes.size() - 1) << "grey polygons are no loss";
    EXPECT_EQ(read_text(vertex + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n").dropped_polygons, 0);
  }
}

TEST(ReadObj, LinesMayEndAsOnAnySystem) {
  for (const char* end : {"\r\n", "\r"}) {
    std::string text = triangle;
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2)) {
      text.replace(at, 1, end);
    }
    const TemporaryFolder folder;
    EXPECT_EQ(read_scene(folder.write("text.obj", text)).surfaces.size(), 1u);
  }
  const TemporaryFolder folder;
  try {
    read_scene(folder.write("wide.obj", std::string("\xff\xfev\0 \0", 6)));
    FAIL() << "UTF-16 was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("UTF-16"), std::string::npos) << error.what();
  }
}

TEST(ReadObj, KsIsAMirrorOnlyWhereIllumSaysSo) {
  expect_rgb(material(room(), "wall").reflectance, 0.6f, 0.5f, 0.4f);
  EXPECT_FALSE(material(room(), "wall").is_specular());
  EXPECT_TRUE(is_noted(room(), "highlight"));
  expect_rgb(material(room(), "mirror").specular, 0.8f, 0.8f, 0.8f);
  const Scene black = read_text(triangle, "newmtl m\nKd 0 0 0\nKs 0.9 0.8 0.7\n");
  expect_rgb(black.materials[0].specular, 0.9f, 0.8f, 0.7f);
}

TEST(ReadObj, MoreThanAllLightIsScaledDown) {
  const Material& shiny = material(room(), "shiny");
  expect_rgb(shiny.reflectance, 0.5f, 0.5f, 0.6f);
  expect_rgb(shiny.specular, 0.5f, 0.5f, 0.2f);
  EXPECT_TRUE(is_noted(room(), "exceeded 1"));
}

TEST(ReadObj, ClearMaterialsAreDielectrics) {
  const Material& pane = material(room(), "pane");
  ASSERT_TRUE(pane.dielectric);
  EXPECT_FLOAT_EQ(pane.dielectric->index_of_refraction, 1.45f);
  expect_rgb(pane.dielectric->tint, 0.9f, 1.0f, 0.8f);
  EXPECT_FALSE((pane.reflectance > 0.0f).any());
  const Scene nothing = read_text(triangle, "newmtl m\nKd 1 1 1\nd 0\n");
  ASSERT_TRUE(nothing.materials[0].dielectric);
  EXPECT_FLOAT_EQ(nothing.materials[0].dielectric->index_of_refraction, 1.5f) << "none given";
  EXPECT_TRUE(is_noted(nothing, "read as clear glass in: 'm'"));
  const Scene opaque = read_text(triangle, "newmtl m\nKd 1 1 1\nTr 0\nTf 1 1 1\nNi 1.5\n");
  EXPECT_FALSE(opaque.materials[0].dielectric);
}

// d is the share of the surface that is there. Models 4, 6, 7 and 9 and a colour of Tf mean glass.
TEST(ReadObj, DissolvedSurfacesLetTheRestThrough) {
  const Material& haze = material(room(), "haze");
  EXPECT_FALSE(haze.dielectric);
  expect_rgb(haze.reflectance, 0.15f, 0.15f, 0.15f);
  expect_rgb(haze.regular_transmittance, 0.7f, 0.7f, 0.7f);
  const auto first = [](const std::string& mtl) {
    return read_text(triangle, "newmtl m\nKd 0.5\n" + mtl).materials[0];
  };
  const Material net = first("Tr 0.25\nillum 3\nKs 0.4\n");
  expect_rgb(net.reflectance, 0.375f, 0.375f, 0.375f);
  expect_rgb(net.specular, 0.3f, 0.3f, 0.3f);
  expect_rgb(net.regular_transmittance, 0.25f, 0.25f, 0.25f);
  EXPECT_TRUE(first("d 0.3\nillum 9\n").dielectric);
  EXPECT_TRUE(first("d 0.3\nTf 0.5 1 1\n").dielectric);
  EXPECT_FALSE(first("d 0.3\nTf 1 1 1\n").dielectric);
  const Material lamp = first("d 0.3\nKe 1 1 1\n");
  EXPECT_TRUE(lamp.is_emitter() && !lamp.passes_straight());
}

// Two texels of alpha 0.2 and 0.6: neither clear nor opaque.
TEST(ReadObj, APictureOfGauzeCountsByItsMeanOpacity) {
  const TemporaryFolder folder;
  std::filesystem::copy(LIGHTWELL_TEST_DATA "/scene/gauze.png", folder / "gauze.png");
  folder.write("text.mtl", "newmtl m\nKd 0.5\nmap_d gauze.png\n");
  const Scene scene = read_scene(folder.write("text.obj", "mtllib text.mtl\n" + triangle));
  EXPECT_FALSE(scene.materials[0].mask);
  // Texels have 16 bits, of the square root: steps of 2e-5 here.
  EXPECT_NEAR(scene.materials[0].regular_transmittance[0], 0.6f, 2e-5f);
}

// Programs write pictures of normals to map_Bump; a grey picture has heights.
TEST(ReadObj, BumpsAndNormalMapsAreRelief) {
  const TemporaryFolder folder;
  for (const char* name : {"normals.png", "heights.png"}) {
    std::filesystem::copy(std::filesystem::path(LIGHTWELL_TEST_DATA "/scene") / name,
                          folder / name);
  }
  const std::string mapped = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";
  const auto read = [&](const std::string& map) {
    folder.write("text.mtl", "newmtl m\nKd 0.5\n" + map + "\n");
    return read_scene(
        folder.write("text.obj", "mtllib text.mtl\nusemtl m\n" + mapped + "f 1/1 2/2 3/3\n"));
  };
  for (const std::string key : {"norm", "map_Bump", "bump"}) {
    const Scene scene = read(key + " -bm 0.5 normals.png");
    EXPECT_EQ(scene.materials[0].relief.value().scale, 0.5) << key;
    EXPECT_NEAR(scene.materials[0].relief->steepest, 76.0 / 102.0, 1e-4) << key;
    EXPECT_GE(std::get<PolygonMesh>(scene.surfaces[0].shape).facets[0].uv_map, 0);
  }
  const Scene heights = read("map_bump -bm 3 heights.png");
  EXPECT_EQ(heights.materials[0].relief.value().scale, 3.0);
  EXPECT_FALSE(heights.materials[0].relief->is_in_metres);
  EXPECT_NEAR(heights.materials[0].relief->steepest, 0.5, 1e-4);  // per texel
  for (const std::string map : {"norm heights.png", "bump gone.png", "bump -bm 1e9 heights.png"}) {
    const Scene scene = read(map);
    EXPECT_FALSE(scene.materials[0].relief) << map;
    EXPECT_EQ(scene.losses.size(), 1u) << map;
  }
}

TEST(ReadObj, KeIsRadiance) {
  const float pi = std::numbers::pi_v<float>;
  expect_rgb(material(room(), "lamp").emission, 5 * pi, 4 * pi, 3 * pi);
}

TEST(ReadObj, APictureThatIsMissingIsNoted) {
  EXPECT_TRUE(is_noted(room(), "room.mtl: pictures that are missing were left out: '"));
  EXPECT_TRUE(is_noted(room(), "lamp.png'"));
}

TEST(ReadObj, MissingPicturesLeaveThePlainColourOrGrey) {
  const Scene plain = read_text(triangle, "newmtl m\nKd 0.1 0.2 0.3\nmap_Kd gone.png\n");
  expect_rgb(plain.materials[0].reflectance, 0.1f, 0.2f, 0.3f);
  const Scene bare = read_text(triangle, "newmtl m\nmap_Kd gone.png\n");
  expect_rgb(bare.materials[0].reflectance, 0.5f, 0.5f, 0.5f);
  ASSERT_EQ(bare.losses.size(), 1u);
  EXPECT_NE(bare.losses[0].find("gone.png"), std::string::npos);
}

// Windows tells no letters from capitals, and programs write paths of the machine they run on.
TEST(ReadObj, FilesAreFoundByNamesOfOtherSystems) {
  for (const std::string name :
       {"My Room.MTL", "\"my room.mtl\"", "C:\\models\\my room.mtl", "/home/joe/my room.mtl"}) {
    const TemporaryFolder folder;
    folder.write("my room.mtl", "newmtl m\nKd 0.3 0.3 0.3\nmap_Ks .\n");
    const Scene scene = read_scene(folder.write("text.obj", "mtllib " + name + "\n" + triangle));
    expect_rgb(scene.materials[0].reflectance, 0.3f, 0.3f, 0.3f);
  }
  for (const std::string name : {"Two-Pixels.PNG", "\"two-pixels.png\"", "D:\\maps\\two-pixels.png",
                                 "/home/joe/maps/two-pixels.png", "maps\\two-pixels.png"}) {
    const TemporaryFolder folder;
    std::filesystem::copy(LIGHTWELL_TEST_DATA "/scene/two-pixels.png", folder / "two-pixels.png");
    folder.write("text.mtl", "newmtl m\nmap_Kd " + name + "\n");
    const Scene scene = read_scene(folder.write("text.obj", "mtllib text.mtl\n" + triangle));
    EXPECT_TRUE(scene.materials[0].texture) << name;
  }
}

TEST(ReadObj, AMaterialThatCannotBeReadIsGrey) {
  for (const std::string line : {"Kd nan 0.1 0.1", "Kd 0.1 0.1", "Kd spectral m.rfl", "Ke -1 0 0",
                                 "Kd 0.1 0.1 0.1\nNi one"}) {
    const Scene scene = read_text(triangle, "newmtl m\n" + line + "\nKs 0 0 0\n");
    expect_rgb(scene.materials[0].reflectance, 0.5f, 0.5f, 0.5f);
    EXPECT_EQ(scene.materials[0].name, "m");
    ASSERT_EQ(scene.losses.size(), 1u) << line;
    EXPECT_NE(scene.losses[0].find("cannot be read got a diffuse reflectance of 0.5: 'm': "),
              std::string::npos);
    EXPECT_NE(scene.losses[0].find("text.mtl:"), std::string::npos) << scene.losses[0];
  }
}

TEST(ReadObj, ColoursOutsideOfTheirRangeAreCutOff) {
  const Scene scene = read_text(triangle, "newmtl m\nKd 1.7 -0.2 0.3\n");
  expect_rgb(scene.materials[0].reflectance, 1.0f, 0.0f, 0.3f);
  EXPECT_TRUE(is_noted(scene, "outside [0, 1] were cut off there in: 'm'"));
  const Scene rounded = read_text(triangle, "newmtl m\nKd 1.000001 0.2 0.3\n");
  expect_rgb(rounded.materials[0].reflectance, 1.0f, 0.2f, 0.3f);
  EXPECT_TRUE(rounded.losses.empty());
}

TEST(ReadObj, KeysMayBeInLowerCase) {
  const Scene scene = read_text(triangle, "NEWMTL m\nkd 0.1 0.2 0.3\nke 1 1 1\n");
  expect_rgb(scene.materials[0].reflectance, 0.1f, 0.2f, 0.3f);
  EXPECT_TRUE(scene.materials[0].is_emitter());
}

TEST(ReadObj, AMaterialWithoutAColourIsGreyAndNoted) {
  const Scene scene = read_text(triangle, "newmtl m\nNs 10\nillum 2\n");
  expect_rgb(scene.materials[0].reflectance, 0.5f, 0.5f, 0.5f);
  EXPECT_TRUE(is_noted(scene, "without a colour got a diffuse reflectance of 0.5: 'm'"));
}

TEST(ReadObj, OneNumberStandsForThree) {
  const Scene scene = read_text(triangle, "newmtl m\nKd 0.25\n");
  expect_rgb(scene.materials[0].reflectance, 0.25f, 0.25f, 0.25f);
}

TEST(ReadObj, WithoutMaterialsGreyIsAssumedAndSaid) {
  const Scene missing = read_text(triangle);
  expect_rgb(missing.materials[0].reflectance, 0.5f, 0.5f, 0.5f);
  EXPECT_TRUE(is_noted(missing, "Material files are missing"));
  EXPECT_TRUE(is_noted(missing, "text.mtl'"));
  EXPECT_TRUE(is_noted(missing, "Materials are not defined"));
  EXPECT_TRUE(is_noted(missing, "'m'"));
  const Scene none = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "newmtl unused\n");
  EXPECT_EQ(none.materials[0].name, "default");
  EXPECT_TRUE(is_noted(none, "1 polygon names no material"));
  EXPECT_EQ(none.surfaces[0].name, "text");
}

TEST(ReadObj, FacesMayComeBeforeTheirVertices) {
  EXPECT_EQ(read_text("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").surfaces.size(), 1u);
}

TEST(ReadObj, TakesPolygonsOfAnySize) {
  std::ostringstream text, face;
  for (int i = 1; i <= 1000; ++i) {
    const double phi = 2.0 * std::numbers::pi * i / 1000;
    text << "v " << std::cos(phi) << ' ' << std::sin(phi) << " 0\n";
    face << ' ' << i;
  }
  const Scene scene = read_text(text.str() + "f" + face.str() + "\n");
  const auto& disk = std::get<PolygonMesh>(scene.surfaces[0].shape);
  ASSERT_EQ(disk.facets.size(), 1u);
  // Six digits per coordinate; the regular 1000-gon is 6.6e-6 short of the circle.
  EXPECT_NEAR(facet_area(disk, disk.facets[0]), std::numbers::pi, 3e-5);
}

TEST(ReadObj, MetresPerUnitScales) {
  const Scene scene = read_obj(LIGHTWELL_TEST_DATA "/scene/room.obj", 0.0254);
  const Bounds bounds = scene_bounds(scene);
  EXPECT_TRUE(bounds.high.isApprox(0.0254 * Eigen::Vector3d(4, 3, 2.5), 1e-12));
  EXPECT_DOUBLE_EQ(scene.metres_per_unit, 0.0254);
}

}  // namespace
}  // namespace lightwell::read_obj_test
