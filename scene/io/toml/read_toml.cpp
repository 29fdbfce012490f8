#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"
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

}  // namespace

Scene read_toml(const std::filesystem::path& path) {
  const TextFile file(path);
  const toml::table root = parse_toml(file);
  const TomlValue all(file.path(), root, "");
  const TomlTable document =
      all.table({"title", "unit", "bands", "materials", "motions", "surfaces", "lamps", "sky",
                 "cameras", "grids", "areas", "maintenance", "energy", "report", "windows"});
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
  if (scene.surfaces.empty()) {
    surfaces->fail("have no area, so that no light can fall on them: " + scene.losses.front());
  }
  spread_power(materials, materials_of_windows(document, scene), scene);
  drop_unused_uv(scene);
  Remarks remarks;
  remark_pictures_without_uv(scene, remarks);
  remarks.report_to(scene);

  if (const auto lamps = document.find("lamps")) {
    if (!lamps->is_array()) lamps->fail("must be an array of tables; write [[lamps]]");
    number = 0;
    TomlProjectors projectors(bands);
    for (const auto& lamp : lamps->elements("lamp")) {
      read_toml_lamp(lamp, ++number, bands, projectors, scene);
    }
  }
  std::vector<char> have_shutter;
  if (const auto cameras = document.find("cameras")) {
    if (!cameras->is_array()) cameras->fail("must be an array of tables; write [[cameras]]");
    number = 0;
    std::set<std::string> names;
    for (const auto& camera : cameras->elements("camera")) {
      scene.cameras.push_back(read_toml_camera(camera, ++number, scene, names));
      have_shutter.push_back(camera.member("shutter") ? 1 : 0);
    }
  }
  settle_toml_motions(document, have_shutter, scene);
  // Grids and headings do not affect the light; reading them here reports their errors early.
  LightingDesign design;
  read_toml_design(document.value(), scene, design);
  validate(scene);
  return scene;
}

LightingDesign read_toml_lighting(const Scene& scene) {
  const TextFile file(scene.file);
  const toml::table root = parse_toml(file);
  const TomlValue all(file.path(), root, "");
  LightingDesign design;
  read_toml_design(all, scene, design);
  if (const auto lamps = all.member("lamps")) {
    LuminaireFiles files;
    for (const auto& lamp : lamps->elements("lamp")) read_toml_lamp_design(lamp, files, design);
  }
  return design;
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
