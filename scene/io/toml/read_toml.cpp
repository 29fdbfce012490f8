#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "scene/errors.h"
#include "scene/io/clean_names.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"
#include "scene/io/round_facets.h"
#include "scene/io/scene_text.h"
#include "scene/io/text_file.h"
#include "scene/io/toml/toml_camera.h"
#include "scene/io/toml/toml_design.h"
#include "scene/io/toml/toml_document.h"
#include "scene/io/toml/toml_lamps.h"
#include "scene/io/toml/toml_materials.h"
#include "scene/io/toml/toml_motions.h"
#include "scene/io/toml/toml_sky.h"
#include "scene/io/toml/toml_surfaces.h"
#include "scene/io/toml/toml_value.h"
#include "scene/io/toml/toml_windows.h"
#include "scene/limits.h"
#include "scene/place_at_rest.h"

namespace lightwell {
namespace {

double metres_in(const std::string& unit) {
  if (unit == "mm") return 0.001;
  if (unit == "cm") return 0.01;
  if (unit == "in") return 0.0254;
  if (unit == "ft") return 0.3048;
  return 1.0;
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

// Materials of the states of windows. States change no solution; reading them reports their errors
// early.
std::vector<int> materials_of_windows(const TomlTable& document, const Scene& scene) {
  std::vector<int> used;
  const auto windows = document.find("windows");
  if (!windows) return used;
  for (const WindowGroup& group : read_toml_windows(*windows, scene, scene.materials).groups) {
    for (const WindowState& state : group.states) {
      if (state.material) used.push_back(*state.material);
    }
  }
  return used;
}

void read_surfaces(const TomlTable& document, Scene& scene) {
  const auto surfaces = document.find("surfaces");
  if (!surfaces) document.fail("the scene has no surfaces; add at least one [[surfaces]] table");
  if (!surfaces->is_array()) surfaces->fail("must be an array of tables; write [[surfaces]]");
  std::size_t number = 0;
  TomlSurfaces read(scene);
  for (const auto& surface : surfaces->elements("surface")) read.add(surface, ++number);
  if (number == 0) surfaces->fail("is empty; add at least one [[surfaces]] table");
  if (scene.surfaces.empty()) {
    surfaces->fail("have no area, so that no light can fall on them: " + scene.losses.front());
  }
}

void read_lamps(const TomlTable& document, const TomlBands& bands, Scene& scene) {
  const auto lamps = document.find("lamps");
  if (!lamps) return;
  if (!lamps->is_array()) lamps->fail("must be an array of tables; write [[lamps]]");
  std::size_t number = 0;
  TomlProjectors projectors(bands);
  for (const auto& lamp : lamps->elements("lamp")) {
    read_toml_lamp(lamp, ++number, bands, projectors, scene);
  }
}

// Returns for each camera whether the document gives its shutter.
std::vector<char> read_cameras(const TomlTable& document, Scene& scene) {
  std::vector<char> have_shutter;
  const auto cameras = document.find("cameras");
  if (!cameras) return have_shutter;
  if (!cameras->is_array()) cameras->fail("must be an array of tables; write [[cameras]]");
  std::set<std::string> names;
  for (const auto& camera : cameras->elements("camera")) {
    scene.cameras.push_back(read_toml_camera(camera, scene.cameras.size() + 1, scene, names));
    have_shutter.push_back(camera.member("shutter") ? 1 : 0);
  }
  return have_shutter;
}

// Reads a whole scene; `add_surfaces` stands in place of [[surfaces]] unless empty.
Scene read_document(const TomlValue& all, const AddSurfaces& add_surfaces) {
  const TomlTable document =
      all.table({"title", "unit", "bands", "materials", "motions", "surfaces", "lamps", "sky",
                 "cameras", "grids", "areas", "maintenance", "energy", "report", "windows"});
  Scene scene{.file = all.file().has_filename() ? all.file() : std::filesystem::path()};
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
  if (add_surfaces) {
    add_surfaces(scene);
  } else {
    read_surfaces(document, scene);
  }
  spread_power(materials, materials_of_windows(document, scene), scene);
  drop_unused_uv(scene);
  Remarks remarks;
  remark_pictures_without_uv(scene, remarks);
  remarks.report_to(scene);

  read_lamps(document, bands, scene);
  settle_toml_motions(document, read_cameras(document, scene), scene);
  // Grids and headings do not affect the light; reading them here reports their errors early.
  LightingDesign design;
  read_toml_design(document.value(), scene, design);
  validate(scene);
  return scene;
}

LightingDesign read_lighting(const TomlValue& all, const Scene& scene) {
  LightingDesign design;
  read_toml_design(all, scene, design);
  if (const auto lamps = all.member("lamps")) {
    LuminaireFiles files;
    for (const auto& lamp : lamps->elements("lamp")) read_toml_lamp_design(lamp, files, design);
  }
  return design;
}

// A name in the folder, which has no file name of its own.
std::filesystem::path place_of(const SceneText& text) {
  return text.folder / "";
}

// The files that a text names, as far as it may name them.
FilesRead files_of(const SceneText& text) {
  return text.references == References::inside_folder ? FilesRead::inside_folder_of(place_of(text))
                                                      : FilesRead();
}

}  // namespace

Scene read_toml(const std::filesystem::path& path) {
  const TextFile file(path);
  const toml::table root = parse_toml(file);
  return read_document(TomlValue(file.path(), root, ""), {});
}

Scene read_scene_text(const SceneText& text, const AddSurfaces& add_surfaces) {
  const std::filesystem::path place = place_of(text);
  const FilesRead read = files_of(text);
  const toml::table root = parse_toml_text(text.text);
  Scene scene = read_document(TomlValue(place, root, ""), add_surfaces);
  scene.files = read.files();
  clean_names(scene);
  replace_by_facets(scene);
  return scene;
}

LightingDesign read_lighting_text(const SceneText& text, const Scene& scene) {
  const std::filesystem::path place = place_of(text);
  const toml::table root = parse_toml_text(text.text);
  return read_lighting(TomlValue(place, root, ""), scene);
}

OperatedWindows read_windows_text(const SceneText& text, const Scene& scene) {
  const std::filesystem::path place = place_of(text);
  const FilesRead read = files_of(text);
  const toml::table root = parse_toml_text(text.text);
  const auto windows = TomlValue(place, root, "").member("windows");
  return windows ? read_toml_windows(*windows, scene, scene.materials) : OperatedWindows{};
}

Camera read_camera_text(const std::string& text, const Scene& scene) {
  const std::filesystem::path place;
  const toml::table root = parse_toml_text(text);
  const TomlValue value(place, root, "");
  const Scene metres{.motions = scene.motions};
  std::set<std::string> names;
  Camera camera = read_toml_camera(value, 1, metres, names);
  if (scene.motions.empty()) return camera;
  const double instant = scene.motions.front().rest_time;
  if (!value.member("shutter")) {
    camera.shutter_open = camera.shutter_close = instant;
  } else if (camera.shutter_middle() != instant) {
    value.fail(
        fmt::format("camera '{}' has a shutter whose middle is at {:g} s, and light is solved for "
                    "{:g} s; give it a shutter about that time",
                    camera.name, camera.shutter_middle(), instant));
  }
  place_at_rest(scene, camera);
  return camera;
}

LightingDesign read_toml_lighting(const Scene& scene) {
  const TextFile file(scene.file);
  const toml::table root = parse_toml(file);
  return read_lighting(TomlValue(file.path(), root, ""), scene);
}

void read_design_tables(const std::filesystem::path& path, const Scene& scene,
                        LightingDesign& design) {
  const TextFile file(path);
  const toml::table root = parse_toml(file);
  const TomlTable document =
      TomlValue(file.path(), root, "").table({"grids", "areas", "maintenance", "energy", "report"});
  read_toml_design(document.value(), scene, design);
}

}  // namespace lightwell
