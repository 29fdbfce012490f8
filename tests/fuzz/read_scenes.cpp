// Targets of scenes and of the meshes that scenes name.
#include <fmt/format.h>

#include "scene/errors.h"
#include "scene/io/lighting_design.h"
#include "scene/io/mesh_file.h"
#include "scene/io/mitsuba/mitsuba_serialized.h"
#include "scene/io/read_scene.h"
#include "scene/io/sensor_grids.h"
#include "scene/io/weather/weather_file.h"
#include "scene/io/window_states.h"
#include "scene/scene.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace lightwell::fuzz {

Scene read_scene_file(const std::string& name, std::string_view bytes) {
  Scene scene = read_scene(input_file(name, bytes));
  validate(scene);
  scene_hash(scene);
  return scene;
}

void read_wea_year(std::string_view bytes) {
  read_weather(input_file("year.wea", bytes));
}

// One input is the heading and the first two hours; the other hours of the year follow.
void read_epw_year(std::string_view bytes) {
  constexpr int first = 2, hours = 8760;
  std::string text(bytes);
  for (int n = first; n < hours; ++n) {
    const auto [month, day, hour] = hour_of_year(n, false);
    text += fmt::format("1999,{},{},{},0,,,,,,,,,,0,0\n", month, day, hour + 1);
  }
  read_weather(input_file("year.epw", text));
}

void read_toml_scene(std::string_view bytes) {
  read_lighting_design(read_scene_file("scene.toml", bytes));
}

void read_honeybee_parts(std::string_view bytes) {
  const Scene scene = read_scene_file("model.hbjson", bytes);
  read_sensor_grids(scene);
  read_windows(scene);
}

void read_stf_design(std::string_view bytes) {
  read_lighting_design(read_scene_file("house.stf", bytes));
}

// One input is both files, so that names of materials meet: lines behind "#mtl" are the MTL.
void read_obj_and_mtl(std::string_view bytes) {
  constexpr std::string_view border = "#mtl\n";
  const std::size_t at = bytes.find(border);
  const std::string_view mtl =
      at == std::string_view::npos ? std::string_view() : bytes.substr(at + border.size());
  input_file("scene.mtl", mtl);
  read_scene_file("scene.obj", bytes.substr(0, at));
}

// The first two meshes of the file: the table at its end tells where the second is.
void read_serialized(std::string_view bytes) {
  const auto path = input_file("mesh.serialized", bytes);
  for (const int number : {1, 0}) {
    try {
      FilePolygons polygons;
      validate(read_serialized_file(path, number, MeshMaterials::with_uv, polygons,
                                    MeshFronts::from_normals));
    } catch (const InputError&) {
      if (number == 0) throw;
    }
  }
}

}  // namespace lightwell::fuzz
