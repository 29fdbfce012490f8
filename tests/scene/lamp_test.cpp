#include "scene/lamp.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <numbers>

#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "scene/projected_picture.h"
#include "scene/scene.h"
#include "tests/scene/expected_messages.h"
#include "tests/temporary_folder.h"

namespace lightwell::lamp_test {
namespace {

constexpr double pi = std::numbers::pi;

// Flux of a lamp as the mean weight of drawn directions.
double drawn_flux(const Lamp& lamp) {
  double sum = 0.0;
  constexpr int draws = 1 << 16;
  for (int i = 0; i < draws; ++i) {
    const auto u = static_cast<float>((i + 0.5) / draws);
    const auto v = static_cast<float>(std::fmod(i * 0.6180339887498949, 1.0));
    sum += draw_ray(lamp, {u, v, 0.5f, 0.5f}).weight;
  }
  return sum / draws;
}

// Flux of a lamp by rings of a fine grid.
double integrated_flux(const Lamp& lamp) {
  double sum = 0.0;
  constexpr int rings = 20000;
  for (int i = 0; i < rings; ++i) {
    const double theta = pi * (i + 0.5) / rings;
    const Eigen::Vector3d direction =
        std::cos(theta) * lamp.aim() + std::sin(theta) * lamp.axes.col(0);
    sum += relative_intensity(lamp, direction) * 2.0 * pi * std::sin(theta) * pi / rings;
  }
  return sum;
}

TEST(Lamp, FluxIsTheIntegralOfItsIntensity) {
  Lamp lamp{.axes = lamp_axes({1, -2, 0.5})};
  EXPECT_NEAR(relative_flux(lamp), 4.0 * pi, 1e-12);
  for (const auto edge : {SpotCone::Edge::smooth, SpotCone::Edge::straight}) {
    for (const auto& [inner, outer] :
         {std::pair(0.0, 0.7), std::pair(0.3, 0.5), std::pair(0.5, 0.5), std::pair(0.2, pi)}) {
      lamp.shape = SpotCone{.inner = inner, .outer = outer, .edge = edge};
      EXPECT_NEAR(relative_flux(lamp) / integrated_flux(lamp), 1.0, 1e-3) << inner << ' ' << outer;
      EXPECT_NEAR(drawn_flux(lamp) / relative_flux(lamp), 1.0, 1e-3) << inner << ' ' << outer;
    }
  }
}

TEST(Lamp, SpotFallsOffAsItsFormatsHaveIt) {
  Lamp lamp{.axes = lamp_axes(-Eigen::Vector3d::UnitZ()),
            .shape = SpotCone{.inner = 0.2, .outer = 0.6}};
  const auto at = [&](double angle) {
    return relative_intensity(lamp, {std::sin(angle), 0.0, -std::cos(angle)});
  };
  EXPECT_EQ(at(0.1), 1.0);
  EXPECT_EQ(at(0.7), 0.0);
  const double share = (std::cos(0.4) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
  EXPECT_NEAR(at(0.4), share * share, 1e-12);
  std::get<SpotCone>(lamp.shape).edge = SpotCone::Edge::straight;
  EXPECT_NEAR(at(0.5), 0.25, 1e-12);
}

// gamma = 0 is along the aim, C0 along the given direction, C90 counter-clockwise from C0 as seen
// from above.
TEST(Lamp, AxesFollowAimAndC0) {
  const Eigen::Matrix3d down = lamp_axes(-Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX());
  EXPECT_LT((down.col(0) - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((down.col(1) + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_NEAR(lamp_axes({3, 0, 0}).determinant(), 1.0, 1e-12);

  Eigen::ArrayXXd values(4, 2);
  values << 0, 10, 0, 20, 0, 30, 0, 40;  // at gamma 90 of C 0, 90, 180, 270
  const Lamp lamp{.axes = down,
                  .shape = std::make_shared<const PhotometricWeb>(
                      std::vector<double>{0, 90, 180, 270}, std::vector<double>{0, 90}, values)};
  EXPECT_NEAR(relative_intensity(lamp, Eigen::Vector3d::UnitX()), 10.0, 1e-6);
  EXPECT_NEAR(relative_intensity(lamp, -Eigen::Vector3d::UnitZ()), 20.0, 1e-6);
  EXPECT_NEAR(relative_intensity(lamp, -Eigen::Vector3d::UnitX()), 30.0, 1e-6);
  EXPECT_NEAR(relative_intensity(lamp, Eigen::Vector3d::UnitZ()), 40.0, 1e-6);
}

TEST(Lamp, OpeningPointsLieWithinTheOpening) {
  Lamp lamp{.position = {1, 2, 3}, .opening = {.along_c0 = 0.4, .along_c90 = 0.2}};
  for (const bool is_round : {false, true}) {
    lamp.opening.is_round = is_round;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (int i = 0; i < 64; ++i) {
      const Eigen::Vector3d p =
          opening_point(lamp, (i % 8 + 0.5) / 8, (i / 8 + 0.5) / 8) - lamp.position;
      const double x = p.x() / 0.2, y = p.y() / 0.1;
      EXPECT_LE(is_round ? x * x + y * y : std::max(std::abs(x), std::abs(y)), 1.0 + 1e-6);
      EXPECT_EQ(p.z(), 0.0);
      mean += p / 64;
    }
    EXPECT_LT(mean.norm(), 1e-6);
  }
}

TEST(PhotometricWeb, LinearTablesIntegrateExactly) {
  // I = 1 from gamma 0 to 90, half of the sphere.
  const PhotometricWeb even({0.0}, {0.0, 30.0, 90.0}, Eigen::ArrayXXd::Ones(1, 3));
  EXPECT_NEAR(even.integral(), 2.0 * pi, 1e-12);
  EXPECT_THROW(PhotometricWeb({0.0}, {0.0, 90.0}, -Eigen::ArrayXXd::Ones(1, 2)),
               std::invalid_argument);
  EXPECT_THROW(PhotometricWeb({10.0}, {0.0, 90.0}, Eigen::ArrayXXd::Ones(1, 2)),
               std::invalid_argument);
  EXPECT_THROW(PhotometricWeb({0.0}, {90.0, 0.0}, Eigen::ArrayXXd::Ones(1, 2)),
               std::invalid_argument);
}

class TomlLamps : public testing::Test {
 protected:
  Scene read(const std::string& lamps) {
    return read_toml(folder_.write("room.toml", R"(unit = "cm"
[materials.white]
reflectance = 0.7
[[surfaces]]
material = "white"
box = { min = [0, 0, 0], max = [400, 300, 250], inward = true }
)" + lamps));
  }
  void expect_error(const std::string& lamps, const std::vector<std::string>& parts) {
    test::expect_message([&] { read(lamps); }, parts);
  }
  TemporaryFolder folder_{};
};

TEST_F(TomlLamps, PointsSpotsAndFilesArePlaced) {
  std::filesystem::copy_file(std::filesystem::path(LIGHTWELL_TEST_DATA) / "luminaires/x_arrow.ies",
                             folder_ / "arrow.ies");
  const Scene scene = read(R"([[lamps]]
name = "bulb"
position = [200, 150, 200]
lumens = 800
colour = [1.0, 0.8, 0.6]
[[lamps]]
position = [100, 150, 250]
aim = [0, 0, -2]
cone = [10, 30]
candela = 500
opening = [5, 5]
round = true
[[lamps]]
position = [300, 150, 250]
look_at = [300, 150, 0]
c0 = [0, 1, 0]
file = "arrow.ies"
factor = 0.8
)");
  ASSERT_EQ(scene.lamps.size(), 3u);
  EXPECT_EQ(scene.lamps[0].name, "bulb");
  EXPECT_EQ(scene.lamps[1].name, "lamp2");
  EXPECT_LT((scene.lamps[0].position - Eigen::Vector3d(2.0, 1.5, 2.0)).norm(), 1e-12);
  EXPECT_NEAR(luminous(scene.bands, lamp_flux(scene.lamps[0])), 800.0, 0.01);
  EXPECT_NEAR(scene.lamps[0].intensity[2] / scene.lamps[0].intensity[0], 0.6, 1e-5);
  EXPECT_NEAR(luminous(scene.bands, scene.lamps[1].intensity), 500.0, 0.01);
  EXPECT_NEAR(scene.lamps[1].opening.along_c0, 0.05, 1e-12);
  EXPECT_TRUE(scene.lamps[1].opening.is_round);
  EXPECT_NEAR(luminous(scene.bands, lamp_flux(scene.lamps[2])), 0.8 * 525.0, 0.01 * 420.0);
  EXPECT_LT((scene.lamps[2].axes.col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_NEAR(scene.lamps[2].opening.along_c0, 0.1, 1e-9);
  EXPECT_TRUE(gives_light(scene));
}

TEST_F(TomlLamps, HashTellsLampsApart) {
  const std::string lamp = "[[lamps]]\nposition = [200, 150, 200]\n";
  const auto hash = [&](const std::string& more) { return scene_hash(read(lamp + more)); };
  EXPECT_EQ(hash("lumens = 800"), hash("name = \"other\"\nlumens = 800"));
  EXPECT_NE(hash("lumens = 800"), hash("lumens = 801"));
  EXPECT_NE(hash("lumens = 800"), hash("lumens = 800\nopening = [1, 1]"));
  EXPECT_NE(hash("lumens = 800"), scene_hash(read("")));
  EXPECT_NE(hash("candela = 8\ncone = [10, 30]\naim = [0, 0, -1]"),
            hash("candela = 8\ncone = [11, 30]\naim = [0, 0, -1]"));
}

TEST_F(TomlLamps, MistakesAreToldWithTheirPlace) {
  const std::string lamp = "[[lamps]]\nposition = [200, 150, 200]\n";
  expect_error("[[lamps]]\nlumens = 5", {"room.toml:7", "lamp 'lamp1'", "position"});
  expect_error(lamp, {"exactly one of", "'lumens'"});
  expect_error(lamp + "lumens = 5\ncandela = 2", {"exactly one of"});
  expect_error(lamp + "lumens = -5", {"lumens"});
  expect_error(lamp + "lumens = 5\naim = [0, 0, -1]", {"aim", "alike to all sides"});
  expect_error(lamp + "lumens = 5\ncone = [10, 30]", {"exactly one of 'aim' and 'look_at'"});
  expect_error(lamp + "lumens = 5\naim = [0, 0, 1]\ncone = [40, 30]", {"[40, 30]"});
  expect_error(lamp + "lumens = 5\naim = [0, 0, 1]\nc0 = [0, 0, 2]\ncone = [10, 30]",
               {"c0", "parallel"});
  expect_error(lamp + "lumens = 5\nround = true", {"round", "opening"});
  expect_error(lamp + "file = \"none.ies\"\naim = [0, 0, -1]", {"none.ies", "cannot be used"});
  expect_error(lamp + "lumens = 5\ncolour = 0", {"colour", "black"});
  expect_error(lamp + "lumens = 5\ncolor = 1", {"color", "colour"});
}

// two-pixels.png is white on its left, black on its right.
class TomlProjectors : public TomlLamps {
 protected:
  TomlProjectors() {
    std::filesystem::copy_file(std::filesystem::path(LIGHTWELL_TEST_DATA) / "scene/two-pixels.png",
                               folder_ / "two.png");
  }
  std::string lamp(const std::string& more, const std::string& beam = "beam = 40") const {
    return "[[lamps]]\nposition = [200, 100, 150]\naim = [0, 1, 0]\nlumens = 1000\n"
           "picture = \"two.png\"\n" +
           beam + "\n" + more;
  }
};

// The flux is that without the picture; half of the picture is black, and half of its white is cut.
TEST_F(TomlProjectors, FluxIsThatWithoutThePicture) {
  for (const char* bands : {"", "[bands]\nkind = \"spectral\"\ncount = 20\n"}) {
    const Scene whole = read(lamp("") + bands), cut = read(lamp("shutters = { left = 0.25 }"));
    EXPECT_NEAR(luminous(whole.bands, lamp_flux(whole.lamps.at(0))), 500.0, 0.01);
    EXPECT_NEAR(luminous(cut.bands, lamp_flux(cut.lamps.at(0))), 250.0, 0.01);
  }
}

TEST_F(TomlProjectors, UpTurnsThePicture) {
  const auto sees = [&](const std::string& more, double x, double z) {
    const Scene scene = read(lamp(more));
    return relative_intensity(scene.lamps.at(0), Eigen::Vector3d(x, 1.0, z).normalized()) > 0.0;
  };
  // Looking along +y with +z up, left is -x; with -z up it is +x. With +x up, left is +z.
  EXPECT_TRUE(sees("", -0.1, 0.0));
  EXPECT_FALSE(sees("", 0.1, 0.0));
  EXPECT_TRUE(sees("up = [0, 0, -3]", 0.1, 0.0));
  EXPECT_FALSE(sees("up = [0, 0, -3]", -0.1, 0.0));
  EXPECT_TRUE(sees("up = [2, 1, 0]", 0.0, 0.1));
  EXPECT_FALSE(sees("up = [2, 1, 0]", 0.0, -0.1));
}

TEST_F(TomlProjectors, OpticsAreReadInTheUnitOfTheFile) {
  const Scene scene = read(lamp("focus = 300\nlens = 8\nshutters = { top = 0.2, right = 0.1 }"));
  const auto& picture = *std::get<SharedPicture>(scene.lamps.at(0).shape);
  EXPECT_NEAR(picture.optics().focus, 3.0, 1e-12);
  EXPECT_NEAR(picture.optics().lens, 0.08, 1e-12);
  EXPECT_NEAR(picture.optics().beam, 40.0 * pi / 180.0, 1e-12);
  EXPECT_EQ(picture.optics().shutters.top, 0.2);
  EXPECT_EQ(picture.optics().shutters.right, 0.1);
  const Scene usual = read(lamp("focus = 300"));
  EXPECT_EQ(std::get<SharedPicture>(usual.lamps.at(0).shape)->optics().lens, 0.1);
}

TEST_F(TomlProjectors, LampsShareTheirPicture) {
  const Scene scene = read(lamp("") + lamp("focus = 200"));
  const auto& a = *std::get<SharedPicture>(scene.lamps.at(0).shape);
  const auto& b = *std::get<SharedPicture>(scene.lamps.at(1).shape);
  EXPECT_EQ(&a.slide(), &b.slide());
}

TEST_F(TomlProjectors, HashTellsPicturesApart) {
  const auto hash = [&](const std::string& more) { return scene_hash(read(lamp(more))); };
  EXPECT_NE(hash(""), hash("shutters = { left = 0.1 }"));
  EXPECT_NE(hash("focus = 200"), hash("focus = 210"));
  EXPECT_NE(hash("focus = 200"), hash("focus = 200\nlens = 5"));
  EXPECT_NE(hash(""), scene_hash(read(lamp("", "beam = 41"))));
}

TEST_F(TomlProjectors, MistakesAreToldWithTheirPlace) {
  const auto refuses = [&](const std::string& more, const std::string& part) {
    expect_error(lamp(more), {"room.toml:", "lamp 'lamp1'", part});
  };
  expect_error(lamp("", ""), {"lamp 'lamp1'", "needs a 'beam'"});
  expect_error(lamp("", "beam = 0"), {"room.toml:12", "beam of lamp 'lamp1'", "0.1", "170"});
  expect_error(lamp("", "beam = 180"), {"beam of lamp 'lamp1'", "170"});
  refuses("focus = 0", "focus");
  refuses("focus = -2", "focus");
  refuses("lens = 3", "'focus'");
  refuses("focus = 5\nlens = 6", "wider than the 'focus'");
  refuses("focus = 5\nlens = 0", "lens");
  refuses("shutters = { left = 0.6, right = 0.4 }", "leave nothing of the picture");
  refuses("shutters = { top = 0.6, bottom = 0.5 }", "'bottom' 0.5");
  refuses("shutters = { top = 1.5 }", "top");
  refuses("shutters = { up = 0.1 }", "up");
  refuses("cone = [10, 20]", "contradicts 'picture'");
  refuses("file = \"a.ies\"", "contradicts 'picture'");
  refuses("opening = [1, 1]", "leaves a point");
  refuses("c0 = [1, 0, 0]", "'up' turns it");
  refuses("up = [0, 2, 0]", "parallel");
  const std::string plain = "[[lamps]]\nposition = [200, 100, 150]\nlumens = 5\n";
  for (const char* key : {"beam = 4", "focus = 4", "lens = 4", "shutters = {}", "up = [0, 0, 1]"}) {
    expect_error(plain + key, {"room.toml:10", "belongs to a 'picture'"});
  }
  const std::string other = plain + "aim = [0, 1, 0]\nbeam = 30\npicture = ";
  expect_error(other + "\"none.png\"",
               {"room.toml:12", "picture of lamp", "none.png", "no such file"});
  folder_.write("text.png", "no picture");
  expect_error(other + "\"text.png\"", {"room.toml:12", "no PNG, JPEG, EXR or HDR"});
  folder_.write("torn.png", "\x89PNG\r\n\x1a\n torn");
  expect_error(other + "\"torn.png\"", {"room.toml:12", "torn.png", "cannot be used"});
}

// 4097 x 4097 pixels, one row more than the most, as runs of a RADIANCE picture.
TEST_F(TomlProjectors, RefusesPicturesThatAreTooLarge) {
  std::string row = {2, 2, 4097 / 256, 4097 % 256};
  for (int channel = 0; channel < 4; ++channel) {
    for (int run = 0; run < 32; ++run) row += {static_cast<char>(128 + 127), '\x80'};
    row += {static_cast<char>(128 + 33), '\x80'};
  }
  std::string huge = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4097 +X 4097\n";
  for (int y = 0; y < 4097; ++y) huge += row;
  folder_.write("huge.hdr", huge);
  expect_error(
      "[[lamps]]\nposition = [200, 100, 150]\naim = [0, 1, 0]\nlumens = 5\nbeam = 30\n"
      "picture = \"huge.hdr\"\n",
      {"room.toml:12", "4097 x 4097", "16777216", "smaller"});
}

TEST_F(TomlLamps, RadiantFilesMakeTheSceneRelative) {
  std::filesystem::copy_file(
      std::filesystem::path(LIGHTWELL_TEST_DATA) / "luminaires/uv_LLIA001477-002.ies",
      folder_ / "uv.ies");
  const Scene scene =
      read("[[lamps]]\nposition = [200, 150, 200]\naim = [0, 0, -1]\nfile = \"uv.ies\"\n");
  EXPECT_TRUE(scene.relative_units);
  EXPECT_NEAR(lamp_flux(scene.lamps[0])[0], 53.6e-3, 1e-3);
  ASSERT_FALSE(scene.notes.empty());
  EXPECT_NE(scene.notes[0].find("not candela"), std::string::npos);
}

TEST(LampsOfOtherFormats, GltfPointsAndSpots) {
  const TemporaryFolder folder;
  std::ofstream(folder / "t.gltf") << R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1,2,3]}],
    "extensionsUsed":["KHR_lights_punctual"],
    "extensions":{"KHR_lights_punctual":{"lights":[
      {"type":"point","color":[1,0.5,0.25],"intensity":40,"range":9},
      {"type":"spot","name":"spot","intensity":8,"spot":{"innerConeAngle":0.1,"outerConeAngle":0.5}},
      {"type":"directional","name":"sun"}]}},
    "nodes":[{"mesh":0},
      {"name":"a","translation":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":0}}},
      {"translation":[0,5,0],"rotation":[-0.70710678,0,0,0.70710678],
       "extensions":{"KHR_lights_punctual":{"light":1}}},
      {"extensions":{"KHR_lights_punctual":{"light":2}}}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
    "bufferViews":[{"buffer":0,"byteLength":36}],
    "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  const Scene scene = read_gltf(folder / "t.gltf");
  ASSERT_EQ(scene.lamps.size(), 2u);
  EXPECT_EQ(scene.lamps[0].name, "a");
  EXPECT_LT((scene.lamps[0].position - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
  EXPECT_NEAR(scene.lamps[0].intensity[1], 20.0f, 1e-5);
  EXPECT_EQ(scene.lamps[1].name, "spot");
  EXPECT_LT((scene.lamps[1].aim() + Eigen::Vector3d::UnitY()).norm(), 1e-6);
  const auto noted = [&](const char* part) {
    for (const std::string& note : scene.notes) {
      if (note.find(part) != std::string::npos) return true;
    }
    return false;
  };
  EXPECT_TRUE(noted("'sun'"));
  EXPECT_TRUE(noted("Ranges of lights"));
  EXPECT_FALSE(noted("dark"));
}

TEST(LampsOfOtherFormats, MitsubaPointsAndSpots) {
  const TemporaryFolder folder;
  const auto path = folder.write("t.xml", R"(<scene version="3.0.0">
    <shape type="rectangle"/>
    <emitter type="point" id="bulb"><point name="position" x="1" y="2" z="3"/>
      <rgb name="intensity" value="4, 5, 6"/></emitter>
    <emitter type="spot"><float name="cutoff_angle" value="40"/>
      <transform name="to_world"><lookat origin="0,5,0" target="0,0,0" up="1,0,0"/></transform>
    </emitter></scene>)");
  const Scene scene = read_mitsuba(path);
  ASSERT_EQ(scene.lamps.size(), 2u);
  EXPECT_EQ(scene.lamps[0].name, "bulb");
  EXPECT_NEAR(scene.lamps[0].intensity[2], 6.0f, 1e-6);
  EXPECT_LT((scene.lamps[0].position - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
  const auto& cone = std::get<SpotCone>(scene.lamps[1].shape);
  EXPECT_NEAR(cone.outer, 40.0 * pi / 180.0, 1e-12);
  EXPECT_NEAR(cone.inner, 30.0 * pi / 180.0, 1e-12);
  EXPECT_LT((scene.lamps[1].aim() + Eigen::Vector3d::UnitY()).norm(), 1e-9);
}

}  // namespace
}  // namespace lightwell::lamp_test
