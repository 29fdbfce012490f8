#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "scene/coat.h"
#include "scene/io/read_scene.h"
#include "scene/round_shape.h"
#include "tests/scene/expected_messages.h"
#include "tests/temporary_folder.h"

namespace lightwell::read_toml_test {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

const Scene& everything() {
  static const Scene scene = read_scene(LIGHTWELL_TEST_DATA "/scene/everything.toml");
  return scene;
}

const Surface& surface(const Scene& scene, const std::string& name) {
  for (const Surface& s : scene.surfaces) {
    if (s.name == name) return s;
  }
  throw std::runtime_error("no surface " + name);
}

const PolygonMesh& mesh(const Scene& scene, const std::string& name) {
  return std::get<PolygonMesh>(surface(scene, name).shape);
}

const Material& material_of(const Scene& scene, const std::string& surface_name) {
  return scene.materials[static_cast<std::size_t>(surface(scene, surface_name).material)];
}

double area(const PolygonMesh& m) {
  double sum = 0.0;
  for (const Facet& facet : m.facets) sum += facet_area(m, facet);
  return sum;
}

// Volume by the divergence theorem, positive if the polygons face outwards.
double volume(const PolygonMesh& m) {
  double sum = 0.0;
  for (const Facet& f : m.facets) {
    sum += m.vertices[static_cast<std::size_t>(f.boundary[0])].dot(facet_normal(m, f)) *
           facet_area(m, f) / 3.0;
  }
  return sum;
}

void expect_spectrum(const Spectrum& actual, std::vector<float> expected) {
  ASSERT_EQ(actual.size(), static_cast<int>(expected.size()));
  for (int k = 0; k < actual.size(); ++k) {
    // The tolerance covers a value rounded to float and one product.
    EXPECT_NEAR(actual[k], expected[static_cast<std::size_t>(k)],
                2e-7f * expected[static_cast<std::size_t>(k)])
        << "band " << k;
  }
}

Scene read_text(const std::string& text) {
  const TemporaryFolder folder;
  return read_scene(folder.write("text.toml", text));
}

const std::string one_polygon = R"(
[[surfaces]]
material = "white"
polygon = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
)";

TEST(ReadToml, KnowsTitleUnitAndBands) {
  EXPECT_EQ(everything().title, "A workshop with one of everything");
  EXPECT_EQ(everything().unit_name, "cm");
  EXPECT_DOUBLE_EQ(everything().metres_per_unit, 0.01);
  EXPECT_EQ(everything().bands.count(), 3);
  EXPECT_DOUBLE_EQ(everything().bands.lumens_per_watt, 179.0);
}

TEST(ReadToml, UnitsAreThoseOfTheSiBrochure) {
  const std::vector<std::pair<std::string, double>> units = {
      {"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}, {"in", 0.0254}, {"ft", 0.3048}};
  for (const auto& [unit, metres] : units) {
    const Scene scene =
        read_text("unit = \"" + unit + "\"\n[materials.white]\nexitance = 2\n" + one_polygon);
    EXPECT_NEAR(area(mesh(scene, "surface1")), metres * metres, 1e-12 * metres * metres) << unit;
    expect_spectrum(scene.materials[0].emission, {2, 2, 2});  // per m^2 whatever the unit
  }
}

TEST(ReadToml, MaterialsReflect) {
  const Scene& s = everything();
  EXPECT_TRUE(material_of(s, "room").one_sided);
  expect_spectrum(material_of(s, "room").reflectance, {0.5f, 0.5f, 0.5f});
  expect_spectrum(material_of(s, "window frame").reflectance, {0.6f, 0.4f, 0.2f});
  EXPECT_FALSE(material_of(s, "window frame").one_sided);
  expect_spectrum(material_of(s, "crate").reflectance, {0.5f, 0.4f, 0.3f});
  expect_spectrum(material_of(s, "crate").specular, {0.1f, 0.2f, 0.3f});
  expect_spectrum(material_of(s, "surface4").specular, {0.9f, 0.9f, 0.9f});
  const Material& glass = material_of(s, "ball");
  ASSERT_TRUE(glass.dielectric);
  EXPECT_FLOAT_EQ(glass.dielectric->index_of_refraction, 1.52f);
  expect_spectrum(glass.dielectric->tint, {0.9f, 0.95f, 0.9f});
}

TEST(ReadToml, CoatsCoverTheirBase) {
  const Scene scene = read_text(R"(
[materials.lacquer]
reflectance = 0.4
coat = 1.6
[materials.glaze]
coat = { ior = 1.5, roughness = 0.1, share = 0.8, base = [1, 0.5, 0] }
[[surfaces]]
name = "a"
material = "lacquer"
polygon = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
[[surfaces]]
name = "b"
material = "glaze"
polygon = [[0, 0, 1], [1, 0, 1], [0, 1, 1]]
)");
  const Material& lacquer = material_of(scene, "a");
  ASSERT_TRUE(lacquer.coat);
  EXPECT_FLOAT_EQ(lacquer.coat->index_of_refraction, 1.6f);
  expect_spectrum(lacquer.reflectance, {0.4f, 0.4f, 0.4f});
  expect_spectrum(lacquer.specular, {1.0f, 1.0f, 1.0f});
  const Material& glaze = material_of(scene, "b");
  ASSERT_TRUE(glaze.coat);
  EXPECT_FLOAT_EQ(glaze.specular_roughness, 0.1f);
  expect_spectrum(glaze.specular, {0.8f, 0.8f, 0.8f});
  const Spectrum rho = CoatOverBase(glaze).reflectance(Spectrum{{1.0f, 0.5f, 0.0f}});
  expect_spectrum(glaze.reflectance, {rho[0], rho[1], rho[2]});
}

TEST(ReadToml, SheetsPassLight) {
  const Scene scene = read_text(R"(
[bands]
kind = "spectral"
from = 400
to = 600
count = 2
[materials.white]
reflectance = 0.4
coat = 1.5
translucent = [0.2, 0.3]
transparent = { wavelengths = [400, 600], values = [0.0, 0.2] }
)" + one_polygon);
  const Material& curtain = scene.materials[0];
  expect_spectrum(curtain.transmittance, {0.2f, 0.3f});
  expect_spectrum(curtain.regular_transmittance, {0.05f, 0.15f});  // the means of the halves
  EXPECT_FALSE(curtain.one_sided || curtain.dielectric);
  const Scene opaque = read_text("[materials.white]\nreflectance = 0.5\n" + one_polygon);
  EXPECT_FALSE(opaque.materials[0].is_translucent() || opaque.materials[0].passes_straight());
}

TEST(ReadToml, SheetsThatCannotBeAreToldWhy) {
  const auto refuses = [](const std::string& keys, const char* words) {
    test::expect_message([&] { read_text("[materials.white]\n" + keys + "\n" + one_polygon); },
                         {"text.toml:", "'white'", words});
  };
  refuses("reflectance = 0.5\ntranslucent = 0.6", "add up to 1.1");
  refuses("reflectance = 0.2\nspecular = 0.3\ntransparent = [0.1, 0.6, 0.1]", "add up to 1.1");
  refuses("translucent = 0.6\ntransparent = 0.5", "add up to 1.1");
  refuses("translucent = 1.5", "1.5");
  refuses("translucent = 0.1\nsides = \"one\"", "needs both sides of the surface");
  refuses("transparent = 0.1\nsides = \"one\"", "needs both sides of the surface");
  refuses("translucent = 0.1\nglass = { ior = 1.5 }", "contradicts 'glass'");
  refuses("transparent = 0.1\nglass = { ior = 1.5 }", "contradicts 'glass'");
}

// A texture reflects what the other shares leave, unless its factor is given.
TEST(ReadToml, TexturesOfSheetsLeaveRoomForWhatPasses) {
  const TemporaryFolder folder;
  std::filesystem::copy(LIGHTWELL_TEST_DATA "/scene/two-pixels.png", folder / "print.png");
  const auto factor = [&](const std::string& keys) {
    const Scene scene = read_scene(folder.write(
        "print.toml", "[materials.white]\ntexture = \"print.png\"\n" + keys + one_polygon));
    return scene.materials[0].texture.value().factor[0];
  };
  EXPECT_FLOAT_EQ(factor("translucent = 0.25\nspecular = 0.125\n"), 0.625f);
  EXPECT_FLOAT_EQ(factor("translucent = 0.25\ntransparent = 0.25\n"), 0.5f);
  EXPECT_FLOAT_EQ(factor("translucent = 0.25\nreflectance = 0.3\n"), 0.3f);
}

TEST(ReadToml, ReliefIsOfNormalsOrOfHeights) {
  const TemporaryFolder folder;
  for (const char* name : {"normals.png", "heights.png"}) {
    std::filesystem::copy(std::filesystem::path(LIGHTWELL_TEST_DATA "/scene") / name,
                          folder / name);
  }
  const auto read = [&](const std::string& relief) {
    return read_scene(folder.write("wall.toml", "[materials.white]\nrelief = " + relief +
                                                    one_polygon +
                                                    "uv = [[0, 0], [1, 0], [1, 1], [0, 1]]\n"));
  };
  const Scene normals = read("\"normals.png\"\n");
  const Relief& first = normals.materials[0].relief.value();
  EXPECT_FALSE(first.is_in_metres);
  EXPECT_EQ(first.scale, 1.0);
  // Normals of (76, 0, 102) / 127: a slope of 76 / 102 downwards.
  EXPECT_NEAR(first.steepest, 76.0 / 102.0, 1e-4);
  EXPECT_NEAR(first.slopes.at({0.25, 0.25})[0], 0.0f, 1e-4f);
  EXPECT_EQ(read("{ file = \"normals.png\", scale = -2 }\n").materials[0].relief->scale, -2.0);
  const Scene heights =
      read("{ file = \"heights.png\", kind = \"height\", depth = 0.01, wrap = \"clamp\" }\n");
  const Relief& second = heights.materials[0].relief.value();
  EXPECT_TRUE(second.is_in_metres);
  EXPECT_EQ(second.scale, 0.01);
  EXPECT_EQ(second.slopes.wrap[0], TextureWrap::clamp);
  const auto refuses = [&](const std::string& relief, const std::string& why) {
    try {
      read(relief + "\n");
      FAIL() << relief;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  refuses("\"gone.png\"", "cannot be used");
  refuses("\"heights.png\"", "grey picture, which has no normals");
  refuses("{ file = \"normals.png\", scale = 1000 }", "between -10 and 10");
  refuses("{ file = \"normals.png\", depth = 0.1 }", "goes with kind = \"height\"");
  refuses("{ file = \"heights.png\", kind = \"height\" }", "needs a 'depth'");
  refuses("{ file = \"heights.png\", kind = \"height\", depth = 5 }", "between -1 and 1");
  refuses("{ file = \"heights.png\", kind = \"height\", depth = 0.1, scale = 2 }",
          "goes with kind = \"normal\"");
}

TEST(ReadToml, MetalsHaveAComplexIndex) {
  const auto metal = [](const std::string& keys) {
    return read_text("[materials.white]\n" + keys + one_polygon).materials[0];
  };
  const Material gold =
      metal("metal = { eta = [0.14, 0.37, 1.44], k = [3.98, 2.39, 1.6] }\nroughness = 0.2");
  expect_spectrum(gold.metal.value().eta, {0.14f, 0.37f, 1.44f});
  expect_spectrum(gold.metal->k, {3.98f, 2.39f, 1.6f});
  expect_spectrum(gold.specular, {1, 1, 1});
  EXPECT_FLOAT_EQ(gold.specular_roughness, 0.2f);
  EXPECT_FLOAT_EQ(metal("metal = { eta = 1, k = 2 }\nspecular = 0.5").specular[0], 0.5f);
  const auto refuses = [&](const std::string& keys, const std::string& why) {
    try {
      metal(keys);
      FAIL() << keys;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  refuses("metal = { eta = 1 }", "'k'");
  refuses("metal = { eta = 1, k = -1 }", "at least 0");
  refuses("metal = { eta = 1, k = 1e9 }", "no metal has");
  refuses("metal = { eta = 1, k = 2 }\nreflectance = 0.1", "contradicts 'metal'");
  refuses("metal = { eta = 1, k = 2 }\ncoat = 1.5", "contradicts 'metal'");
}

TEST(ReadToml, GlossGlassAndLensesAreAsTheySay) {
  const Scene scene = read_text(R"(
unit = "cm"
[materials.metal]
specular = 0.8
roughness = 0.25
[materials.frosted]
glass = { ior = 1.4, roughness = 0.1, absorption = [1, 2, 3] }
[materials.pane]
glass = { ior = 1.5, thin = true }
[materials.window]
glass = { ior = 1.52, thin = true, transmissivity = [0.8, 0.9, 0.7] }
[[surfaces]]
name = "floor"
material = "metal"
polygon = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
[[cameras]]
position = [0, 0, 1]
direction = [1, 0, 0]
fov = 90
f_number = 2
focus_distance = 150
blades = 6
[[cameras]]
position = [0, 0, 1]
direction = [1, 0, 0]
aperture_radius = 3
focus_distance = 50
)");
  EXPECT_FLOAT_EQ(scene.materials.at(1).specular_roughness, 0.25f);
  const Dielectric& frosted = scene.materials.at(0).dielectric.value();
  EXPECT_FLOAT_EQ(frosted.roughness, 0.1f);
  EXPECT_FLOAT_EQ(frosted.absorption[2], 3.0f);  // per metre, whatever the unit
  EXPECT_FALSE(frosted.thin);
  EXPECT_TRUE(scene.materials.at(2).dielectric.value().thin);
  EXPECT_EQ(scene.materials.at(2).dielectric->transmissivity.size(), 0);
  expect_spectrum(scene.materials.at(3).dielectric.value().transmissivity, {0.8f, 0.9f, 0.7f});
  // A field of 90 degrees over 36 mm: focal length 18 mm, aperture diameter 9 mm.
  EXPECT_NEAR(scene.cameras.at(0).lens_radius, 0.0045, 1e-12);
  EXPECT_DOUBLE_EQ(scene.cameras.at(0).focus_distance, 1.5);
  EXPECT_EQ(scene.cameras.at(0).blades, 6);
  EXPECT_DOUBLE_EQ(scene.cameras.at(1).lens_radius, 0.03);
}

TEST(ReadToml, MaterialsEmit) {
  const Scene& s = everything();
  // M = pi L; twice the band means 17, 11.8 and 4 of the broken line.
  expect_spectrum(material_of(s, "tube").emission, {pi * 34.0f, pi * 23.6f, pi * 8.0f});
  expect_spectrum(material_of(s, "spot").emission, {1, 1, 1});  // 0.01 W/nm in 100 nm
  // Two screens of 1 m^2 with two emitting sides each.
  expect_spectrum(material_of(s, "screen").emission, {0.5f, 1.0f, 1.5f});
  EXPECT_TRUE(material_of(s, "screen").emits_both_sides);
  EXPECT_FALSE(material_of(s, "tube").emits_both_sides);
}

/// Light that a square metre emits, lm/m^2.
double lumens_of(const std::string& bands, const std::string& keys) {
  const Scene s = read_text(bands + "[materials.white]\n" + keys + one_polygon);
  return luminous(s.bands, s.materials[0].emission);
}

TEST(ReadToml, LightIsGivenAsPeopleSeeIt) {
  for (const std::string bands :
       {"", "[bands]\nlumens_per_watt = 179\n", "[bands]\nkind = \"spectral\"\ncount = 3\n"}) {
    const std::string hue = "\ncolour = [1.0, 0.8, 0.5]\n";
    // Floats have 7 digits, and sums of three have a few roundings.
    EXPECT_NEAR(lumens_of(bands, "luminous_exitance = 500" + hue), 500.0, 1e-3);
    EXPECT_NEAR(lumens_of(bands, "luminance = 500"), pi * 500.0, 1e-2);
    EXPECT_NEAR(lumens_of(bands, "lumens = 500" + hue), 500.0, 1e-3);
    EXPECT_NEAR(lumens_of(bands, "lumens = 500\nemits = \"both\""), 250.0, 1e-3);
  }
  const Scene s =
      read_text("[materials.white]\nluminance = 10\ncolour = [2, 1, 0.5]\n" + one_polygon);
  const Spectrum& M = s.materials[0].emission;
  EXPECT_FLOAT_EQ(M[0], 2.0f * M[1]);
  EXPECT_FLOAT_EQ(M[2], 0.5f * M[1]);
}

TEST(ReadToml, LightIsGivenOnce) {
  const auto refuses = [](const std::string& keys, const char* words) {
    test::expect_message([&] { read_text("[materials.white]\n" + keys + "\n" + one_polygon); },
                         {"text.toml:", "'white'", words});
  };
  refuses("lumens = 5\nexitance = 5", "a second statement of the emission");
  refuses("exitance = 5\ncolour = [1, 1, 1]", "a number for each band");
  refuses("colour = [1, 1, 1]", "the hue of light");
  refuses("lumens = [5, 5, 5]", "must be one number");
  refuses("lumens = 5\ncolour = [0, 0, 0]", "is black");
  refuses("watts = 5", "the electric power of a lamp");
  refuses("mask = \"net.png\"\nlumens = 5", "lamps have no holes");
  refuses("glass = { ior = 1.5 }\nlumens = 5", "contradicts 'glass'");
}

TEST(ReadToml, PowerIsSpreadOverSpheresToo) {
  const Scene s = read_text(
      "unit = \"cm\"\n[materials.bulb]\npower = 100\n[[surfaces]]\nmaterial = \"bulb\"\n"
      "sphere = { center = [0, 0, 0], radius = 5 }\nscale = 2\n");
  expect_spectrum(s.materials[0].emission, std::vector<float>(3, 100.0f / (4.0f * pi * 0.01f)));
}

TEST(ReadToml, BoxesFaceOutwardsAndRoomsInwards) {
  EXPECT_NEAR(volume(mesh(everything(), "room")), -5.0 * 4.0 * 3.0, 1e-9);
  EXPECT_NEAR(volume(mesh(everything(), "crate")), 0.8 * 0.8 * 0.8, 1e-9);
  EXPECT_EQ(mesh(everything(), "room").vertices.size(), 8u);
}

TEST(ReadToml, ShapesAreScaledTurnedAndMoved) {
  const PolygonMesh& crate = mesh(everything(), "crate");
  Eigen::AlignedBox3d box;
  for (const auto& v : crate.vertices) box.extend(v);
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector3d(2.1, 1.6, 0.0), 1e-12));
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector3d(2.9, 2.4, 0.8), 1e-12));
  // (0,0,60), rotated about x by 90 degrees around (0,0,50): 10 above the pivot becomes y = -10.
  const PolygonMesh& mirrors = mesh(everything(), "surface4");
  const auto& corner = mirrors.vertices[static_cast<std::size_t>(mirrors.facets[1].boundary[0])];
  EXPECT_TRUE(corner.isApprox(Eigen::Vector3d(0.1, 3.8, 0.5), 1e-12)) << corner.transpose();
  const auto& ball = std::get<Sphere>(surface(everything(), "ball").shape);
  EXPECT_TRUE(ball.center.isApprox(Eigen::Vector3d(4.2, 1.0, 1.0), 1e-12));
  EXPECT_DOUBLE_EQ(ball.radius, 0.3);
}

TEST(ReadToml, TurnsAboutXThenYThenZ) {
  const Scene s = read_text(
      "[materials.white]\n[[surfaces]]\nmaterial = \"white\"\n"
      "sphere = { center = [1, 2, 3], radius = 1 }\nrotate = [30, 40, 50]\n");
  const double degree = std::numbers::pi / 180.0;
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(50 * degree, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(40 * degree, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(30 * degree, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const auto& sphere = std::get<Sphere>(s.surfaces[0].shape);
  EXPECT_TRUE(sphere.center.isApprox(turn * Eigen::Vector3d(1, 2, 3), 1e-12));
}

TEST(ReadToml, RoundShapesAreExactAndPlaced) {
  const auto read = [](const std::string& shape) {
    const Scene s = read_text(
        "unit = \"cm\"\n[materials.white]\n[[surfaces]]\nmaterial = "
        "\"white\"\nrotate = [90, 0, 0]\nscale = 2\n" +
        shape + "\n");
    EXPECT_TRUE(s.losses.empty());
    return std::get<Frustum>(s.surfaces.at(0).shape);
  };
  constexpr double rounding = 16 * 0x1p-53;  // read, scaled and turned: a few products each
  const Frustum tube =
      read("cylinder = { from = [100, 0, 0], to = [100, 0, 50], radius = 10, inward = true }");
  EXPECT_TRUE(tube.base.isApprox(Eigen::Vector3d(2, 0, 0), rounding));
  EXPECT_TRUE(tube.axis.isApprox(Eigen::Vector3d(0, -1, 0), rounding));
  EXPECT_NEAR(tube.height, 1.0, rounding);
  EXPECT_NEAR(tube.top_radius, 0.2, rounding);
  EXPECT_TRUE(tube.inward);
  const Frustum tip = read("cone = { from = [0, 0, 0], to = [0, 0, 50], radius = 10 }");
  EXPECT_EQ(tip.top_radius, 0.0);
  EXPECT_FALSE(tip.inward);
  EXPECT_NEAR(
      read("cone = { from = [0, 0, 0], to = [0, 0, 5], radius = 10, top_radius = 20 }").top_radius,
      0.4, rounding);
  const Frustum ring =
      read("disc = { center = [0, 0, 5], normal = [0, 0, 3], radius = 10, inner_radius = 5 }");
  EXPECT_EQ(ring.height, 0.0);
  EXPECT_NEAR(ring.top_radius, 0.1, rounding);
  EXPECT_TRUE(front_normal(ring, ring.base).isApprox(Eigen::Vector3d(0, -1, 0), rounding));
}

TEST(ReadToml, RoundShapesWithoutAreaAreRefused) {
  const auto refused = [](const std::string& shape, const std::string& part) {
    try {
      read_text("[materials.white]\n[[surfaces]]\nmaterial = \"white\"\n" + shape + "\n");
      ADD_FAILURE() << shape;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused("cylinder = { from = [0,0,0], to = [0,0,0], radius = 1 }", "give it a length");
  refused("cylinder = { from = [0,0,0], to = [0,0,1], radius = 0 }", "radius");
  refused("cone = { from = [0,0,0], to = [0,0,1], radius = 1, top_radius = -1 }", "at least 0");
  refused("disc = { center = [0,0,0], normal = [0,0,0], radius = 1 }", "give a direction");
  refused("disc = { center = [0,0,0], normal = [0,0,1], radius = 1, inner_radius = 1 }",
          "less than the radius");
}

TEST(ReadToml, QuarterTurnsAreExact) {
  for (int quarters = -5; quarters <= 5; ++quarters) {
    const Scene s = read_text(
        "[materials.white]\n[[surfaces]]\nmaterial = \"white\"\n"
        "sphere = { center = [1, 0, 0], radius = 1 }\nrotate = [0, 0, " +
        std::to_string(90 * quarters) + "]\n");
    const auto& c = std::get<Sphere>(s.surfaces[0].shape).center;
    const int q = ((quarters % 4) + 4) % 4;
    EXPECT_EQ(c, Eigen::Vector3d(q == 0   ? 1
                                 : q == 2 ? -1
                                          : 0,
                                 q == 1   ? 1
                                 : q == 3 ? -1
                                          : 0,
                                 0))
        << quarters;
  }
}

TEST(ReadToml, HolesOfEitherWindingAreTakenOut) {
  // 1 m^2 minus two panes of 0.35 x 0.8.
  EXPECT_NEAR(area(mesh(everything(), "window frame")), 1.0 - 2 * 0.35 * 0.8, 1e-12);
}

TEST(ReadToml, SaysWhatItSplits) {
  const Scene& s = everything();
  EXPECT_EQ(mesh(s, "surface4").facets.size(), 3u);
  const bool noted = std::any_of(s.notes.begin(), s.notes.end(), [](const std::string& note) {
    return note.find("polygon 2 of polygons of surface 'surface4'") != std::string::npos &&
           note.find("2 triangles") != std::string::npos;
  });
  EXPECT_TRUE(noted);
}

// One note for all polygons of a surface.
TEST(ReadToml, SaysInOneNoteWhatItSplits) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "bent.toml";
  std::ofstream(file) << "[materials.m]\nreflectance = 0.5\n[[surfaces]]\nname = \"shade\"\n"
                         "material = \"m\"\npolygons = [[[0,0,0],[1,0,0],[1,1,0.1],[0,1,0]],\n"
                         "[[0,0,1],[1,0,1],[1,1,1.2],[0,1,1]]]\n";
  const Scene s = read_scene(file);
  int said = 0;
  for (const std::string& note : s.notes) {
    if (note.find("planar") == std::string::npos) continue;
    ++said;
    EXPECT_NE(note.find("2 polygons of surface 'shade'"), std::string::npos) << note;
    EXPECT_NE(note.find("4 triangles"), std::string::npos) << note;
  }
  EXPECT_EQ(said, 1);
}

struct FaultyPolygon {
  const char* shape;
  const char* fault;
  double area;
};

class FaultyPolygons : public testing::TestWithParam<FaultyPolygon> {};

// A polygon of a [[surfaces]] table has all that its boundary goes round, without its holes, and
// the loss names the file, the place and the fault. Areas by hand; the tolerance of 1e-9 is that of
// convex_pieces() for points that become one, over polygons of a few metres.
TEST_P(FaultyPolygons, AreCutIntoPieces) {
  const Scene scene =
      read_text(std::string("[materials.white]\nreflectance = 0.7\n[[surfaces]]\nname = \"floor\"\n"
                            "material = \"white\"\n") +
                GetParam().shape);
  EXPECT_NEAR(area(mesh(scene, "floor")), GetParam().area, 1e-9);
  ASSERT_EQ(scene.losses.size(), 1u);
  for (const char* part :
       {"text.toml:6:", "polygon of surface 'floor'", GetParam().fault, "pieces"}) {
    EXPECT_NE(scene.losses.front().find(part), std::string::npos) << scene.losses.front();
  }
}

INSTANTIATE_TEST_SUITE_P(
    ReadToml, FaultyPolygons,
    testing::Values(
        FaultyPolygon{"polygon = [[0, 0, 0], [1, 1, 0], [2, 0, 0], [0, 1, 0]]\n",
                      "edges 1 and 3 that cross", 2.0 / 3.0},
        FaultyPolygon{"polygon = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]]\n",
                      "vertex 2 and vertex 4", 0.5},
        FaultyPolygon{"polygon = [[0, 0, 0], [3, 0, 0], [1, 0, 0], [1, 1, 0]]\n", "folds back",
                      0.5},
        FaultyPolygon{"polygon = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]\n"
                      "holes = [[[5, 5, 0], [6, 5, 0], [6, 6, 0]]]\n",
                      "hole 1, which lies outside", 16.0},
        FaultyPolygon{"polygon = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]\n"
                      "holes = [[[3, 3, 0], [6, 3, 0], [3, 3.5, 0]]]\n",
                      "hole 1, which crosses", 16.0 - 5.0 / 12.0},
        FaultyPolygon{"polygon = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]\n"
                      "holes = [[[1, 1, 0], [2, 1, 0], [2, 2, 0]], "
                      "[[1.5, 1.1, 0], [3, 1.1, 0], [3, 3, 0]]]\n",
                      "hole 2, which meets hole 1", 16.0 - (0.5 + 1.425 - 0.95 / 6.0)}));

// Texture coordinates hold on the pieces, at corners of holes too.
TEST(ReadToml, PiecesOfAFaultyPolygonKeepTheirPicture) {
  const Scene scene = read_text(R"([materials.white]
reflectance = 0.7
texture = ")" LIGHTWELL_TEST_DATA R"(/scene/two-pixels.png"
[[surfaces]]
name = "floor"
material = "white"
polygon = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]
holes = [[[3, 3, 0], [6, 3, 0], [3, 3.5, 0]]]
uv = [[0, 0], [1, 0], [1, 2], [0, 2]]
)");
  const PolygonMesh& floor = mesh(scene, "floor");
  for (const Facet& facet : floor.facets) {
    ASSERT_GE(facet.uv_map, 0);
    for (const int v : facet.boundary) {
      const Eigen::Vector3d& p = floor.vertices[static_cast<std::size_t>(v)];
      const Eigen::Vector2d at = floor.uv_maps[static_cast<std::size_t>(facet.uv_map)].at(p);
      EXPECT_NEAR((at - Eigen::Vector2d(p.x() / 4.0, p.y() / 2.0)).norm(), 0.0, 1e-9);
    }
  }
}

TEST(ReadToml, PolygonsWithoutAreaAreLeftOut) {
  const Scene scene = read_text(R"([materials.white]
reflectance = 0.7
[[surfaces]]
name = "line"
material = "white"
polygon = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]
[[surfaces]]
name = "floor"
material = "white"
polygons = [[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
            [[0, 0, 0], [1, 1, 1], [2, 2, 2]],
            [[0, 0, 0], [1, 0, 1], [2, 0, 2]]]
)");
  ASSERT_EQ(scene.surfaces.size(), 1u);
  EXPECT_EQ(mesh(scene, "floor").facets.size(), 1u);
  ASSERT_EQ(scene.losses.size(), 2u);
  EXPECT_NE(scene.losses[0].find("surface 'line' has no area"), std::string::npos);
  EXPECT_NE(scene.losses[1].find("and 1 more of the surface were left out"), std::string::npos)
      << scene.losses[1];
}

TEST(ReadToml, MeshesComeWithTheirMaterialsUnlessReplaced) {
  const Scene& s = everything();
  EXPECT_EQ(material_of(s, "block").name, "door");
  EXPECT_NEAR(volume(mesh(s, "block")), -0.3 * 0.3 * 0.3, 1e-9) << "turned over";
  EXPECT_EQ(material_of(s, "model/box (wall)").name, "wall");
  EXPECT_TRUE(material_of(s, "model/box (wall)").one_sided) << "the scene's wall, not the file's";
  EXPECT_EQ(material_of(s, "model/fittings/right (lamp)").name, "lamp (room.obj)");
  for (const std::string& note : s.notes) {
    EXPECT_EQ(note.find("block"), std::string::npos)
        << "its lack of materials is no news: " << note;
  }
  EXPECT_EQ(s.dropped_polygons, 1) << "of the model: one without area";
}

TEST(ReadToml, CamerasAreNormalisedAndNamed) {
  const Scene& s = everything();
  ASSERT_EQ(s.cameras.size(), 2u);
  const Camera& first = s.cameras[0];
  EXPECT_EQ(first.name, "entrance");
  EXPECT_TRUE(first.position.isApprox(Eigen::Vector3d(0.2, 0.2, 1.6)));
  EXPECT_TRUE(first.direction.isApprox(Eigen::Vector3d(2.3, 1.8, -0.6).normalized()));
  EXPECT_NEAR(first.up.norm(), 1.0, 1e-12);
  EXPECT_NEAR(first.up.dot(first.direction), 0.0, 1e-12);
  EXPECT_GT(first.up.z(), 0.9);
  EXPECT_EQ(first.width, 320);
  EXPECT_EQ(first.height, 240);
  EXPECT_DOUBLE_EQ(first.fov_degrees, 70.0);
  EXPECT_EQ(s.cameras[1].name, "camera2");
  EXPECT_EQ(s.cameras[1].direction, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(s.cameras[1].up, Eigen::Vector3d::UnitY());
  EXPECT_EQ(s.cameras[1].width, 512);
}

TEST(ReadToml, UnusedMaterialsAreNoted) {
  const Scene s = read_text("[materials.white]\n[materials.grey]\npower = 5\n" + one_polygon);
  ASSERT_EQ(s.notes.size(), 1u);
  EXPECT_NE(s.notes[0].find("'grey'"), std::string::npos);
}

class SpectralBandCount : public testing::TestWithParam<int> {};

TEST_P(SpectralBandCount, CutsASpectrumWithoutLosingAny) {
  const int count = GetParam();
  const std::string text = "[bands]\nkind = \"spectral\"\ncount = " + std::to_string(count) +
                           "\n[materials.white]\nexitance = { wavelengths = [400, 500, 600, 700], "
                           "values = [0.0, 8.0, 15.6, 18.4], per = \"nm\" }\n" +
                           one_polygon;
  const Scene s = read_text(text);
  ASSERT_EQ(s.bands.count(), count);
  // The integral of the piecewise linear spectrum is 100 nm times (4 + 11.8 + 17).
  EXPECT_NEAR(s.materials[0].emission.cast<double>().sum(), 3280.0, 3280.0 * 1e-6);
}
INSTANTIATE_TEST_SUITE_P(Bands, SpectralBandCount, testing::Values(1, 3, 7, 30, 96));

TEST(ReadToml, StepAndCountMeanTheSameBands) {
  const std::string rest = "[materials.white]\nreflectance = 0.5\n" + one_polygon;
  const Scene by_step =
      read_text("[bands]\nkind = \"spectral\"\nfrom = 380\nto = 730\nstep = 10\n" + rest);
  const Scene by_count =
      read_text("[bands]\nkind = \"spectral\"\nfrom = 380\nto = 730\ncount = 35\n" + rest);
  EXPECT_EQ(by_step.bands.names, by_count.bands.names);
  EXPECT_EQ(scene_hash(by_step), scene_hash(by_count));
}

TEST(ReadToml, ReadsFilesWithByteOrderMarkAndWindowsLineEnds) {
  std::string text = "\xef\xbb\xbf[materials.white]\nreflectance = 0.5\n" + one_polygon, windows;
  for (char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read_text(windows).surfaces.size(), 1u);
}

TEST(ReadToml, TheExtensionMayBeInCapitals) {
  const TemporaryFolder folder;
  const auto path = folder.write("capitals.TOML", "[materials.white]\n" + one_polygon);
  EXPECT_EQ(read_scene(path).surfaces.size(), 1u);
}

TEST(SceneFormatPage, ItsExampleIsAScene) {
  std::ifstream page(LIGHTWELL_DOCS "/scene-format.md");
  std::string text, line;
  while (std::getline(page, line) && line != "```toml") {
  }
  while (std::getline(page, line) && line != "```") text += line + "\n";
  ASSERT_FALSE(text.empty());
  const Scene s = read_text(text);
  EXPECT_TRUE(s.notes.empty());
  EXPECT_EQ(s.surfaces.size(), 7u);
  EXPECT_EQ(s.cameras.size(), 1u);
  // The panel emits 12 W from 1 m^2. Floor and ceiling close the room, which faces inwards.
  expect_spectrum(material_of(s, "panel").emission, {12, 12, 11});
  const double shell = volume(mesh(s, "floor")) + volume(mesh(s, "ceiling")) +
                       volume(mesh(s, "panel")) + volume(mesh(s, "walls"));
  EXPECT_NEAR(shell, -4.0 * 3.0 * 2.5, 1e-9);
}

}  // namespace
}  // namespace lightwell::read_toml_test
