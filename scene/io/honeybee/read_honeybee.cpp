#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "scene/errors.h"
#include "scene/io/honeybee/honeybee_model.h"
#include "scene/io/honeybee/honeybee_modifiers.h"
#include "scene/io/honeybee/honeybee_shapes.h"
#include "scene/io/radiance/radiance_view.h"
#include "scene/io/radiance/text/radiance_bands.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"
#include "scene/io/sensor_grids.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

RadianceView view_of(const JsonObject& view, double metres_per_unit) {
  RadianceView result;
  const auto vector = [&](const char* key, const Eigen::Vector3d& otherwise) {
    return view.point(key).value_or(otherwise);
  };
  const std::string type = view.string_or("view_type", "v");
  if (type.size() != 1 || std::string_view("vlahsc").find(type[0]) == std::string_view::npos) {
    view.fail(fmt::format("'view_type' is '{}'; write one of v, l, a, h, s, c", type));
  }
  result.type = type[0];
  const double of_length = type == "l" ? metres_per_unit : 1.0;
  result.point = metres_per_unit * vector("position", result.point);
  result.direction = vector("direction", result.direction);
  result.up = vector("up_vector", result.up);
  result.horizontal = of_length * view.number_or("h_size", 60.0);
  result.vertical = of_length * view.number_or("v_size", 60.0);
  result.shift = view.number_or("shift", 0.0);
  result.lift = view.number_or("lift", 0.0);
  result.fore = metres_per_unit * view.number_or("fore_clip", 0.0);
  result.aft = metres_per_unit * view.number_or("aft_clip", 0.0);
  return result;
}

void add_views(const JsonObject& radiance, double metres_per_unit, Scene& scene, Remarks& remarks) {
  for (const JsonObject& view : radiance.objects("views")) {
    const std::string name = view.string_or("identifier", view.place());
    remarks.attempt("Views that cannot be used were left out", name, [&] {
      add_radiance_camera(view_of(view, metres_per_unit), name, {.file = &scene.file, .line = 0},
                          scene, remarks);
    });
  }
}

}  // namespace

nlohmann::json read_honeybee_document(const std::filesystem::path& file) {
  const TextFile text(file);
  nlohmann::json document = parse_json(file, text.text());
  const JsonObject model(file, document, "");
  const std::string type = model.string_or("type", "");
  if (type != "Model") {
    model.fail(fmt::format("the type is '{}'; a Honeybee model, whose type is 'Model', can be read",
                           type));
  }
  return document;
}

double metres_of(const JsonObject& model) {
  using Unit = std::pair<std::string_view, double>;
  constexpr std::array units = {Unit{"Meters", 1.0}, Unit{"Millimeters", 1e-3},
                                Unit{"Centimeters", 1e-2}, Unit{"Feet", 0.3048},
                                Unit{"Inches", 0.0254}};
  const std::string given = model.string_or("units", "Meters");
  for (const auto& [name, metres] : units) {
    if (given == name) return metres;
  }
  model.fail(fmt::format("'units' is '{}'; write Meters, Millimeters, Centimeters, Feet or Inches",
                         given));
}

Scene read_honeybee(const std::filesystem::path& path) {
  const nlohmann::json document = read_honeybee_document(path);
  const JsonObject model(path, document, "");
  const double metres = metres_of(model);
  Scene scene;
  scene.file = path;
  scene.title = model.string_or("display_name", model.string_or("identifier", ""));
  scene.metres_per_unit = metres;
  scene.bands = radiance_bands();
  Remarks remarks;
  const auto radiance = radiance_properties(model);
  HoneybeeModifiers modifiers(scene.file, radiance, scene, remarks);
  HoneybeeShapes shapes(metres, modifiers, scene, remarks);
  shapes.add(model);
  if (scene.surfaces.empty()) {
    fail_without_surfaces(path, "the model has no surfaces that can be read", remarks);
  }
  if (radiance) add_views(*radiance, metres, scene, remarks);
  finish_scene(shapes.repairs(), remarks, scene);
  return scene;
}

std::vector<SensorGrid> read_honeybee_grids(const std::filesystem::path& path) {
  const nlohmann::json document = read_honeybee_document(path);
  const JsonObject model(path, document, "");
  const double metres = metres_of(model);
  std::vector<SensorGrid> grids;
  const auto radiance = radiance_properties(model);
  if (!radiance) return grids;
  for (const JsonObject& from : radiance->objects("sensor_grids")) {
    SensorGrid grid{.name = from.string_or("identifier", from.place()),
                    .group = from.string_or("group_identifier", "")};
    for (const JsonObject& sensor : from.objects("sensors")) {
      const auto position = sensor.point("pos");
      if (!position) sensor.fail("has no 'pos'");
      const Eigen::Vector3d direction = sensor.point("dir").value_or(Eigen::Vector3d::UnitZ());
      if (!(direction.stableNorm() > 0.0)) sensor.fail("'dir' has no length");
      grid.positions.push_back(metres * *position);
      grid.directions.push_back(direction.stableNormalized());
    }
    grids.push_back(std::move(grid));
  }
  return grids;
}

}  // namespace lightwell
