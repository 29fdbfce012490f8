#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "scene/errors.h"
#include "scene/io/camera_name.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"
#include "scene/io/text_file.h"
#include "scene/io/toml/toml_design.h"
#include "scene/io/toml/toml_lamps.h"
#include "scene/io/toml/toml_materials.h"
#include "scene/io/toml/toml_motions.h"
#include "scene/io/toml/toml_sky.h"
#include "scene/io/toml/toml_surfaces.h"
#include "scene/io/toml/toml_value.h"
#include "scene/limits.h"

namespace lightwell {
namespace {

// The parser calls itself for each part of a dotted key, and has no limit. Keys of a scene have few
// parts.
void refuse_deep_keys(const TextFile& file) {
  constexpr std::ptrdiff_t most_parts = 100;
  file.for_each_line([&](int line, std::string_view text) {
    constexpr std::string_view in_keys =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.\"'[] \t";
    const std::string_view key = text.substr(0, text.find_first_not_of(in_keys));
    if (std::ranges::count(key, '.') < most_parts) return;
    throw InputError(fmt::format("{}:{}: the key has more than {} parts", file.path().string(),
                                 line, most_parts));
  });
}

toml::table parse(const TextFile& file) {
  refuse_deep_keys(file);
  try {
    return toml::parse(file.text(), file.path().string());
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}:{}: {}", file.path().string(), error.source().begin.line,
                                 error.source().begin.column, error.description()));
  }
}

double metres_in(const std::string& unit) {
  if (unit == "mm") return 0.001;
  if (unit == "cm") return 0.01;
  if (unit == "in") return 0.0254;
  if (unit == "ft") return 0.3048;
  return 1.0;
}

Eigen::Vector3d read_view_direction(const TomlTable& table, const Eigen::Vector3d& position) {
  const auto given = table.present({"direction", "look_at"});
  if (given.size() != 1) table.fail("needs exactly one of 'direction' and 'look_at'");
  const TomlValue value = table.require(given[0]);
  const Eigen::Vector3d direction =
      given[0] == "look_at" ? Eigen::Vector3d(value.vector() - position) : value.vector();
  if (!(direction.stableNorm() > 0.0)) {
    value.fail(given[0] == "look_at" ? "is the camera's own position; look at another point"
                                     : "has no length; give the direction to look in");
  }
  return direction.stableNormalized();
}

// An f-number refers to a film 36 mm wide, so the focal length follows from fov.
void read_toml_lens(const TomlTable& table, double metres_per_unit, Camera& camera) {
  const auto given = table.present({"aperture_radius", "f_number"});
  if (given.size() > 1) {
    table.require(given[1]).fail("is a second statement of the aperture, after 'aperture_radius'");
  }
  if (given.empty()) {
    for (const auto& key : table.present({"focus_distance", "blades"})) {
      table.require(key).fail(
          "needs a lens; give 'f_number' or 'aperture_radius', or remove it: a pinhole camera "
          "shows everything sharp");
    }
    return;
  }
  const TomlValue aperture = table.require(given[0]);
  if (given[0] == "aperture_radius") {
    camera.lens_radius = metres_per_unit * aperture.positive();
  } else {
    constexpr double half_film = 0.018;  // m
    const double focal_length =
        half_film / std::tan(0.5 * camera.fov_degrees * std::numbers::pi / 180.0);
    camera.lens_radius = 0.5 * focal_length / aperture.positive();
  }
  if (!std::isfinite(camera.lens_radius)) aperture.fail("is no aperture");
  camera.focus_distance = metres_per_unit * table.require("focus_distance").positive();
  if (const auto blades = table.find("blades")) {
    camera.blades = static_cast<int>(blades->integer_within(3, max_blades));
  }
}

// `names`: of the cameras before this one.
Camera read_camera(const TomlValue& value, std::size_t number, const Scene& scene,
                   std::set<std::string>& names) {
  const auto given = value.member("name");
  Camera camera{.name = given ? given->name() : fmt::format("camera{}", number)};
  if (camera.name.find_first_of("/\\") != std::string::npos || camera.name.starts_with('.')) {
    given->fail(
        fmt::format("is '{}'; pictures are called after it, so it must not contain a slash "
                    "or start with a dot",
                    camera.name));
  }
  if (camera.name.size() > longest_camera_name) {
    given->fail(fmt::format("is of {} bytes; pictures are called after it, so give at most {}",
                            camera.name.size(), longest_camera_name));
  }
  const TomlTable table =
      value.renamed(fmt::format("camera '{}'", camera.name))
          .table({"name", "position", "direction", "look_at", "up", "fov", "size",
                  "aperture_radius", "f_number", "focus_distance", "blades", "shutter", "motion"});
  if (!names.insert(camera.name).second) {
    table.fail("has a name that an earlier camera has; give it another");
  }
  const Eigen::Vector3d position = table.require("position").vector();
  camera.position = scene.metres_per_unit * position;
  camera.direction = read_view_direction(table, position);
  const auto up = table.find("up");
  const Eigen::Vector3d upwards = up ? Eigen::Vector3d(up->vector().stableNormalized()) : camera.up;
  const Eigen::Vector3d across = upwards - upwards.dot(camera.direction) * camera.direction;
  if (!(across.norm() > parallel_sine)) {
    (up ? *up : table.value())
        .fail(up ? "has no length or is parallel to the viewing direction; choose another"
                 : "looks along [0, 1, 0]; say with 'up' which way is up in the picture");
  }
  camera.up = across.normalized();
  if (const auto fov = table.find("fov")) {
    camera.fov_degrees = fov->number();
    if (!(camera.fov_degrees > 0.0 && camera.fov_degrees < 180.0)) {
      fov->fail(fmt::format("is {}; it must lie between 0 and 180 degrees", camera.fov_degrees));
    }
  }
  if (const auto size = table.find("size")) {
    const auto pixels = size->elements("number");
    if (pixels.size() != 2) size->fail("must be two whole numbers [width, height]");
    camera.width = static_cast<int>(pixels[0].integer_within(1, max_picture_edge));
    camera.height = static_cast<int>(pixels[1].integer_within(1, max_picture_edge));
  }
  read_toml_lens(table, scene.metres_per_unit, camera);
  if (const auto shutter = table.find("shutter")) read_toml_shutter(*shutter, camera);
  if (const auto motion = table.find("motion")) camera.motion = find_toml_motion(*motion, scene);
  return camera;
}

std::vector<TomlMaterial> read_toml_materials(const TomlTable& document, const TomlBands& bands,
                                              Scene& scene) {
  std::vector<TomlMaterial> materials;
  PictureFiles pictures;
  if (const auto tables = document.find("materials")) {
    for (const auto& [name, value] : tables->members("material")) {
      materials.push_back(read_toml_material(value, name, bands, pictures));
      scene.materials.push_back(materials.back().material);
    }
  }
  return materials;
}

}  // namespace

Scene read_toml(const std::filesystem::path& path) {
  const TextFile file(path);
  const toml::table root = parse(file);
  const TomlValue all(file.path(), root, "");
  const TomlTable document = all.table({"title", "unit", "bands", "materials", "motions",
                                        "surfaces", "lamps", "sky", "cameras", "grids", "report"});
  Scene scene{.file = path};
  if (const auto title = document.find("title")) scene.title = title->string();
  if (const auto unit = document.find("unit")) {
    scene.unit_name = unit->one_of({"mm", "cm", "m", "in", "ft"});
  }
  scene.metres_per_unit = metres_in(scene.unit_name);
  const auto bands_table = document.find("bands");
  const TomlBands bands = bands_table ? read_toml_bands(*bands_table) : TomlBands{};
  scene.bands = bands.bands;
  const auto materials = read_toml_materials(document, bands, scene);
  if (const auto motions = document.find("motions")) {
    scene.motions = read_toml_motions(*motions, scene.metres_per_unit);
  }

  if (const auto sky = document.find("sky")) scene.sky = read_toml_sky(*sky, bands);
  const auto surfaces = document.find("surfaces");
  if (!surfaces) document.fail("the scene has no surfaces; add at least one [[surfaces]] table");
  if (!surfaces->is_array()) surfaces->fail("must be an array of tables; write [[surfaces]]");
  std::size_t number = 0;
  TomlSurfaces read(scene);
  for (const auto& surface : surfaces->elements("surface")) read.add(surface, ++number);
  if (number == 0) surfaces->fail("is empty; add at least one [[surfaces]] table");
  spread_power(materials, scene);
  drop_unused_uv(scene);
  Remarks remarks;
  remark_pictures_without_uv(scene, remarks);
  remarks.report_to(scene);

  if (const auto lamps = document.find("lamps")) {
    if (!lamps->is_array()) lamps->fail("must be an array of tables; write [[lamps]]");
    number = 0;
    for (const auto& lamp : lamps->elements("lamp")) read_toml_lamp(lamp, ++number, bands, scene);
  }
  std::vector<char> have_shutter;
  if (const auto cameras = document.find("cameras")) {
    if (!cameras->is_array()) cameras->fail("must be an array of tables; write [[cameras]]");
    number = 0;
    std::set<std::string> names;
    for (const auto& camera : cameras->elements("camera")) {
      scene.cameras.push_back(read_camera(camera, ++number, scene, names));
      have_shutter.push_back(camera.member("shutter") ? 1 : 0);
    }
  }
  settle_toml_motions(document, have_shutter, scene);
  // Grids and headings do not affect the light; reading them here reports their errors early.
  if (const auto grids = document.find("grids")) read_toml_grids(*grids, scene);
  if (const auto report = document.find("report")) read_toml_heading(*report);
  validate(scene);
  return scene;
}

LightingDesign read_lighting_design(const Scene& scene) {
  if (lower_extension(scene.file) != ".toml") return {};
  const TextFile file(scene.file);
  const toml::table root = parse(file);
  const TomlValue all(file.path(), root, "");
  LightingDesign design;
  if (const auto grids = all.member("grids")) design.grids = read_toml_grids(*grids, scene);
  if (const auto report = all.member("report")) design.heading = read_toml_heading(*report);
  if (const auto lamps = all.member("lamps")) {
    LuminaireFiles files;
    for (const auto& lamp : lamps->elements("lamp")) read_toml_lamp_design(lamp, files, design);
  }
  return design;
}

}  // namespace lightwell
