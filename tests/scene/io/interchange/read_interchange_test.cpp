#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <stdexcept>

#include "scene/io/interchange/import_trial.h"
#include "scene/io/interchange/imported_file.h"
#include "tests/scene/expected_messages.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/interchange_text.h"
#include "tests/scene/scene_file_test.h"

namespace lightwell::read_interchange_test {
namespace {

const std::filesystem::path data = LIGHTWELL_TEST_DATA "/scene";
const std::string plate = DaeParts().nodes;

// The library stores floats: a number x of the file is off by at most x 2^-24, and a product of a
// few of them by a few times as much. Coordinates here are at most 4.
constexpr double float_error = 4.0 * 0x1p-22;

class Interchange : public test::SceneFileTest {
 protected:
  Scene read_dae(const DaeParts& parts) const { return read_file("a.dae", square_dae(parts)); }
  Scene read_fbx(const FbxParts& parts) const { return read_file("a.fbx", square_fbx(parts)); }
  Material dae_material(const std::string& effect) const {
    return first_material(read_dae({.effect = effect}));
  }
};

testing::AssertionResult notes(const Scene& scene, const std::string& part) {
  std::string all;
  for (const std::string& note : scene.notes) all += note + "\n";
  return says(all, part);
}

void expect_rgb(const Spectrum& actual, double r, double g, double b) {
  // Numbers of at most pi, each the float nearest to a product of two floats.
  constexpr double rounding = std::numbers::pi * 3.0 * 0x1p-24;
  EXPECT_NEAR(actual[0], r, rounding);
  EXPECT_NEAR(actual[1], g, rounding);
  EXPECT_NEAR(actual[2], b, rounding);
}

void expect_box(const Scene& scene, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const Bounds bounds = scene_bounds(scene);
  EXPECT_LE((bounds.low - low).cwiseAbs().maxCoeff(), float_error) << bounds.low.transpose();
  EXPECT_LE((bounds.high - high).cwiseAbs().maxCoeff(), float_error) << bounds.high.transpose();
}

void expect_direction(const Eigen::Vector3d& actual, const Eigen::Vector3d& expected) {
  EXPECT_LE((actual - expected).norm(), float_error) << actual.transpose();
}

const PolygonMesh& mesh_of(const Scene& scene, std::size_t surface) {
  return std::get<PolygonMesh>(scene.surfaces.at(surface).shape);
}

TEST_F(Interchange, ColladaNodesPlaceInstancesInMetres) {
  const std::string square = plate.substr(plate.find('>') + 1);
  const Scene scene =
      read_dae({.asset = R"(<unit name="foot" meter="0.5"/><up_axis>Z_UP</up_axis>)",
                .nodes = R"(<node id="a"><translate>2 0 4</translate>)"
                         R"(<rotate> 0 0 1 90</rotate><node id="b"><scale>2 3 1</scale>)" +
                         square + R"(<node id="c">)" + square + "</node>"});
  ASSERT_EQ(scene.surfaces.size(), 2u);
  EXPECT_EQ(scene.surfaces[0].name, "b");
  EXPECT_EQ(scene.metres_per_unit, 0.5);
  EXPECT_TRUE(scene.relative_units);
  // b: x to y 0 .. 2, y to -x, 0 .. -3, then moved and halved. z stays upright.
  expect_box(scene, {-0.5, 0.0, 2.0}, {1.0, 1.0, 2.0});
  const PolygonMesh& mesh = mesh_of(scene, 1);
  ASSERT_EQ(mesh.facets.size(), 1u) << "a quadrilateral stays one";
  expect_direction(facet_normal(mesh, mesh.facets[0]), Eigen::Vector3d::UnitZ());
}

TEST_F(Interchange, MirroredNodesKeepTheirFronts) {
  const Scene scene = read_dae(
      {.nodes = R"(<node id="a"><scale>-1 1 1</scale>)" + plate.substr(plate.find('>') + 1)});
  const PolygonMesh& mesh = mesh_of(scene, 0);
  expect_direction(facet_normal(mesh, mesh.facets[0]), Eigen::Vector3d::UnitZ());
}

TEST_F(Interchange, ColladaColoursAreReflectanceAndRadiance) {
  const Material material = dae_material(
      "<emission><color>1 0.5 0.25 1</color></emission>"
      "<diffuse><color>0.1 0.2 0.3 1</color></diffuse>");
  EXPECT_EQ(material.name, "paint");
  expect_rgb(material.reflectance, 0.1, 0.2, 0.3);
  expect_rgb(material.emission, std::numbers::pi, std::numbers::pi / 2, std::numbers::pi / 4);
}

TEST_F(Interchange, OpacityLetsTheRestThrough) {
  // A_ONE: opacity is alpha times transparency.
  const Material material = dae_material(
      "<diffuse><color>0.8 0.4 0.4 1</color></diffuse><transparent opaque=\"A_ONE\">"
      "<color>1 1 1 1</color></transparent><transparency><float>0.25</float></transparency>");
  expect_rgb(material.reflectance, 0.2, 0.1, 0.1);
  expect_rgb(material.regular_transmittance, 0.75, 0.75, 0.75);
}

TEST_F(Interchange, NoOpacityIsGlassWhereAnIndexIsGiven) {
  const std::string none =
      "<transparent opaque=\"A_ONE\"><color>1 1 1 1</color></transparent>"
      "<transparency><float>0</float></transparency>";
  const Material glass =
      dae_material(none + "<index_of_refraction><float>1.25</float></index_of_refraction>");
  ASSERT_TRUE(glass.dielectric);
  EXPECT_EQ(glass.dielectric->index_of_refraction, 1.25f);
  EXPECT_TRUE(glass.dielectric->thin) << "the square is an open sheet";
  const Scene scene = read_dae({.effect = none});
  EXPECT_FALSE(first_material(scene).dielectric);
  EXPECT_TRUE(notes(scene, "An opacity of 0 without an index of refraction was read as 1"));
}

TEST_F(Interchange, ReflectivityIsTheShareOfAMirror) {
  const Material material = dae_material(
      "<diffuse><color>0.8 0.4 0.4 1</color></diffuse>"
      "<reflective><color>1 0.5 0.5 1</color></reflective>"
      "<reflectivity><float>0.25</float></reflectivity>");
  expect_rgb(material.reflectance, 0.6, 0.3, 0.3);
  expect_rgb(material.specular, 0.25, 0.125, 0.125);
  EXPECT_EQ(material.specular_roughness, 0.0f);
}

// The effect of a picture called `file`.
DaeParts with_picture(const std::string& file) {
  return {.effect = R"(<diffuse><texture texture="sampler" texcoord="UV"/></diffuse>)",
          .params = R"(<newparam sid="surface"><surface type="2D"><init_from>image</init_from>)"
                    R"(</surface></newparam><newparam sid="sampler"><sampler2D><source>surface)"
                    R"(</source></sampler2D></newparam>)",
          .libraries = R"(<library_images><image id="image"><init_from>)" + file +
                       R"(</init_from></image></library_images>)"};
}

TEST_F(Interchange, PicturesLieOnTextureCoordinates) {
  std::filesystem::copy(data / "two-pixels.png", folder / "two pixels.png");
  for (const std::string name : {"two%20pixels.png", "/home/someone/two%20pixels.png"}) {
    SCOPED_TRACE(name);
    const Scene scene = read_dae(with_picture(name));
    const Material material = first_material(scene);
    ASSERT_TRUE(material.texture);
    expect_rgb(material.texture->factor, 1, 1, 1);
    expect_rgb(material.reflectance, 0.5, 0.5, 0.5);  // the mean of white and black
    const PolygonMesh& mesh = mesh_of(scene, 0);
    ASSERT_EQ(mesh.facets.at(0).uv_map, 0);
    // v of the file points up; v here points down.
    const Eigen::Vector2d uv = mesh.uv_maps.at(0).at({0.25, 0.25, 0.0});
    EXPECT_NEAR(uv.x(), 0.25, float_error);
    EXPECT_NEAR(uv.y(), 0.75, float_error);
  }
}

TEST_F(Interchange, MissingPicturesAreGreyWithANote) {
  const Scene scene = read_dae(with_picture("none.png"));
  expect_rgb(first_material(scene).reflectance, 0.5, 0.5, 0.5);
  EXPECT_TRUE(notes(scene, "'none.png' is missing"));
}

// A light in a library, and a node that shows it twice.
DaeParts with_light(const std::string& light) {
  return {.libraries = R"(<library_lights><light id="l"><technique_common>)" + light +
                       "</technique_common></light></library_lights>",
          .nodes = plate +
                   R"(<node id="first"><translate>1 2 3</translate><rotate>0 1 0 90</rotate>)"
                   R"(<instance_light url="#l"/></node>)"};
}

TEST_F(Interchange, PicturesOfEmissionShineAsPictures) {
  std::filesystem::copy(data / "two-pixels.png", folder / "glow.png");
  DaeParts parts = with_picture("glow.png");
  parts.effect = R"(<emission><texture texture="sampler" texcoord="UV"/></emission>)";
  const Material material = first_material(read_dae(parts));
  ASSERT_TRUE(material.emission_texture);
  constexpr auto pi = std::numbers::pi;
  expect_rgb(material.emission_texture->factor, pi, pi, pi);
  const Eigen::Array3f mean = material.emission_texture->image.picture->mean();
  // The mean of the texels, each in a code of 16 bits, and that of the file itself.
  EXPECT_LT((material.emission - static_cast<float>(pi) * mean).abs().maxCoeff(), pi / 65535);
}

TEST_F(Interchange, ColladaLightsAreLampsAndSuns) {
  const Scene point = read_dae(with_light("<point><color>4 2 1</color></point>"));
  ASSERT_EQ(point.lamps.size(), 1u);
  EXPECT_EQ(point.lamps[0].name, "first");
  expect_rgb(point.lamps[0].intensity / 4.0f, 1, 0.5, 0.25);
  expect_direction(point.lamps[0].position, {1, 2, 3});

  const Scene spot =
      read_dae(with_light("<spot><color>1 1 1</color><falloff_angle>60</falloff_angle></spot>"));
  ASSERT_EQ(spot.lamps.size(), 1u);
  // A COLLADA light shines along -z, which the turn about y takes to -x.
  expect_direction(spot.lamps[0].aim(), {-1, 0, 0});
  EXPECT_NEAR(std::get<SpotCone>(spot.lamps[0].shape).outer, std::numbers::pi / 6, float_error);

  const Scene sun = read_dae(with_light("<directional><color>3 3 3</color></directional>"));
  ASSERT_TRUE(sun.sky && sun.sky->sun);
  expect_direction(sun.sky->sun->direction, {1, 0, 0});
  expect_rgb(sun.sky->sun->irradiance / 3.0f, 1, 1, 1);

  const Scene ambient = read_dae(with_light("<ambient><color>1 1 1</color></ambient>"));
  EXPECT_TRUE(notes(ambient, "Ambient light"));
  EXPECT_TRUE(notes(ambient, "the scene is dark"));
}

TEST_F(Interchange, CamerasOfOneNameHaveTheirNodes) {
  const Scene scene = read_dae(
      {.libraries =
           R"(<library_cameras><camera id="c"><optics><technique_common><perspective>)"
           R"(<yfov>60</yfov><aspect_ratio>1.5</aspect_ratio><znear>1</znear><zfar>9</zfar>)"
           R"(</perspective></technique_common></optics></camera></library_cameras>)"
           R"(<library_nodes><node id="eye"><instance_camera url="#c"/></node>)"
           R"(</library_nodes>)",
       .nodes = plate + R"(<node id="low"><translate>0 0 1</translate><instance_node url="#eye"/>)"
                        R"(</node><node id="high"><translate>0 0 4</translate>)"
                        R"(<instance_node url="#eye"/></node>)"});
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_NE(scene.cameras[0].name, scene.cameras[1].name);
  expect_direction(scene.cameras[0].position, {0, 0, 1});
  expect_direction(scene.cameras[1].position, {0, 0, 4});
  EXPECT_EQ(scene.cameras[0].height, 512);
  EXPECT_EQ(scene.cameras[0].width, 768);
  // tan(fov / 2) = 1.5 tan(30 degrees); a relative error of a float times 82 degrees.
  const double half = std::atan(1.5 / std::sqrt(3.0));
  EXPECT_NEAR(scene.cameras[0].fov_degrees, 2.0 * half * 180.0 / std::numbers::pi, 82 * 0x1p-21);
}

TEST_F(Interchange, FbxIsInItsUnit) {
  const Scene scene = read_fbx({.settings = R"(P: "UnitScaleFactor", "double", "Number", "",50)",
                                .place = R"(P: "Lcl Translation", "Lcl Translation", "", "A",1,2,4)"
                                         "\n"
                                         R"(P: "Lcl Rotation", "Lcl Rotation", "", "A",0,0,90)"});
  EXPECT_EQ(scene.surfaces.at(0).name, "plate");
  EXPECT_EQ(scene.metres_per_unit, 0.5);
  expect_box(scene, {0.0, 1.0, 2.0}, {0.5, 1.5, 2.0});
}

TEST_F(Interchange, FbxMaterialsAreThoseOfPhong) {
  const Scene scene = read_fbx({.material = R"(P: "DiffuseColor", "Color", "", "A",0.8,0.4,0.4
P: "EmissiveColor", "Color", "", "A",1,1,1
P: "EmissiveFactor", "Number", "", "A",0.5
P: "SpecularColor", "Color", "", "A",0.5,0.5,0.5
P: "ShininessExponent", "Number", "", "A",14)"});
  const Material material = first_material(scene);
  EXPECT_EQ(material.name, "paint");
  expect_rgb(material.reflectance, 0.8, 0.4, 0.4);
  const double half = 0.5 * std::numbers::pi;
  expect_rgb(material.emission, half, half, half);
  EXPECT_FALSE(material.is_specular());
  EXPECT_TRUE(notes(scene, "Specular colours describe a highlight"));
}

// Half of the square's mirror is Phong's lobe of the exponent 14: alpha = sqrt(2 / 16).
TEST_F(Interchange, FbxMirrorsHaveTheirGloss) {
  const Material material =
      first_material(read_fbx({.material = R"(P: "DiffuseColor", "Color", "", "A",0.8,0.4,0.4
P: "ReflectionColor", "Color", "", "A",1,0.5,0.5
P: "ReflectionFactor", "Number", "", "A",0.5
P: "ShininessExponent", "Number", "", "A",14)"}));
  expect_rgb(material.reflectance, 0.4, 0.2, 0.2);
  expect_rgb(material.specular, 0.5, 0.25, 0.25);
  EXPECT_NEAR(material.specular_roughness, std::sqrt(2.0 / 16.0), 0x1p-22);
}

// Normals that lean outwards at the corners, as those of a vault.
TEST_F(Interchange, FbxNormalsAreSmooth) {
  const Scene scene = read_fbx({.layers = R"(		LayerElementNormal: 0 {
			Version: 101
			Name: ""
			MappingInformationType: "ByPolygonVertex"
			ReferenceInformationType: "Direct"
			Normals: *12 {
				a: -0.6,0,0.8,0.6,0,0.8,0.6,0,0.8,-0.6,0,0.8
			}
		}
)",
                                .layer = R"(			LayerElement:  {
				Type: "LayerElementNormal"
				TypedIndex: 0
			})"});
  const PolygonMesh& mesh = mesh_of(scene, 0);
  ASSERT_EQ(mesh.facets.at(0).normal_map, 0);
  const Eigen::Vector3d left = mesh.normal_maps[0].at({0.0, 0.5, 0.0}).normalized();
  expect_direction(left, {-0.6, 0.0, 0.8});
}

FbxParts with_light_and_camera() {
  return {.objects = R"(
	NodeAttribute: 21, "NodeAttribute::bulb", "Light" {
		Properties70:  {
			P: "LightType", "enum", "", "",2
			P: "Color", "Color", "", "A",1,0.5,0.25
			P: "Intensity", "Number", "", "A",200
			P: "InnerAngle", "Number", "", "A",30
			P: "OuterAngle", "Number", "", "A",60
		}
		TypeFlags: "Light"
	}
	Model: 22, "Model::bulb", "Light" {
		Version: 232
		Properties70:  {
			P: "PostRotation", "Vector3D", "Vector", "",-90,0,0
			P: "RotationActive", "bool", "", "",1
			P: "Lcl Translation", "Lcl Translation", "", "A",1,2,3
			P: "Lcl Rotation", "Lcl Rotation", "", "A",0,90,0
		}
	}
	NodeAttribute: 23, "NodeAttribute::eye", "Camera" {
		Properties70:  {
			P: "AspectWidth", "double", "Number", "",300
			P: "AspectHeight", "double", "Number", "",200
			P: "FieldOfView", "FieldOfView", "", "A",50
		}
		TypeFlags: "Camera"
	}
	Model: 24, "Model::eye", "Camera" {
		Version: 232
		Properties70:  {
			P: "PostRotation", "Vector3D", "Vector", "",0,-90,0
			P: "RotationActive", "bool", "", "",1
			P: "Lcl Translation", "Lcl Translation", "", "A",0,0,3
		}
	}
)",
          .links = R"(
	C: "OO",22,0
	C: "OO",21,22
	C: "OO",24,0
	C: "OO",23,24
)"};
}

TEST_F(Interchange, FbxLightsAndCamerasTurnBackAfterTheirRotation) {
  const Scene scene = read_fbx(with_light_and_camera());
  ASSERT_EQ(scene.lamps.size(), 1u);
  const Lamp& lamp = scene.lamps[0];
  EXPECT_EQ(lamp.name, "bulb");
  expect_direction(lamp.position, {1, 2, 3});
  expect_rgb(lamp.intensity / 2.0f, 1, 0.5, 0.25);
  // FBX applies the inverse of the rotation after: -y of a light is -z before the turn about y, and
  // +x of a camera is -z.
  expect_direction(lamp.aim(), {-1, 0, 0});
  const SpotCone cone = std::get<SpotCone>(lamp.shape);
  EXPECT_NEAR(cone.inner, std::numbers::pi / 12, float_error);
  EXPECT_NEAR(cone.outer, std::numbers::pi / 6, float_error);

  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.name, "eye");
  expect_direction(camera.position, {0, 0, 3});
  expect_direction(camera.direction, {0, 0, -1});
  EXPECT_NEAR(camera.fov_degrees, 50.0, 50 * 0x1p-21);
  EXPECT_EQ(camera.width, 768);
}

TEST_F(Interchange, EmbeddedPicturesAreRead) {
  const std::string png = base64(content_of(data / "two-pixels.png"));
  const Scene scene = read_fbx({.objects = R"(
	Texture: 31, "Texture::print", "" {
		Type: "TextureVideoClip"
		Version: 202
		TextureName: "Texture::print"
		Media: "Video::print"
		FileName: "print.png"
		RelativeFilename: "print.png"
	}
	Video: 32, "Video::print", "Clip" {
		Type: "Clip"
		FileName: "print.png"
		RelativeFilename: "print.png"
		Content: ,
			")" + png + R"("
	}
)",
                                .links = R"(
	C: "OP",31,13, "DiffuseColor"
	C: "OO",32,31
)"});
  ASSERT_TRUE(first_material(scene).texture);
  expect_rgb(first_material(scene).reflectance, 0.5, 0.5, 0.5);
}

TEST_F(Interchange, MeshesOfAnotherSceneKeepTheirUnit) {
  folder.write("plate.fbx",
               square_fbx({.settings = R"(P: "UnitScaleFactor", "double", "Number", "",50)"}));
  folder.write("plate.dae", square_dae(with_light("<point><color>1 1 1</color></point>")));
  const std::string grey = "unit = 'cm'\n[materials.grey]\nreflectance = 0.25\n[[surfaces]]\n";
  const Scene fbx =
      read_file("a.toml", grey + "mesh = 'plate.fbx'\nmaterial = 'grey'\nscale = 2\n");
  expect_box(fbx, {0, 0, 0}, {1, 1, 0});
  expect_rgb(first_material(fbx).reflectance, 0.25, 0.25, 0.25);
  const Scene dae = read_file("b.toml", grey + "mesh = 'plate.dae'\n");
  expect_box(dae, {0, 0, 0}, {1, 1, 0});
  EXPECT_EQ(first_material(dae).name, "paint (plate.dae)");
  EXPECT_TRUE(dae.lamps.empty());
  EXPECT_TRUE(notes(dae, "Lights of mesh files were left out"));
}

TEST_F(Interchange, FilesThatAreNoneAreRefused) {
  for (const std::string name : {"a.dae", "a.fbx"}) {
    test::expect_message([&] { read_file(name, "PK nothing of the kind"); },
                         {name, "the file is damaged or no", "export it again"});
    const auto large = folder.write(name, "");
    std::filesystem::resize_file(large, static_cast<std::uintmax_t>(largest_import) + 1);
    test::expect_message([&] { read_scene(large); }, {"files of this format may have 512"});
  }
}

TEST(ImportTrial, TellsFaultsAndSurvivesCrashes) {
  EXPECT_EQ(trial_fault([] { return std::string(); }, 1), "");
  EXPECT_EQ(trial_fault([] { return std::string("no roof"); }, 1), "no roof");
  EXPECT_EQ(trial_fault([]() -> std::string { throw std::runtime_error("no door"); }, 1),
            "no door");
  EXPECT_EQ(trial_fault([]() -> std::string { std::abort(); }, 1),
            "its contents contradict each other");
}

}  // namespace
}  // namespace lightwell::read_interchange_test
