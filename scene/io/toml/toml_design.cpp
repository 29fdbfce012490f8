#include "scene/io/toml/toml_design.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/io/luminaires/luminaire_file.h"
#include "scene/io/nearest_name.h"

namespace lightwell {
namespace {

int find_surface(const TomlValue& value, const Scene& scene) {
  const std::string name = value.name();
  std::vector<std::string> known;
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    if (scene.surfaces[i].name == name) return static_cast<int>(i);
    known.push_back(scene.surfaces[i].name);
  }
  value.fail(fmt::format("is '{}', and there is no surface of that name.{}", name,
                         did_you_mean(name, known)));
}

}  // namespace

std::vector<CalculationGrid> read_toml_grids(const TomlValue& grids, const Scene& scene) {
  if (!grids.is_array()) grids.fail("must be an array of tables; write [[grids]]");
  std::vector<CalculationGrid> result;
  for (const TomlValue& value : grids.elements("grid")) {
    const auto given = value.member("name");
    CalculationGrid grid{.name = given ? given->name() : fmt::format("grid{}", result.size() + 1)};
    const TomlTable table = value.renamed(fmt::format("grid '{}'", grid.name))
                                .table({"name", "surface", "height", "margin", "spacing"});
    const auto is_taken = [&](const CalculationGrid& other) { return other.name == grid.name; };
    if (std::ranges::any_of(result, is_taken)) {
      table.fail("has the name of another grid; give each its own");
    }
    const double metres = scene.metres_per_unit;
    grid.surface = find_surface(table.require("surface"), scene);
    if (const auto height = table.find("height")) grid.height = metres * height->number_at_least(0);
    if (const auto margin = table.find("margin")) grid.margin = metres * margin->number_at_least(0);
    if (const auto spacing = table.find("spacing")) grid.spacing = metres * spacing->positive();
    result.push_back(std::move(grid));
  }
  return result;
}

ReportHeading read_toml_heading(const TomlValue& report) {
  const TomlTable table = report.table({"project", "client", "author", "date", "remarks"});
  const auto text = [&](const char* key) {
    const auto value = table.find(key);
    return value ? value->string() : std::string();
  };
  return {.project = text("project"),
          .client = text("client"),
          .author = text("author"),
          .date = text("date"),
          .remarks = text("remarks")};
}

void read_toml_lamp_design(const TomlValue& lamp, LuminaireFiles& files, LightingDesign& design) {
  double watts = 0.0, luminous_height = 0.0;
  SharedLuminaireFile luminaire;
  if (const auto file = lamp.member("file")) {
    const auto set = lamp.member("lamp_set");
    const auto path = (file->file().parent_path() / file->name()).lexically_normal();
    const int number = set ? static_cast<int>(set->integer_within(1, 20)) : 1;
    SharedLuminaireFile& read = files[{path, number}];
    if (!read) read = std::make_shared<const LuminaireFile>(read_luminaire(path, number));
    luminaire = read;
    if (!lamp.member("lumens")) watts = luminaire->watts;
    if (!lamp.member("opening")) luminous_height = luminaire->opening_height;
  }
  if (const auto known = lamp.member("watts")) watts = known->positive();
  design.watts.push_back(watts);
  design.luminous_height.push_back(luminous_height);
  design.files.push_back(std::move(luminaire));
}

}  // namespace lightwell
