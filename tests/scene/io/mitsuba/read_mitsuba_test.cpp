#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/round_shape.h"
#include "tests/scene/io/mitsuba/mitsuba_test.h"
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

class Mitsuba : public test::MitsubaTest {};

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
  const auto disk_normal = [](const Scene& scene) {
    return front_normal(std::get<Frustum>(scene.surfaces.at(0).shape), {0, 0, 0});
  };
  expect_near(disk_normal(mirrored("disk", "")), {0, 0, 1});
  expect_near(disk_normal(mirrored("disk", "<boolean name='flip_normals' value='true'/>")),
              {0, 0, -1});
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

TEST_F(Mitsuba, RoundShapesAreExactOrKeepTheirArea) {
  const std::string stretched = R"(<transform name="to_world"><scale value="3"/></transform>)";
  const Scene disk = read("<shape type='disk'>" + stretched + "</shape>");
  // An area is a product of a few numbers, or a sum over 32 facets of two products each.
  constexpr double rounding = 64 * 0x1p-53;
  EXPECT_NEAR(surface_area(disk.surfaces.at(0)), 9 * pi, rounding * 9 * pi);
  const std::string uneven = R"(<transform name="to_world"><scale x="3"/></transform>)";
  const Scene ellipse = read("<shape type='disk'>" + uneven + "</shape>");
  EXPECT_NEAR(area_of(mesh_of(ellipse)), 3 * pi, rounding * 3 * pi);
  EXPECT_EQ(ellipse.losses.size(), 1u);
  const std::string tube = R"(<shape type="cylinder"><point name="p0" x="1"/>
      <point name="p1" x="1" y="2"/><float name="radius" value="0.5"/></shape>)";
  const Scene cylinder = read(tube);
  EXPECT_NEAR(surface_area(cylinder.surfaces.at(0)), 2 * pi * 0.5 * 2, rounding * 2 * pi);
  EXPECT_FALSE(std::get<Frustum>(cylinder.surfaces.at(0).shape).inward);
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

TEST_F(Mitsuba, DefaultsAndReferencesAndIncludesArePutInPlace) {
  folder.write("walls.xml", R"(<scene version="3.0.0"><bsdf type="diffuse" id="wall">
      <rgb name="reflectance" value="$shade"/></bsdf></scene>)");
  const Scene scene = read(R"(<default name="shade" value="0.3"/><default name="shade" value="0.9"/>
      <include filename="walls.xml"/><shape type="rectangle"><ref id="wall"/></shape>)");
  EXPECT_EQ(scene.materials.at(0).name, "wall");
  EXPECT_FLOAT_EQ(scene.materials.at(0).reflectance[0], 0.3f);  // the first one counts
}

TEST_F(Mitsuba, WhatIsNotKnownIsNamedOnceAndPassedOver) {
  const Scene scene = read(square + R"(<emitter type="projector"/><emitter type="projector"/>
      <integrator type="magic"/><shape type="hair"/><medium type="fog"/>
      <shape type="rectangle"><bsdf type="velvet"/></shape>)");
  EXPECT_EQ(scene.surfaces.size(), 2u);
  for (const char* name :
       {"'projector' give no light", "'magic'", "plugin 'hair'", "<medium", "'velvet'"}) {
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
