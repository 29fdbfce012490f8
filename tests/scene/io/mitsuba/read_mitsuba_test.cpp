#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/coat.h"
#include "scene/io/glossy.h"
#include "scene/optics.h"
#include "tests/scene/scene_file_test.h"
#include "tests/scene/scene_questions.h"

namespace lightwell::read_mitsuba_test {
namespace {

using test::area_of;
using test::has_loss;
using test::has_note;
using test::mesh_of;
using test::normal_of;
using test::notes_of;

constexpr double pi = std::numbers::pi;
const std::string square = R"(<shape type="rectangle"><bsdf type="diffuse"/></shape>)";

class Mitsuba : public test::SceneFileTest {
 protected:
  Scene read(const std::string& content) const {
    return read_file("scene.xml", "<scene version=\"3.0.0\">\n" + content + "</scene>");
  }
  // Material of a rectangle with this BSDF.
  Material material(const std::string& bsdf) const {
    return first_material(read("<shape type=\"rectangle\">" + bsdf + "</shape>"));
  }
  std::string error(const std::string& content) const {
    return message_of<InputError>([&] { read(content); });
  }
};

void expect_near(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double tolerance = 1e-12) {
  EXPECT_LT((a - b).norm(), tolerance) << a.transpose() << " is not " << b.transpose();
}

TEST(MitsubaFile, TheCornellBoxIsReadWhole) {
  const Scene scene = read_scene(LIGHTWELL_TEST_DATA "/scene/mitsuba/cornell-box.xml");
  EXPECT_EQ(scene.surfaces.size(), 8u);
  EXPECT_EQ(scene_facets(scene).size(), 6u + 2u * 6u);
  EXPECT_TRUE(scene.relative_units);
  const Surface& light = scene.surfaces.at(7);
  EXPECT_EQ(light.name, "Light");
  const Material& shining = scene.materials.at(static_cast<std::size_t>(light.material));
  const std::array radiance = {17.0f, 12.0f, 4.0f};
  for (int k = 0; k < 3; ++k)
    EXPECT_FLOAT_EQ(shining.emission[k], static_cast<float>(pi) * radiance[k]);
  EXPECT_FALSE(shining.emits_both_sides);
  expect_near(normal_of(scene, 7), {0, -1, 0}, 1e-6);  // six digits in the file
  EXPECT_NEAR(area_of(mesh_of(scene, 7)), 4 * 0.235 * 0.19, 1e-6);
  // Five sides of a cube of edge 2 about (0, 1, 0), at distance 1 from the centre. Some of the
  // file's matrices turn the front outwards, which has no effect on two-sided materials.
  const Eigen::Vector3d middle(0, 1, 0);
  for (std::size_t wall = 0; wall < 5; ++wall) {
    EXPECT_NEAR(area_of(mesh_of(scene, wall)), 4.0, 1e-5);
    const double distance = normal_of(scene, wall).dot(middle - mesh_of(scene, wall).vertices[0]);
    EXPECT_NEAR(std::abs(distance), 1.0, 1e-6);
  }
  expect_near(normal_of(scene, 0), {0, 1, 0}, 1e-6);
  expect_near(normal_of(scene, 2), {0, 0, -1}, 1e-6);
  for (const Material& material : scene.materials) EXPECT_FALSE(material.one_sided);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_DOUBLE_EQ(scene.cameras[0].fov_degrees, 19.5);
  EXPECT_EQ(scene.cameras[0].width, 1024);
  expect_near(scene.cameras[0].position, {0, 1, 6.8});
  expect_near(scene.cameras[0].direction, {0, 0, -1});
  expect_near(scene.cameras[0].up, {0, 1, 0});
  EXPECT_TRUE(has_note(scene, "path_guiding_integrator"));
}

TEST_F(Mitsuba, BothDialectsSayTheSame) {
  const auto scene = [&](const char* version, const char* to_world, const char* int_ior,
                         const char* fov_axis) {
    return read_scene(folder.write(
        "dialect.xml",
        std::string("<scene version='") + version +
            "'><sensor type='perspective'><float name='fov' value='50'/><string name='" + fov_axis +
            "' value='y'/><transform name='" + to_world +
            "'><lookat origin='1,2,3' target='0,0,0' up='0,1,0'/></transform></sensor>"
            "<shape type='sphere'><transform name='" +
            to_world + "'><scale value='2'/></transform><bsdf type='dielectric'><float name='" +
            int_ior + "' value='1.7'/></bsdf></shape></scene>"));
  };
  const Scene old = scene("0.6.0", "toWorld", "intIOR", "fovAxis");
  const Scene recent = scene("3.0.0", "to_world", "int_ior", "fov_axis");
  EXPECT_EQ(scene_hash(old), scene_hash(recent));
  EXPECT_EQ(old.cameras.at(0).fov_degrees, recent.cameras.at(0).fov_degrees);
  EXPECT_DOUBLE_EQ(std::get<Sphere>(old.surfaces.at(0).shape).radius, 2.0);
}

TEST_F(Mitsuba, TransformationsApplyInTheirOrder) {
  const Scene scene = read(R"(<shape type="rectangle"><transform name="to_world">
      <scale x="2"/><rotate z="1" angle="90"/><translate x="10"/></transform></shape>)");
  // (1, -1, 0) -> (2, -1, 0) -> (1, 2, 0) -> (11, 2, 0)
  expect_near(mesh_of(scene).vertices.at(1), {11, 2, 0});
  EXPECT_NEAR(area_of(mesh_of(scene)), 8.0, 1e-12);
}

TEST_F(Mitsuba, LookAtAndItsMatrixAreOneCamera) {
  const std::string sensor = R"(<sensor type="perspective"><transform name="to_world">)";
  const Scene scene =
      read(square + sensor +
           R"(<lookat origin="0,0,5" target="0,0,0" up="0,1,0"/></transform></sensor>)" + sensor +
           R"(<matrix value="-1 0 0 0 0 1 0 0 0 0 -1 5 0 0 0 1"/></transform></sensor>)");
  ASSERT_EQ(scene.cameras.size(), 2u);
  expect_near(scene.cameras[0].direction, scene.cameras[1].direction);
  expect_near(scene.cameras[0].up, scene.cameras[1].up);
  expect_near(scene.cameras[0].position, {0, 0, 5});
}

TEST_F(Mitsuba, OrthographicSensorsAreTwoScaledUnitsWide) {
  const Scene scene = read(square + R"(<sensor type="orthographic"><transform name="to_world">
      <scale x="10" y="10"/><lookat origin="1,1,1" target="1,2,1" up="0,0,1"/></transform>
      <float name="near_clip" value="0.5"/><film type="hdrfilm"><integer name="width" value="200"/>
      <integer name="height" value="100"/></film></sensor>)");
  const Camera& camera = scene.cameras.at(0);
  EXPECT_EQ(camera.projection, Projection::orthographic);
  EXPECT_DOUBLE_EQ(camera.view_width, 20.0);
  EXPECT_DOUBLE_EQ(camera.near_distance, 0.5);
  expect_near(camera.direction, {0, 1, 0});
}

TEST_F(Mitsuba, CropWindowsAndPrincipalPointsAreRead) {
  const Scene scene = read(square + R"(<sensor type="perspective"><float name="fov" value="60"/>
      <float name="principal_point_offset_x" value="0.1"/>
      <float name="principal_point_offset_y" value="0.2"/>
      <film type="hdrfilm"><integer name="width" value="200"/><integer name="height" value="100"/>
      <integer name="crop_offset_x" value="50"/><integer name="crop_offset_y" value="20"/>
      <integer name="crop_width" value="80"/><integer name="crop_height" value="60"/></film>
      </sensor>)");
  const Camera& camera = scene.cameras.at(0);
  EXPECT_EQ(camera.width, 80);
  EXPECT_EQ(camera.height, 60);
  EXPECT_DOUBLE_EQ(camera.window.left, 0.25);
  EXPECT_DOUBLE_EQ(camera.window.bottom, 0.8);
  EXPECT_EQ(camera.shift, Eigen::Vector2d(0.1, -0.2));
}

// tan(h/2) / tan(v/2) = width / height; 50 mm before a film of diagonal sqrt(36^2 + 24^2) mm.
TEST_F(Mitsuba, FieldsOfViewBecomeHorizontalOnes) {
  const auto tangent = [&](const std::string& properties) {
    const Scene scene = read(square + "<sensor type=\"perspective\">" + properties +
                             R"(<film type="hdrfilm"><integer name="width" value="200"/>
                                <integer name="height" value="100"/></film></sensor>)");
    return std::tan(scene.cameras.at(0).fov_degrees * pi / 360.0);
  };
  const std::string right_angle = R"(<float name="fov" value="90"/>)";
  const auto axis = [](const std::string& name) {
    return R"(<string name="fov_axis" value=")" + name + "\"/>";
  };
  EXPECT_NEAR(tangent(right_angle), 1.0, 1e-12);
  EXPECT_NEAR(tangent(right_angle + axis("y")), 2.0, 1e-12);
  EXPECT_NEAR(tangent(right_angle + axis("smaller")), 2.0, 1e-12);
  EXPECT_NEAR(tangent(right_angle + axis("larger")), 1.0, 1e-12);
  EXPECT_NEAR(tangent(right_angle + axis("diagonal")), 2.0 / std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(tangent(""), 0.5 * std::hypot(36, 24) / 50.0 * 2.0 / std::sqrt(5.0), 1e-12);
}

TEST_F(Mitsuba, MirroredShapesKeepTheirFront) {
  const auto mirrored = [&](const char* type, const char* more) {
    return read(std::string("<shape type='") + type +
                "'><transform name='to_world'><scale x='-1'/></transform>" + more + "</shape>");
  };
  expect_near(normal_of(mirrored("rectangle", "")), {0, 0, 1});
  expect_near(normal_of(mirrored("disk", "")), {0, 0, 1});
  expect_near(normal_of(mirrored("rectangle", "<boolean name='flip_normals' value='true'/>")),
              {0, 0, -1});
  const Scene cube = mirrored("cube", "");
  for (const Facet& facet : mesh_of(cube).facets) {
    EXPECT_GT(facet_normal(mesh_of(cube), facet).dot(mesh_of(cube).vertices[facet.boundary[0]]),
              0.9);
  }
}

// The normals of a mesh define its front; without normals the order of the corners does.
TEST_F(Mitsuba, NormalsOfAMeshTellItsFront) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  folder.write("plain.obj", corners + "f 1 2 3\n");
  folder.write("down.obj", corners + "vn 0 0 -1\nf 1//1 2//1 3//1\n");
  const auto up = [&](const std::string& file, const std::string& more) {
    return normal_of(read("<shape type=\"obj\"><string name=\"filename\" value=\"" + file + "\"/>" +
                          more + "<bsdf type=\"diffuse\"/></shape>"))
        .z();
  };
  const std::string mirror = R"(<transform name="to_world"><scale x="-1"/></transform>)";
  EXPECT_EQ(up("plain.obj", ""), 1.0);
  EXPECT_EQ(up("plain.obj", mirror), -1.0);
  EXPECT_EQ(up("down.obj", ""), -1.0);
  EXPECT_EQ(up("down.obj", mirror), -1.0);
  EXPECT_EQ(up("down.obj", R"(<boolean name="face_normals" value="true"/>)"), 1.0);
}

TEST_F(Mitsuba, RoundShapesKeepTheirArea) {
  const std::string stretched = R"(<transform name="to_world"><scale value="3"/></transform>)";
  EXPECT_NEAR(area_of(mesh_of(read("<shape type='disk'>" + stretched + "</shape>"))), 9 * pi, 1e-9);
  const std::string tube = R"(<shape type="cylinder"><point name="p0" x="1"/>
      <point name="p1" x="1" y="2"/><float name="radius" value="0.5"/></shape>)";
  EXPECT_NEAR(area_of(mesh_of(read(tube))), 2 * pi * 0.5 * 2, 1e-9);
  // A sphere turned inside out is a polygon mesh with normals towards its centre.
  const Scene hollow = read(R"(<shape type="sphere"><float name="radius" value="2"/>
      <boolean name="flip_normals" value="true"/></shape>)");
  EXPECT_NEAR(area_of(mesh_of(hollow)), 16 * pi, 1e-9);
  EXPECT_LT(normal_of(hollow).dot(mesh_of(hollow).vertices[mesh_of(hollow).facets[0].boundary[0]]),
            0.0);
  const Scene ball =
      read(R"(<shape type="sphere"><point name="center" x="1"/><transform name="to_world">
      <rotate y="1" angle="30"/><scale value="2"/></transform></shape>)");
  const auto& sphere = std::get<Sphere>(ball.surfaces.at(0).shape);
  EXPECT_NEAR(sphere.radius, 2.0, 1e-12);
  expect_near(sphere.center, {2 * std::cos(pi / 6), 0, -2 * std::sin(pi / 6)});
}

TEST_F(Mitsuba, InstancesPlaceTheirGroup) {
  const Scene scene = read(R"(
      <shape type="shapegroup" id="pair">
        <shape type="rectangle" id="one"/>
        <shape type="rectangle" id="two"><transform name="to_world"><translate z="1"/></transform></shape>
      </shape>
      <shape type="instance" id="here"><ref id="pair"/></shape>
      <shape type="instance" id="there"><ref id="pair"/>
        <transform name="to_world"><translate x="5"/></transform></shape>)");
  ASSERT_EQ(scene.surfaces.size(), 4u);
  EXPECT_EQ(scene.surfaces[3].name, "there/two");
  expect_near(mesh_of(scene, 3).vertices.at(0), {4, -1, 1});
  EXPECT_EQ(scene.surfaces[1].material, scene.surfaces[3].material);
}

TEST_F(Mitsuba, OneSidedUnlessTheFileSaysTwosided) {
  EXPECT_TRUE(material(R"(<bsdf type="diffuse"/>)").one_sided);
  EXPECT_FALSE(material(R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>)").one_sided);
  EXPECT_TRUE(material(R"(<bsdf type="bumpmap"><bsdf type="diffuse"/></bsdf>)").one_sided);
  EXPECT_FALSE(
      material(R"(<bsdf type="mask"><bsdf type="twosided"><bsdf type="plastic"/></bsdf></bsdf>)")
          .one_sided);
}

TEST_F(Mitsuba, MetalsAndGlassKeepTheirGloss) {
  const Material chrome = material(R"(<bsdf type="conductor"><rgb name="eta" value="1.5"/>
      <rgb name="k" value="0"/><rgb name="specular_reflectance" value="0.5"/></bsdf>)");
  EXPECT_NEAR(mean_mirrored(chrome)[1], 0.5 * diffuse_fresnel(1.5), 1e-7);
  EXPECT_FLOAT_EQ(
      material(R"(<bsdf type="conductor"><string name="material" value="none"/></bsdf>)")
          .specular[0],
      1.0f);
  const Material brushed = material(R"(<bsdf type="roughconductor"><float name="alpha" value="0.4"/>
      <string name="material" value="none"/></bsdf>)");
  EXPECT_FLOAT_EQ(brushed.specular[0], 1.0f);
  EXPECT_FLOAT_EQ(brushed.specular_roughness, 0.4f);
  const Material matt = material(R"(<bsdf type="roughconductor"><float name="alpha" value="0.6"/>
      <string name="material" value="none"/></bsdf>)");
  EXPECT_FLOAT_EQ(matt.reflectance[0], 1.0f);
  EXPECT_FALSE(matt.is_specular());
  const Material frosted =
      material(R"(<bsdf type="roughdielectric"><float name="alpha" value="0.7"/></bsdf>)");
  EXPECT_FLOAT_EQ(frosted.dielectric.value().roughness, 0.7f);
  const Material water = material(R"(<bsdf type="dielectric"><string name="int_ior" value="water"/>
      <float name="ext_ior" value="1"/></bsdf>)");
  ASSERT_TRUE(water.dielectric.has_value());
  EXPECT_FLOAT_EQ(water.dielectric->index_of_refraction, 1.333f);
  const Material pane = material(R"(<bsdf type="thindielectric"><float name="int_ior" value="1.5"/>
      <float name="ext_ior" value="1"/></bsdf>)");
  ASSERT_TRUE(pane.dielectric.has_value());
  EXPECT_TRUE(pane.dielectric->thin);
  EXPECT_FLOAT_EQ(pane.dielectric->index_of_refraction, 1.5f);
  EXPECT_FLOAT_EQ(pane.dielectric->tint[0], 1.0f);
}

TEST_F(Mitsuba, PlasticsAreCoatsOverABase) {
  const Material plastic =
      material(R"(<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.8"/>
      <float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/>
      <boolean name="nonlinear" value="true"/></bsdf>)");
  ASSERT_TRUE(plastic.coat);
  EXPECT_FLOAT_EQ(plastic.coat->index_of_refraction, 1.5f);
  EXPECT_FLOAT_EQ(plastic.reflectance[0],
                  CoatOverBase(plastic).reflectance(Spectrum::Constant(3, 0.8f))[0]);
  EXPECT_FLOAT_EQ(plastic.specular_roughness, 0.0f);
  const Material rough = material(R"(<bsdf type="roughplastic"><float name="alpha" value="0.3"/>
      <rgb name="specular_reflectance" value="0.5"/></bsdf>)");
  ASSERT_TRUE(rough.coat);
  EXPECT_FLOAT_EQ(rough.specular_roughness, 0.3f);
  EXPECT_FLOAT_EQ(rough.specular[0], 0.5f);
  EXPECT_FLOAT_EQ(rough.reflectance[0],
                  CoatOverBase(rough, false).reflectance(Spectrum::Constant(3, 0.5f))[0]);
}

// The light passes the coating's body of sigma 0.5 and thickness 0.2 twice.
TEST_F(Mitsuba, CoatingsCoverDiffuseSurfaces) {
  const Material varnish = material(R"(<bsdf type="roughcoating"><float name="alpha" value="0.2"/>
      <float name="int_ior" value="1.6"/><float name="ext_ior" value="1"/>
      <float name="thickness" value="0.2"/><rgb name="sigma_a" value="0.5"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf></bsdf>)");
  ASSERT_TRUE(varnish.coat);
  EXPECT_FLOAT_EQ(varnish.coat->index_of_refraction, 1.6f);
  EXPECT_FLOAT_EQ(varnish.specular_roughness, 0.2f);
  const auto base = static_cast<float>(0.6 * std::exp(-0.2));
  EXPECT_FLOAT_EQ(varnish.reflectance[0],
                  CoatOverBase(varnish).reflectance(Spectrum::Constant(3, base))[0]);
  const Material gold = material(R"(<bsdf type="coating"><bsdf type="conductor">
      <string name="material" value="none"/></bsdf></bsdf>)");
  EXPECT_FALSE(gold.coat);
  EXPECT_FLOAT_EQ(gold.specular[0], 1.0f);
}

TEST_F(Mitsuba, BlendsKeepTheBrighterGloss) {
  const std::string plastic =
      R"(<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.8"/></bsdf>)";
  const Material alone = material(plastic);
  const Material twice = material(R"(<bsdf type="blendbsdf"><float name="weight" value="0.5"/>)" +
                                  plastic + plastic + "</bsdf>");
  ASSERT_TRUE(twice.coat);
  EXPECT_FLOAT_EQ(twice.reflectance[0], alone.reflectance[0]);
  EXPECT_FLOAT_EQ(twice.specular[0], 1.0f);
  const Material with_metal = material(
      R"(<bsdf type="blendbsdf"><float name="weight" value="0.5"/><bsdf type="conductor">
      <string name="material" value="none"/></bsdf>)" +
      plastic + "</bsdf>");
  EXPECT_FALSE(with_metal.coat);
  EXPECT_FLOAT_EQ(with_metal.specular[0], 0.5f);
}

TEST_F(Mitsuba, HighlightsOfPhongAndWardAreKept) {
  const Material phong =
      material(R"(<bsdf type="phong"><rgb name="diffuse_reflectance" value="0.5"/>
      <rgb name="specular_reflectance" value="0.2"/><float name="exponent" value="198"/></bsdf>)");
  EXPECT_FLOAT_EQ(phong.specular[0], 0.2f);
  EXPECT_FLOAT_EQ(phong.specular_roughness, 0.1f);
  const Material ward = material(R"(<bsdf type="ward"><rgb name="diffuse_reflectance" value="0.9"/>
      <rgb name="specular_reflectance" value="0.2"/><float name="alpha_u" value="0.15"/>
      <float name="alpha_v" value="0.05"/></bsdf>)");
  EXPECT_FLOAT_EQ(ward.specular[0], 0.1f);  // what the diffuse share leaves
  EXPECT_FLOAT_EQ(ward.specular_roughness, 0.15f);
}

// The default `specular` of 0.5 stands for a reflectance of 0.04 at normal incidence, index 1.5.
TEST_F(Mitsuba, PrincipledDielectricsHaveACoat) {
  const Material wood = material(R"(<bsdf type="principled"><rgb name="base_color" value="0.5"/>
      <float name="roughness" value="0.4"/></bsdf>)");
  ASSERT_TRUE(wood.coat);
  EXPECT_NEAR(wood.coat->index_of_refraction, 1.5, 1e-6);
  EXPECT_FLOAT_EQ(wood.specular_roughness, 0.16f);
  EXPECT_FALSE(material(R"(<bsdf type="principled"><float name="metallic" value="1"/>
      <float name="roughness" value="0.4"/></bsdf>)")
                   .coat);
}

TEST_F(Mitsuba, ColoursComeInEveryForm) {
  const auto reflectance = [&](const std::string& value) {
    return material("<bsdf type=\"diffuse\">" + value + "</bsdf>").reflectance;
  };
  EXPECT_FLOAT_EQ(reflectance(R"(<rgb name="reflectance" value="0.1, 0.2 0.3"/>)")[2], 0.3f);
  EXPECT_FLOAT_EQ(reflectance(R"(<spectrum name="reflectance" value="0.4"/>)")[1], 0.4f);
  EXPECT_FLOAT_EQ(reflectance(R"(<float name="reflectance" value="0.25"/>)")[0], 0.25f);
  // 128/255 = 0.50196 -> 0.21586 (IEC 61966-2-1).
  EXPECT_NEAR(reflectance(R"(<srgb name="reflectance" value="#8000ff"/>)")[0], 0.21586, 1e-5);
  // A ramp from 0 at 400 nm to 0.6 at 700 nm: means over 600-700, 500-600 and 400-500 nm.
  const Spectrum ramp = reflectance(R"(<spectrum name="reflectance" value="400:0, 700:0.6"/>)");
  EXPECT_NEAR(ramp[0], 0.5, 1e-6);
  EXPECT_NEAR(ramp[1], 0.3, 1e-6);
  EXPECT_NEAR(ramp[2], 0.1, 1e-6);
  const Spectrum checks = reflectance(R"(<texture type="checkerboard" name="reflectance">
      <rgb name="color0" value="0.2"/><rgb name="color1" value="0.6"/></texture>)");
  EXPECT_FLOAT_EQ(checks[0], 0.4f);
}

TEST_F(Mitsuba, PicturesBecomeTheirMeanColour) {
  std::filesystem::copy(LIGHTWELL_TEST_DATA "/scene/two-pixels.png", folder / "my picture.png");
  const std::string picture = R"(<texture type="bitmap" name="reflectance">
      <string name="filename" value="my picture.png"/></texture>)";
  const std::string opacity = R"(<texture type="bitmap" name="opacity">
      <string name="filename" value="my picture.png"/></texture>)";
  EXPECT_FLOAT_EQ(material("<bsdf type='diffuse'>" + picture + "</bsdf>").reflectance[0], 0.5f);
  // A mask cuts away the black, transparent half.
  EXPECT_FLOAT_EQ(material("<bsdf type='mask'>" + opacity + "<bsdf type='diffuse'>" + picture +
                           "</bsdf></bsdf>")
                      .reflectance[0],
                  1.0f);
}

TEST_F(Mitsuba, NormalAndBumpMapsAreRelief) {
  for (const char* name : {"normals.png", "heights.png"}) {
    std::filesystem::copy(std::filesystem::path(LIGHTWELL_TEST_DATA "/scene") / name,
                          folder / name);
  }
  const auto relief = [&](const std::string& plugin, const std::string& picture,
                          const std::string& more = "") {
    return material("<bsdf type='" + plugin + "'><texture type='bitmap' name='t'><string " +
                    "name='filename' value='" + picture + "'/><boolean name='raw' value='true'/>" +
                    "</texture>" + more + "<bsdf type='diffuse'/></bsdf>")
        .relief;
  };
  const auto normals = relief("normalmap", "normals.png");
  ASSERT_TRUE(normals);
  EXPECT_NEAR(normals->steepest, 76.0 / 102.0, 1e-4);
  const auto heights = relief("bumpmap", "heights.png", "<float name='scale' value='0.02'/>");
  ASSERT_TRUE(heights);
  EXPECT_TRUE(heights->is_in_metres);
  EXPECT_EQ(heights->scale, 0.02);
  EXPECT_FALSE(relief("normalmap", "heights.png"));
  EXPECT_FALSE(relief("bumpmap", "gone.png"));
}

TEST_F(Mitsuba, ConductorsReflectByAngle) {
  const Material metal = material(
      "<bsdf type='roughconductor'><rgb name='eta' value='0.2, 0.9, 1.1'/><rgb name='k' "
      "value='3.9, "
      "2.5, 2.1'/><rgb name='specular_reflectance' value='0.5'/></bsdf>");
  ASSERT_TRUE(metal.metal);
  EXPECT_FLOAT_EQ(metal.metal->k[2], 2.1f);
  EXPECT_FLOAT_EQ(metal.specular[0], 0.5f);
  EXPECT_FLOAT_EQ(metal.specular_roughness, 0.1f);
}

TEST_F(Mitsuba, AMaskCutsOnlyWhereItIs) {
  std::filesystem::copy(LIGHTWELL_TEST_DATA "/scene/two-pixels.png", folder / "leaf.png");
  const std::string leaf = R"(<bsdf type="diffuse" id="leaf"><texture type="bitmap"
      name="reflectance"><string name="filename" value="leaf.png"/></texture></bsdf>)";
  const std::string masked =
      R"(<shape type="cube"><bsdf type="mask"><texture type="bitmap" name="opacity">
      <string name="filename" value="leaf.png"/></texture><ref id="leaf"/></bsdf></shape>)";
  const std::string whole = R"(<shape type="cube"><ref id="leaf"/></shape>)";
  const auto reflectance = [](const Scene& scene, std::size_t surface) {
    const auto m = static_cast<std::size_t>(scene.surfaces.at(surface).material);
    return scene.materials.at(m).reflectance[0];
  };
  const Scene one_way = read(leaf + masked + whole), other_way = read(leaf + whole + masked);
  EXPECT_FLOAT_EQ(reflectance(one_way, 0), 1.0f);
  EXPECT_FLOAT_EQ(reflectance(one_way, 1), 0.5f);
  EXPECT_FLOAT_EQ(reflectance(other_way, 0), 0.5f);
  EXPECT_FLOAT_EQ(reflectance(other_way, 1), 1.0f);
}

// With an opacity of 0.6, 0.6 of the plastic stays and 0.4 of the light passes straight on.
TEST_F(Mitsuba, AMaskOfAnEvenOpacityLetsTheRestThrough) {
  const std::string plastic =
      R"(<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.5"/></bsdf>)";
  const Material whole = material(plastic);
  const auto masked = [&](const std::string& opacity, const std::string& inner) {
    return material("<bsdf type='mask'>" + opacity + inner + "</bsdf>");
  };
  const Material gauze = masked("<float name='opacity' value='0.6'/>", plastic);
  EXPECT_FLOAT_EQ(gauze.reflectance[0], 0.6f * whole.reflectance[0]);
  EXPECT_FLOAT_EQ(gauze.specular[0], 0.6f);
  EXPECT_FLOAT_EQ(gauze.regular_transmittance[0], 0.4f);
  EXPECT_FALSE(gauze.one_sided || gauze.mask);
  EXPECT_FLOAT_EQ(masked("", plastic).regular_transmittance[0], 0.5f);  // Mitsuba's default
  const Material tinted = masked("<rgb name='opacity' value='0.25, 0.5, 1'/>", plastic);
  EXPECT_FLOAT_EQ(tinted.regular_transmittance[0], 0.75f);
  EXPECT_FLOAT_EQ(tinted.regular_transmittance[2], 0.0f);
  const std::string half = "<float name='opacity' value='0.5'/>";
  EXPECT_TRUE(masked(half, "<bsdf type='dielectric'/>").dielectric);
  const Scene lamp = read("<shape type='rectangle'><bsdf type='mask'>" + half + plastic +
                          "</bsdf><emitter type='area'/></shape>");
  EXPECT_FALSE(first_material(lamp).passes_straight());
  EXPECT_TRUE(has_loss(lamp, "Lamps let no light straight through"));
}

// Two texels of alpha 0.2 and 0.6: neither clear nor opaque.
TEST_F(Mitsuba, APictureOfGauzeIsAMaskOfItsMeanOpacity) {
  std::filesystem::copy(LIGHTWELL_TEST_DATA "/scene/gauze.png", folder / "gauze.png");
  const Material gauze = material(R"(<bsdf type="mask"><texture type="bitmap" name="opacity">
      <string name="filename" value="gauze.png"/></texture><bsdf type="diffuse"/></bsdf>)");
  EXPECT_FALSE(gauze.mask);
  // Texels have 16 bits, of the square root: steps of 2e-5 here.
  EXPECT_NEAR(gauze.regular_transmittance[0], 0.6f, 2e-5f);
}

TEST_F(Mitsuba, DiffuseTransmittersPassTheirTransmittance) {
  const Material paper = material(
      R"(<bsdf type="difftrans"><rgb name="transmittance" value="0.6, 0.5, 0.4"/></bsdf>)");
  EXPECT_FLOAT_EQ(paper.transmittance[0], 0.6f);
  EXPECT_FLOAT_EQ(paper.transmittance[2], 0.4f);
  EXPECT_FALSE((paper.reflectance > 0.0f).any() || paper.one_sided);
  EXPECT_FLOAT_EQ(material(R"(<bsdf type="difftrans"/>)").transmittance[0], 0.5f);
  const Material both = material(R"(<bsdf type="twosided"><bsdf type="difftrans"/></bsdf>)");
  EXPECT_FLOAT_EQ(both.transmittance[0], 0.5f);
}

// A leaf: 0.7 of its mixture reflects 0.4, and 0.3 passes 0.5.
TEST_F(Mitsuba, BlendsPassTheMeanOfTheirParts) {
  const Material leaf = material(R"(<bsdf type="blendbsdf"><float name="weight" value="0.3"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.4"/></bsdf>
      <bsdf type="difftrans"/></bsdf>)");
  EXPECT_FLOAT_EQ(leaf.reflectance[0], 0.7f * 0.4f);
  EXPECT_FLOAT_EQ(leaf.transmittance[0], 0.3f * 0.5f);
  const Material net = material(R"(<bsdf type="blendbsdf"><float name="weight" value="0.75"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.4"/></bsdf>
      <bsdf type="null"/></bsdf>)");
  EXPECT_FLOAT_EQ(net.reflectance[0], 0.1f);
  EXPECT_FLOAT_EQ(net.regular_transmittance[0], 0.75f);
  // Weights of 2 in all: everything that arrives leaves, as much to either side.
  const Material twice = material(R"(<bsdf type="mixturebsdf"><string name="weights" value="1, 1"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="1"/></bsdf>
      <bsdf type="difftrans"><rgb name="transmittance" value="1"/></bsdf></bsdf>)");
  EXPECT_FLOAT_EQ(twice.reflectance[0], 0.5f);
  EXPECT_FLOAT_EQ(twice.transmittance[0], 0.5f);
}

TEST_F(Mitsuba, ANullBsdfLetsAllLightThrough) {
  const Material null = material(R"(<bsdf type="null"/>)");
  EXPECT_FLOAT_EQ(null.regular_transmittance[0], 1.0f);
  EXPECT_FALSE(null.dielectric || null.is_diffuse());
}

// The light passes the coating's body once on either side, as reflected light passes it twice.
TEST_F(Mitsuba, CoatingsCoverBothSidesOfASheet) {
  const Material opal = material(R"(<bsdf type="coating"><float name="thickness" value="0.2"/>
      <rgb name="sigma_a" value="0.5"/><bsdf type="difftrans"/></bsdf>)");
  const auto tau = static_cast<float>(0.5 * std::exp(-0.2));
  const CoatOverBase coat(opal);
  EXPECT_FLOAT_EQ(opal.transmittance[0], 0.5f * (coat.reflectance(Spectrum::Constant(3, tau))[0] -
                                                 coat.reflectance(Spectrum::Constant(3, -tau))[0]));
  EXPECT_TRUE(opal.coat);
}

TEST_F(Mitsuba, TexturesThatShareTheirPartsAreReadOnce) {
  // Without sharing, these would be 2^32 checkerboards.
  std::string boards = R"(<texture type="checkerboard" id="t0"/>)";
  for (int i = 1; i < 32; ++i) {
    boards += "<texture type='checkerboard' id='t" + std::to_string(i) + "'>";
    for (const char* color : {"color0", "color1"}) {
      boards += std::string("<ref name='") + color + "' id='t" + std::to_string(i - 1) + "'/>";
    }
    boards += "</texture>";
  }
  const Scene scene = read(boards + R"(<shape type="cube"><bsdf type="diffuse">
      <ref name="reflectance" id="t31"/></bsdf></shape>)");
  EXPECT_FLOAT_EQ(scene.materials.at(0).reflectance[0], 0.3f);  // mean of the defaults, 0.4 and 0.2
}

TEST_F(Mitsuba, TexturesOfANumberCountByTheirMean) {
  const auto metal = [&](const std::string& alpha) {
    return material("<bsdf type='roughconductor'>" + alpha + "</bsdf>").specular[0] > 0.0f;
  };
  const auto checks = [](const char* name, const char* color) {
    return std::string("<texture type='checkerboard' name='") + name + "'><float name='color0' " +
           "value='0'/><float name='color1' value='" + color + "'/></texture>";
  };
  EXPECT_TRUE(metal(""));  // alpha 0.1
  EXPECT_TRUE(metal(checks("alpha", "0.9")));
  EXPECT_FALSE(metal(checks("alpha", "1.1")));
  EXPECT_TRUE(metal("<spectrum name='alpha' value='0.45'/>"));
  EXPECT_FALSE(metal("<spectrum name='alpha' value='0.55'/>"));
  const auto principled = [&](const std::string& parts) {
    return material("<bsdf type='principled'>" + parts + "</bsdf>");
  };
  EXPECT_TRUE(principled(checks("spec_trans", "1")).dielectric.has_value());
  EXPECT_FALSE(principled(checks("spec_trans", "0.9")).dielectric.has_value());
  const std::string polished = "<float name='roughness' value='0.1'/>";
  EXPECT_FLOAT_EQ(principled(checks("metallic", "1") + polished).specular[0], 0.5f * 0.5f);
}

TEST_F(Mitsuba, AThinPrincipledSheetIsAPane) {
  const Material pane = material(R"(<bsdf type="principledthin">
      <rgb name="base_color" value="0.8"/><float name="spec_trans" value="1"/></bsdf>)");
  ASSERT_TRUE(pane.dielectric.has_value());
  EXPECT_TRUE(pane.dielectric->thin);
  EXPECT_FLOAT_EQ(pane.dielectric->tint[0], 0.8f);
  EXPECT_FLOAT_EQ(pane.dielectric->roughness, 0.25f);  // the square of Mitsuba's default
  const Material block = material(R"(<bsdf type="principled"><string name="eta" value="diamond"/>
      <float name="spec_trans" value="1"/></bsdf>)");
  EXPECT_FLOAT_EQ(block.dielectric.value().index_of_refraction, 2.419f);
}

// A diff_trans of 2 would pass all diffuse light. The default roughness 0.5 is an alpha of 0.25.
TEST_F(Mitsuba, AThinPrincipledSheetPassesLight) {
  const auto sheet = [&](const std::string& keys) {
    return material(R"(<bsdf type="principledthin"><rgb name="base_color" value="0.8"/>)" + keys +
                    "</bsdf>");
  };
  const std::string matt = R"(<float name="roughness" value="1"/>)";
  const Material paper = sheet(matt + R"(<float name="diff_trans" value="0.5"/>)");
  EXPECT_FLOAT_EQ(paper.reflectance[0], 0.8f * 0.75f);
  EXPECT_FLOAT_EQ(paper.transmittance[0], 0.8f * 0.25f);
  EXPECT_FALSE(paper.passes_straight());
  const std::string part =
      R"(<float name="diff_trans" value="1"/><float name="spec_trans" value="0.6"/>)";
  const Material frosted = sheet(matt + part);
  EXPECT_FLOAT_EQ(frosted.reflectance[0], 0.8f * 0.4f * 0.5f);
  EXPECT_FLOAT_EQ(frosted.transmittance[0], 0.8f * (0.4f * 0.5f + 0.6f));
  const Material foil = sheet(R"(<float name="roughness" value="0.1"/>)" + part);
  ASSERT_TRUE(foil.coat);
  const auto kept = static_cast<float>(1.0 - CoatedBase(foil).mean_mirrored());
  EXPECT_FLOAT_EQ(foil.regular_transmittance[0], kept * 0.8f * 0.6f);
  EXPECT_FLOAT_EQ(foil.transmittance[0], kept * 0.8f * 0.2f);
}

TEST_F(Mitsuba, DefaultsAndReferencesAndIncludesArePutInPlace) {
  folder.write("walls.xml", R"(<scene version="3.0.0"><bsdf type="diffuse" id="wall">
      <rgb name="reflectance" value="$shade"/></bsdf></scene>)");
  const Scene scene = read(R"(<default name="shade" value="0.3"/><default name="shade" value="0.9"/>
      <include filename="walls.xml"/><shape type="rectangle"><ref id="wall"/></shape>)");
  EXPECT_EQ(scene.materials.at(0).name, "wall");
  EXPECT_FLOAT_EQ(scene.materials.at(0).reflectance[0], 0.3f);  // the first one counts
}

TEST_F(Mitsuba, WhatIsNotKnownIsNamedOnceAndPassedOver) {
  const Scene scene = read(square + R"(<emitter type="sunsky"/><emitter type="sunsky"/>
      <integrator type="magic"/><shape type="hair"/><medium type="fog"/>
      <shape type="rectangle"><bsdf type="velvet"/></shape>)");
  EXPECT_EQ(scene.surfaces.size(), 2u);
  for (const char* name :
       {"'sunsky' give no light", "'magic'", "plugin 'hair'", "<medium", "'velvet'"}) {
    int times = 0;
    for (const std::string& note : scene.notes) times += note.find(name) != std::string::npos;
    EXPECT_EQ(times, 1) << name;
  }
  EXPECT_TRUE(has_note(scene, "the scene is dark"));
}

TEST_F(Mitsuba, FlattenedFacesAreDroppedWithACount) {
  const Scene scene = read(square + R"(<shape type="cube"><transform name="to_world">
      <scale z="0"/></transform></shape>)");
  EXPECT_EQ(mesh_of(scene, 1).facets.size(), 2u);
  EXPECT_EQ(scene.dropped_polygons, 4);
}

// The fourth corner is 1e-6 of the square's edge off the plane of the others: planar as given, but
// not after a scaling of the height by 1000.
TEST_F(Mitsuba, WhatAnUnevenScaleBendsIsSplit) {
  folder.write("tile.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1e-6\nf 1 2 3 4\n");
  const auto tile = [&](const std::string& scale) {
    return read(
        "<shape type='obj'><string name='filename' value='tile.obj'/><transform "
        "name='to_world'><scale " +
        scale + "/></transform><bsdf type='diffuse'/></shape>");
  };
  const Scene even = tile("value='1000'"), high = tile("z='1000'");
  EXPECT_EQ(mesh_of(even).facets.size(), 1u);
  EXPECT_EQ(mesh_of(high).facets.size(), 2u);
  EXPECT_TRUE(has_note(high, "1 polygon was not planar and was split"));
  // The order of the corners defines the front, mirrored or not.
  EXPECT_GT(normal_of(high).z(), 0.9);
  EXPECT_LT(normal_of(tile("x='-1' z='1000'")).z(), -0.9);
}

TEST_F(Mitsuba, MistakesAreToldWithTheirLine) {
  const auto expect = [&](const std::string& content, std::initializer_list<const char*> parts) {
    const std::string message = error(content);
    for (const char* part : parts) {
      EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
    }
  };
  expect("<shape type='rectangle'>", {"scene.xml:2:", "XML"});
  expect("<shape type='cube' id='a'/><shape type='cube' id='a'/>", {"the id 'a'"});
  expect(
      "<shape type='cube'><transform name='to_world'>\n<matrix value='nan 0 0 0 0 1 0 0 0 0 1 0 0 "
      "0 0 1'/>"
      "</transform></shape>",
      {"scene.xml:3:", "'nan'", "finite"});
  expect(
      "<shape type='cube'><transform name='to_world'><matrix value='1 2 3'/></transform></shape>",
      {"3 numbers", "16"});
  expect("<shape type='cube'><transform name='to_world'><scale value='0'/></transform></shape>",
         {"shrinks"});
  expect("<shape type='obj'><string name='filename' value='gone.obj'/></shape>",
         {"gone.obj", "Mesh files are missing"});
  expect("<shape type='sphere'><float name='radius' value='-1'/></shape>", {"radius -1"});
  expect("<shape type='sphere'>\n<string name='radius' value='2'/></shape>",
         {"scene.xml:3:", "<string> 'radius'", "is no number"});
  expect("<sensor type='perspective'><spectrum name='fov' value='40'/></sensor>",
         {"<spectrum> 'fov'", "is no number"});
  expect(
      "<shape type='cube'><bsdf type='diffuse'><rgb name='reflectance' "
      "value='$shade'/></bsdf></shape>",
      {"$shade", "<default>"});
  expect("<include filename='scene.xml'/>", {"includes"});
  expect("<shape type='instance'/>", {"shapegroup"});
  expect(
      "<default name='a' value='xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx'/>"
      "<default name='b' "
      "value='$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a$a'/>"
      "<default name='c' "
      "value='$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b$b'/>",
      {"grows beyond"});
  std::string deep;
  for (int i = 0; i < 10000; ++i) deep += "<bsdf type='mask'>";
  for (int i = 0; i < 10000; ++i) deep += "</bsdf>";
  expect(deep, {"nested more than"});
  expect("", {"no shapes"});
}

TEST_F(Mitsuba, MaterialsThatCannotBeReadBecomeGreyWithTheirPlace) {
  const auto noted = [&](const std::string& content, std::initializer_list<const char*> parts) {
    const Scene scene = read(content);
    EXPECT_FLOAT_EQ(first_material(scene).reflectance[1], 0.5f);
    for (const char* part : parts) {
      EXPECT_TRUE(says(notes_of(scene), part));
      EXPECT_TRUE(has_loss(scene, part));
    }
  };
  noted("\n<shape type='rectangle'><ref id='wal'/></shape><bsdf type='diffuse' id='wall'/>",
        {"scene.xml:3:", "'wal'", "Did you mean 'wall'?"});
  noted(
      "<bsdf type='bumpmap' id='a'><ref id='b'/></bsdf>\n<bsdf type='mask' id='b'><ref "
      "id='a'/></bsdf>"
      "<shape type='cube'><ref id='a'/></shape>",
      {"refers to itself"});
  noted(
      "<shape type='cube'><bsdf type='roughconductor'><string name='alpha' value='0.3'/></bsdf>"
      "</shape>",
      {"<string> 'alpha'", "is no number"});
  noted(
      "<shape type='cube'><bsdf type='diffuse'>"
      "<blackbody name='reflectance' temperature='0.5K'/></bsdf></shape>",
      {"0.5 K", "1 to 1e6"});
  noted(
      "<shape type='cube'><bsdf type='diffuse'><rgb name='reflectance' value='-1'/></bsdf></shape>",
      {"reflectance", "-1"});
}

// The case of a downloaded room: of hundreds of meshes some are missing, some have no area and some
// are torn, and so have pictures. The rest is a room.
TEST_F(Mitsuba, MissingAndDamagedFilesAreLeftOutOnceWithCounts) {
  folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  folder.write("torn.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n");
  folder.write("torn.png", "\x89PNG\r\n");
  std::string content = square;
  const auto add = [&](const std::string& file) {
    content += "<shape type='obj'><string name='filename' value='" + file + "'/></shape>\n";
  };
  for (int i = 0; i < 20; ++i) add("gone" + std::to_string(i) + ".obj");
  for (int i = 0; i < 3; ++i) add("flat.obj");
  add("torn.obj");
  for (const std::string picture : {"gone.png", "torn.png"}) {
    content +=
        "<shape type='rectangle'><bsdf type='diffuse'><texture type='bitmap' "
        "name='reflectance'><string name='filename' value='" +
        picture + "'/></texture></bsdf></shape>";
  }
  content +=
      "<shape type='cube'><bsdf type='mask'><bsdf type='diffuse'/><texture type='bitmap' "
      "name='opacity'><string name='filename' value='leaf.png'/></texture></bsdf></shape>"
      "<emitter type='envmap'><string name='filename' value='sky.exr'/></emitter>"
      "<include filename='more.xml'/>";
  const Scene scene = read(content);
  EXPECT_EQ(scene.surfaces.size(), 4u);
  EXPECT_FALSE(scene.sky);
  EXPECT_FLOAT_EQ(
      scene.materials.at(static_cast<std::size_t>(scene.surfaces[1].material)).reflectance[0],
      0.5f);
  EXPECT_TRUE(has_note(scene,
                       "'gone0.obj', 'gone1.obj', 'gone2.obj', 'gone3.obj', 'gone4.obj' and "
                       "15 more"));
  EXPECT_TRUE(has_loss(scene, "'gone18.obj', 'gone19.obj'."));
  EXPECT_TRUE(has_note(scene, "Shapes without area were left out: 'flat', 'flat 2', 'flat 3'"));
  for (const char* name :
       {"torn.obj:3", "'gone.png'", "'torn.png'", "'leaf.png'", "sky.exr", "'more.xml'"}) {
    EXPECT_TRUE(has_note(scene, name)) << name;
    EXPECT_TRUE(has_loss(scene, name)) << name;
  }
}

}  // namespace
}  // namespace lightwell::read_mitsuba_test
