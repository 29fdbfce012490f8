#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "scene/errors.h"
#include "scene/io/sensor_grids.h"
#include "tests/scene/io/honeybee/honeybee_models.h"

namespace lightwell::read_honeybee_test {
namespace {

using namespace honeybee_models;

std::string error_of(const std::string& text) {
  const TemporaryFolder folder;
  try {
    read_scene(folder.write("model.hbjson", text));
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::map<std::string, double> areas(const Scene& scene) {
  std::map<std::string, double> result;
  for (const Surface& surface : scene.surfaces) result[surface.name] = surface_area(surface);
  return result;
}

// Areas are sums and differences of a few products below 20 m^2.
constexpr double rounding = 1e-12;

TEST(ReadHoneybee, OpeningsAreCutOutOfTheirFaceAlsoAtItsEdge) {
  const auto area = areas(read(model()));
  ASSERT_EQ(area.size(), 8u);
  EXPECT_NEAR(area.at("window"), 2.0, rounding);
  EXPECT_NEAR(area.at("door"), 1.6, rounding);
  EXPECT_NEAR(area.at("south"), 10.0 - 2.0 - 1.6, rounding);
  EXPECT_NEAR(area.at("floor"), 12.0, rounding);
}

TEST(ReadHoneybee, FrontsOfARoomFaceIntoIt) {
  const Eigen::Vector3d middle(2.0, 1.5, 1.25);
  json inside_out = model();
  for (json& each : inside_out["rooms"][0]["faces"]) {
    json& boundary = each["geometry"]["boundary"];
    std::reverse(boundary.begin(), boundary.end());
  }
  json by_plane = inside_out;
  const std::map<std::string, json> outward = {{"south", {0, -1, 0}}, {"north", {0, 1, 0}},
                                               {"west", {-1, 0, 0}},  {"east", {1, 0, 0}},
                                               {"floor", {0, 0, -1}}, {"ceiling", {0, 0, 1}}};
  for (json& each : by_plane["rooms"][0]["faces"]) {
    each["geometry"]["plane"] = {{"n", outward.at(each["identifier"])}};
  }
  for (const json& of : {model(), inside_out, by_plane}) {
    for (const Surface& surface : read(of).surfaces) {
      if (surface.name == "window" || surface.name == "door") continue;
      const auto& mesh = std::get<PolygonMesh>(surface.shape);
      const Eigen::Vector3d inward = middle - mesh.vertices[0];
      EXPECT_GT(facet_normal(mesh, mesh.facets[0]).dot(inward), 0.0) << surface.name;
    }
  }
}

// Far from the origin, with a wall missing.
TEST(ReadHoneybee, FrontsOfAnOpenRoomFaceIntoIt) {
  json of = model();
  json& faces = of["rooms"][0]["faces"];
  faces.erase(3);
  for (json& each : faces) {
    each.erase("apertures");
    each.erase("doors");
    for (json& point : each["geometry"]["boundary"]) point[0] = point[0].get<double>() + 100.0;
  }
  const PolygonMesh floor = std::get<PolygonMesh>(read(of).surfaces[3].shape);
  EXPECT_GT(facet_normal(floor, floor.facets[0]).z(), 0.0);
}

TEST(ReadHoneybee, HolesOfAFaceAreOpen) {
  json shade = object("canopy", rectangle({0, 0, 4}, {3, 0, 0}, {0, 3, 0}));
  shade["geometry"]["holes"] =
      json::array({rectangle({1, 1, 4}, {1, 0, 0}, {0, 1, 0})["boundary"]});
  json with_shade = model();
  with_shade["orphaned_shades"] = json::array({shade});
  EXPECT_NEAR(areas(read(with_shade)).at("canopy"), 8.0, rounding);
}

TEST(ReadHoneybee, LengthsAreInTheUnitOfTheModel) {
  json in_feet = model();
  in_feet["units"] = "Feet";
  const Scene scene = read(in_feet);
  EXPECT_NEAR(areas(scene).at("floor"), 12.0 * 0.3048 * 0.3048, rounding);
  EXPECT_EQ(scene.metres_per_unit, 0.3048);
}

TEST(ReadHoneybee, ObjectsWithoutModifierHaveHoneybeesOwn) {
  const Scene scene = read(model());
  EXPECT_EQ(material_of(scene, "floor").reflectance[0], 0.2f);
  EXPECT_EQ(material_of(scene, "north").reflectance[0], 0.5f);
  EXPECT_EQ(material_of(scene, "ceiling").reflectance[0], 0.8f);
  ASSERT_TRUE(material_of(scene, "window").dielectric.has_value());
  // The transmissivity t of a pane of n = 1.52 that passes T along its normal (RADIANCE's manual):
  // t = (sqrt(0.8402528435 + 0.0072522239 T^2) - 0.9166530661) / 0.0036261119 / T
  const double T = 0.64;
  const double t =
      (std::sqrt(0.8402528435 + 0.0072522239 * T * T) - 0.9166530661) / 0.0036261119 / T;
  // The difference of two numbers of ten digits near 0.9, over 0.0023.
  EXPECT_NEAR(material_of(scene, "window").dielectric->transmissivity[0], t, 1e-7);
}

TEST(ReadHoneybee, ModifiersOfObjectsGoBeforeThoseOfSets) {
  json of = model();
  json& radiance = of["properties"]["radiance"];
  const auto grey = [](const char* name, double rho) {
    return json{{"type", "Plastic"},
                {"identifier", name},
                {"r_reflectance", rho},
                {"g_reflectance", rho},
                {"b_reflectance", rho}};
  };
  radiance["modifiers"] = {grey("bright", 0.9), grey("dark", 0.1)};
  radiance["modifier_sets"] =
      json::array({{{"identifier", "set"},
                    {"wall_set", {{"exterior_modifier", "dark"}}},
                    {"floor_set", {{"exterior_modifier", nullptr}}},
                    {"roof_ceiling_set", {{"exterior_modifier", grey("own", 0.7)}}}}});
  of["rooms"][0]["properties"]["radiance"]["modifier_set"] = "set";
  of["rooms"][0]["faces"][1]["properties"]["radiance"]["modifier"] = "bright";
  const Scene scene = read(of);
  EXPECT_EQ(material_of(scene, "north").reflectance[0], 0.9f);
  EXPECT_EQ(material_of(scene, "west").reflectance[0], 0.1f);
  EXPECT_EQ(material_of(scene, "floor").reflectance[0], 0.2f);
  EXPECT_EQ(material_of(scene, "ceiling").reflectance[0], 0.7f);
}

TEST(ReadHoneybee, ModifiersAreThoseOfRadiance) {
  json of = model();
  of["properties"]["radiance"]["modifiers"] = {{{"type", "Trans"},
                                                {"identifier", "cloth"},
                                                {"r_reflectance", 0.8},
                                                {"g_reflectance", 0.8},
                                                {"b_reflectance", 0.8},
                                                {"transmitted_diff", 0.5},
                                                {"transmitted_spec", 0.25}},
                                               {{"type", "Light"},
                                                {"identifier", "lamp"},
                                                {"r_emittance", 1.0},
                                                {"g_emittance", 2.0},
                                                {"b_emittance", 3.0}}};
  of["rooms"][0]["faces"][1]["properties"]["radiance"]["modifier"] = "cloth";
  of["rooms"][0]["faces"][2]["properties"]["radiance"]["modifier"] = "lamp";
  const Scene scene = read(of);
  // trans: (1 - T) rho C is reflected, T (1 - S) C passes diffusely, T S C straight on.
  const Material& cloth = material_of(scene, "north");
  EXPECT_FLOAT_EQ(cloth.reflectance[0], 0.4f);
  EXPECT_FLOAT_EQ(cloth.transmittance[0], 0.3f);
  EXPECT_FLOAT_EQ(cloth.regular_transmittance[0], 0.1f);
  EXPECT_FLOAT_EQ(material_of(scene, "west").emission[1], 2.0f * std::numbers::pi_v<float>);
}

// Everything that decides the light is the same, bit for bit. Scene files have their materials in
// alphabetical order.
TEST(ReadHoneybee, TheRoomIsThatOfASceneFile) {
  const TemporaryFolder folder;
  const std::string native = fmt::format(
      R"(
[bands]
lumens_per_watt = 179
[materials.1_pane]
glass = {{ ior = 1.52, thin = true, transmissivity = {} }}
[materials.2_wall]
reflectance = 0.5
[materials.3_floor]
reflectance = 0.2
[materials.4_ceiling]
reflectance = 0.8
[[surfaces]]
name = "window"
material = "1_pane"
polygons = [[[0.5, 0, 1], [2.5, 0, 1], [2.5, 0, 2], [0.5, 0, 2]]]
[[surfaces]]
name = "south"
material = "2_wall"
polygon = [[0, 0, 2.5], [4, 0, 2.5], [4, 0, 0], [0, 0, 0]]
holes = [[[0.5, 0, 1], [2.5, 0, 1], [2.5, 0, 2], [0.5, 0, 2]]]
[[surfaces]]
name = "floor"
material = "3_floor"
polygons = [[[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0]]]
[[surfaces]]
name = "ceiling"
material = "4_ceiling"
polygons = [[[0, 3, 2.5], [4, 3, 2.5], [4, 0, 2.5], [0, 0, 2.5]]]
)",
      0.6975761815384331);
  json of = model();
  json& faces = of["rooms"][0]["faces"];
  faces[0].erase("doors");
  for (int wall_number = 3; wall_number >= 1; --wall_number) faces.erase(wall_number);
  EXPECT_EQ(scene_hash(read(of)), scene_hash(read_scene(folder.write("room.toml", native))));
}

// The room, and the same room 4 m east of it, whose wall "west" lies on the wall "east" of the
// first. Both walls have the same window.
json two_rooms() {
  json first = room(), second = room();
  second["identifier"] = "second";
  for (json& each : second["faces"]) {
    each["identifier"] = "second " + each["identifier"].get<std::string>();
    for (json& point : each["geometry"]["boundary"]) point[0] = point[0].get<double>() + 4.0;
    each.erase("apertures");
    each.erase("doors");
  }
  const auto join = [](json& wall, const std::string& name, const std::string& other) {
    json window = object("window of " + name, rectangle({4, 1, 1}, {0, 1, 0}, {0, 0, 1}));
    window["boundary_condition"] = {
        {"type", "Surface"},
        {"boundary_condition_objects", {"window of " + other, other, "room of " + other}}};
    wall["boundary_condition"] = {{"type", "Surface"},
                                  {"boundary_condition_objects", {other, "room of " + other}}};
    wall["apertures"] = json::array({window});
  };
  constexpr int west = 2, east = 3;
  join(first["faces"][east], "east", "second west");
  join(second["faces"][west], "second west", "east");
  return model({first, second});
}

const PolygonMesh& mesh_of(const Scene& scene, const std::string& surface) {
  for (const Surface& s : scene.surfaces) {
    if (s.name == surface) return std::get<PolygonMesh>(s.shape);
  }
  throw std::runtime_error("no surface " + surface);
}

TEST(ReadHoneybee, RoomsHaveTheirOwnFacesAndShareOpenings) {
  json of = two_rooms();
  of["tolerance"] = 0.01;
  const Scene scene = read(of);
  const auto area = areas(scene);
  EXPECT_NEAR(area.at("east"), 7.5 - 1.0, rounding);
  EXPECT_NEAR(area.at("second west"), 7.5 - 1.0, rounding);
  EXPECT_NEAR(area.at("window of east"), 1.0, rounding);
  EXPECT_FALSE(area.contains("window of second west"));
  // Inner windows have the clearer glass.
  EXPECT_EQ(material_of(scene, "window of east").name, "generic_interior_window_vis_0.88");
  // The second face lies by twice the tolerance in its own room.
  for (const Eigen::Vector3d& point : mesh_of(scene, "east").vertices) EXPECT_EQ(point.x(), 4.0);
  for (const Eigen::Vector3d& point : mesh_of(scene, "second west").vertices) {
    EXPECT_NEAR(point.x(), 4.02, rounding);
  }
  of["units"] = "Feet";
  const Scene in_feet = read(of);
  for (const Eigen::Vector3d& point : mesh_of(in_feet, "second west").vertices) {
    EXPECT_NEAR(point.x(), 0.3048 * 4.02, rounding);
  }
}

TEST(ReadHoneybee, AirBoundariesAreOpen) {
  json of = model();
  of["rooms"][0]["faces"][1]["face_type"] = "AirBoundary";
  const auto area = areas(read(of));
  EXPECT_FALSE(area.contains("north"));
  EXPECT_TRUE(area.contains("west"));
}

TEST(ReadHoneybee, ShadesHaveTheModifierOfTheirPlace) {
  json of = model();
  const json plate = rectangle({0, -2, 3}, {4, 0, 0}, {0, 1, 0});
  of["orphaned_shades"] = {object("porch", plate), object("neighbour", plate)};
  of["orphaned_shades"][1]["is_detached"] = true;
  of["rooms"][0]["indoor_shades"] = json::array({object("table", plate)});
  of["shade_meshes"] = json::array({{{"identifier", "hill"},
                                     {"properties", json::object()},
                                     {"geometry",
                                      {{"vertices", {{0, 9, 0}, {1, 9, 0}, {1, 10, 0}, {0, 10, 0}}},
                                       {"faces", {{0, 1, 2}, {0, 2, 3}}}}}}});
  const Scene scene = read(of);
  EXPECT_EQ(material_of(scene, "porch").reflectance[0], 0.35f);
  EXPECT_EQ(material_of(scene, "neighbour").reflectance[0], 0.2f);
  EXPECT_EQ(material_of(scene, "table").reflectance[0], 0.5f);
  EXPECT_EQ(material_of(scene, "hill").reflectance[0], 0.2f);
  EXPECT_NEAR(areas(scene).at("hill"), 1.0, rounding);
}

TEST(ReadHoneybee, ViewsAreCameras) {
  json of = model();
  of["properties"]["radiance"]["views"] = json::array({{{"identifier", "desk"},
                                                        {"position", {2, 1, 1.2}},
                                                        {"direction", {0, -1, 0}},
                                                        {"up_vector", {0, 0, 1}},
                                                        {"view_type", "h"},
                                                        {"h_size", 180},
                                                        {"v_size", 180},
                                                        {"shift", nullptr}}});
  const Scene scene = read(of);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].name, "desk");
  EXPECT_EQ(scene.cameras[0].position, Eigen::Vector3d(2, 1, 1.2));
  EXPECT_EQ(scene.cameras[0].direction, Eigen::Vector3d(0, -1, 0));
}

TEST(ReadHoneybee, SensorGridsAreInMetres) {
  json of = model();
  of["units"] = "Centimeters";
  of["properties"]["radiance"]["sensor_grids"] = {
      {{"identifier", "plane"},
       {"sensors", {{{"pos", {100, 200, 80}}, {"dir", {0, 0, 2}}}, {{"pos", {150, 200, 80}}}}}}};
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("model.hbjson", of.dump()));
  const auto grids = read_sensor_grids(scene);
  ASSERT_EQ(grids.size(), 1u);
  EXPECT_EQ(grids[0].name, "plane");
  ASSERT_EQ(grids[0].positions.size(), 2u);
  EXPECT_TRUE(grids[0].positions[0].isApprox(Eigen::Vector3d(1, 2, 0.8)));
  EXPECT_EQ(grids[0].directions[0], Eigen::Vector3d::UnitZ());
  EXPECT_EQ(grids[0].directions[1], Eigen::Vector3d::UnitZ());
}

TEST(ReadHoneybee, FaultsAreSentences) {
  EXPECT_NE(error_of("{\"type\": \"Model\",\n oops}").find(":2:"), std::string::npos);
  EXPECT_NE(error_of("{\"type\": \"Room\"}").find("a Honeybee model, whose type is 'Model'"),
            std::string::npos);
  json of = model();
  of["units"] = "Cubits";
  EXPECT_NE(error_of(of.dump()).find("'units' is 'Cubits'; write Meters"), std::string::npos);
  of = model(json::array());
  EXPECT_NE(error_of(of.dump()).find("the model has no surfaces"), std::string::npos);
}

std::string losses_of(const json& of) {
  std::string all;
  for (const std::string& loss : read(of).losses) all += loss + "\n";
  return all;
}

TEST(ReadHoneybee, WhatCannotBeReadIsLeftOutByName) {
  json of = model();
  json& boundary = of["rooms"][0]["faces"][3]["geometry"]["boundary"];
  boundary.erase(0);
  boundary.erase(0);
  EXPECT_NE(losses_of(of).find("rooms[0].faces[3].geometry: 'boundary' has 2 points"),
            std::string::npos);
  EXPECT_EQ(read(of).surfaces.size(), 7u);
  of = model();
  of["properties"]["radiance"]["modifiers"] =
      json::array({{{"type", "Velvet"}, {"identifier", "seat"}}});
  EXPECT_NE(losses_of(of).find("modifier 'seat' is of the type 'Velvet'"), std::string::npos);
  of = model();
  const json corner = json::array({0, 0, 0}), triangle = json::array({0, 1, 2});
  const json geometry = {{"vertices", json::array({corner})}, {"faces", json::array({triangle})}};
  of["shade_meshes"] = json::array({{{"identifier", "hill"}, {"geometry", geometry}}});
  EXPECT_NE(losses_of(of).find("'faces' has the vertex 1; there are 1"), std::string::npos);
}

TEST(ReadHoneybee, ModifiersThatAreMissingAreNamed) {
  json of = model();
  of["rooms"][0]["faces"][1]["properties"]["radiance"]["modifier"] = "gone";
  const Scene scene = read(of);
  EXPECT_EQ(material_of(scene, "north").reflectance[0], 0.5f);
  ASSERT_FALSE(scene.losses.empty());
  EXPECT_NE(scene.losses[0].find("'gone'"), std::string::npos);
}

}  // namespace
}  // namespace lightwell::read_honeybee_test
