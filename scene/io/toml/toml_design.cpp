#include "scene/io/toml/toml_design.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/io/luminaires/luminaire_file.h"
#include "scene/io/matches_glob.h"
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

GridQuantity read_quantity(const TomlValue& value) {
  const std::string word = value.one_of({"planar", "vertical", "cylindrical", "semicylindrical"});
  return word == "vertical"          ? GridQuantity::vertical
         : word == "cylindrical"     ? GridQuantity::cylindrical
         : word == "semicylindrical" ? GridQuantity::semicylindrical
                                     : GridQuantity::planar;
}

Eigen::AlignedBox3d read_part(const TomlValue& value, double metres) {
  const TomlTable table = value.table({"min", "max"});
  const Eigen::AlignedBox3d part(metres * table.require("min").vector(),
                                 metres * table.require("max").vector());
  if (part.isEmpty()) value.fail("has a min that exceeds its max; exchange them");
  return part;
}

std::vector<Eigen::Vector3d> read_loop(const TomlValue& value, double metres) {
  std::vector<Eigen::Vector3d> loop;
  for (const TomlValue& corner : value.elements("corner")) {
    loop.push_back(metres * corner.vector());
  }
  if (loop.size() < 3) value.fail("has fewer than three corners; give at least three");
  return loop;
}

// A polygon and its holes, in place of the surface's outline.
std::vector<std::vector<Eigen::Vector3d>> read_outline(const TomlTable& table, double metres) {
  std::vector<std::vector<Eigen::Vector3d>> loops;
  const auto outline = table.find("outline");
  const auto holes = table.find("holes");
  if (outline && table.has("part")) {
    outline->fail("is a second statement of the area, beside 'part'; give one of them");
  }
  if (holes && !outline) holes->fail("need an 'outline' about them");
  if (outline) loops.push_back(read_loop(*outline, metres));
  if (!holes) return loops;
  for (const TomlValue& hole : holes->elements("hole")) loops.push_back(read_loop(hole, metres));
  return loops;
}

// The grid of a name among `grids`; `where` says where they stand.
int find_grid(const TomlValue& value, const std::vector<CalculationGrid>& grids,
              const char* where = "") {
  const std::string name = value.name();
  std::vector<std::string> known;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    if (grids[i].name == name) return static_cast<int>(i);
    known.push_back(grids[i].name);
  }
  value.fail(fmt::format("is '{}', and there is no [[grids]] table of that name{}.{}", name, where,
                         did_you_mean(name, known)));
}

CalculationGrid read_grid(const TomlValue& value, const Scene& scene,
                          const std::vector<CalculationGrid>& earlier) {
  const auto given = value.member("name");
  CalculationGrid grid{.name = given ? given->name() : fmt::format("grid{}", earlier.size() + 1)};
  const TomlTable table = value.renamed(fmt::format("grid '{}'", grid.name))
                              .table({"name", "surface", "height", "margin", "spacing", "part",
                                      "outline", "holes", "leaves_out", "measures", "facing"});
  if (std::ranges::find(earlier, grid.name, &CalculationGrid::name) != earlier.end()) {
    table.fail("has the name of another grid; give each its own");
  }
  const double metres = scene.metres_per_unit;
  grid.surface = find_surface(table.require("surface"), scene);
  if (const auto height = table.find("height")) grid.height = metres * height->number_at_least(0);
  if (const auto margin = table.find("margin")) grid.margin = metres * margin->number_at_least(0);
  if (const auto spacing = table.find("spacing")) grid.spacing = metres * spacing->positive();
  if (const auto part = table.find("part")) grid.part = read_part(*part, metres);
  grid.outline = read_outline(table, metres);
  if (const auto names = table.find("leaves_out")) {
    for (const TomlValue& name : names->elements("grid")) {
      grid.leaves_out.push_back(find_grid(name, earlier, " before it"));
    }
  }
  if (const auto measures = table.find("measures")) grid.quantity = read_quantity(*measures);
  const bool has_direction =
      grid.quantity == GridQuantity::vertical || grid.quantity == GridQuantity::semicylindrical;
  if (has_direction != table.has("facing")) {
    table.fail(has_direction ? "measures in one direction, and needs 'facing', such as [1, 0, 0]"
                             : "has 'facing', which only a grid that measures \"vertical\" or "
                               "\"semicylindrical\" has; remove it");
  }
  if (const auto facing = table.find("facing")) {
    grid.facing = facing->vector();
    if (!(grid.facing.norm() > 0.0)) facing->fail("is zero; give a direction");
    grid.facing.normalize();
  }
  return grid;
}

std::vector<CalculationGrid> read_grids(const TomlValue& grids, const Scene& scene) {
  if (!grids.is_array()) grids.fail("must be an array of tables; write [[grids]]");
  std::vector<CalculationGrid> result;
  for (const TomlValue& value : grids.elements("grid")) {
    result.push_back(read_grid(value, scene, result));
  }
  return result;
}

std::vector<std::string> read_observers(const TomlValue& value, const Scene& scene) {
  std::vector<std::string> names, known;
  for (const Camera& camera : scene.cameras) known.push_back(camera.name);
  for (const TomlValue& observer : value.elements("observer")) {
    names.push_back(observer.name());
    if (std::ranges::find(known, names.back()) == known.end()) {
      observer.fail(fmt::format("is '{}', and there is no camera of that name.{}", names.back(),
                                did_you_mean(names.back(), known)));
    }
  }
  return names;
}

EmergencyArea read_emergency(const TomlValue& value) {
  const std::string word = value.one_of({"escape route", "open area", "high-risk task area"});
  return word == "escape route" ? EmergencyArea::escape_route
         : word == "open area"  ? EmergencyArea::open_area
                                : EmergencyArea::high_risk_task_area;
}

// Reads the keys of an area for an activity, but for its grid.
void read_activity(const TomlTable& table, const Scene& scene,
                   const std::vector<CalculationGrid>& grids, DesignArea& area) {
  area.activity = table.require("activity").name();
  if (const auto raised = table.find("raised")) area.is_raised = raised->boolean();
  if (const auto grid = table.find("surround")) area.surround = find_grid(*grid, grids);
  if (const auto grid = table.find("background")) area.background = find_grid(*grid, grids);
  if (const auto walls = table.find("walls")) area.walls = matching_surfaces(*walls, scene);
  if (const auto ceiling = table.find("ceiling")) {
    area.ceilings = matching_surfaces(*ceiling, scene);
  }
  if (const auto names = table.find("observers")) area.observers = read_observers(*names, scene);
  if (const auto height = table.find("eye_height")) {
    area.eye_height = scene.metres_per_unit * height->positive();
  }
}

TelevisionLimits read_television(const TomlValue& value) {
  const TomlTable table = value.table({"mean", "uniformity", "contrast", "gradient"});
  const auto share = [&](const char* key) {
    const auto given = table.find(key);
    return given ? given->number_within(0.0, 1.0) : 0.0;
  };
  constexpr double percent = 100.0;
  const auto mean = table.find("mean"), gradient = table.find("gradient");
  return {.mean = mean ? mean->number_at_least(0.0) : 0.0,
          .uniformity = share("uniformity"),
          .contrast = share("contrast"),
          .gradient = gradient ? gradient->number_within(0.0, percent) : 0.0};
}

// Reads the keys of an area for a sport, but for its grid.
void read_sport(const TomlTable& table, const Scene& scene, DesignArea& area) {
  SportUse use{.sport = table.require("sport").name()};
  const std::string number = table.require("class").one_of({"I", "II", "III"});
  use.number = static_cast<int>(number.size());
  if (const auto rho = table.find("reflectance")) {
    constexpr double darkest = 0.01;
    use.reflectance = rho->number_within(darkest, 1.0);
  }
  if (const auto names = table.find("observers")) area.observers = read_observers(*names, scene);
  if (const auto names = table.find("cameras")) use.cameras = read_observers(*names, scene);
  if (const auto height = table.find("camera_height")) {
    use.camera_height = scene.metres_per_unit * height->number_at_least(0.0);
  }
  if (const auto limits = table.find("television")) use.television = read_television(*limits);
  area.sport = std::move(use);
}

DesignArea read_area(const TomlValue& value, const Scene& scene,
                     const std::vector<CalculationGrid>& grids,
                     const std::vector<DesignArea>& earlier) {
  const auto given = value.member("name");
  DesignArea area{.name = given ? given->name() : fmt::format("area{}", earlier.size() + 1)};
  const TomlValue named = value.renamed(fmt::format("area '{}'", area.name));
  if (std::ranges::find(earlier, area.name, &DesignArea::name) != earlier.end()) {
    named.fail("has the name of another area; give each its own");
  }
  if (named.member("sport")) {
    const TomlTable table = named.table({"name", "sport", "class", "grid", "observers",
                                         "reflectance", "cameras", "camera_height", "television"});
    area.grid = find_grid(table.require("grid"), grids);
    read_sport(table, scene, area);
    return area;
  }
  if (!named.member("emergency")) {
    const TomlTable table =
        named.table({"name", "activity", "raised", "grid", "surround", "background", "walls",
                     "ceiling", "observers", "eye_height"});
    area.grid = find_grid(table.require("grid"), grids);
    read_activity(table, scene, grids, area);
    return area;
  }
  const TomlTable table = named.table({"name", "emergency", "grid", "usual_lux"});
  area.grid = find_grid(table.require("grid"), grids);
  area.emergency = read_emergency(table.require("emergency"));
  const bool needs_usual = area.emergency == EmergencyArea::high_risk_task_area;
  if (needs_usual != table.has("usual_lux")) {
    table.fail(needs_usual ? "needs 'usual_lux', the maintained illuminance without emergency"
                           : "has 'usual_lux', which only a high-risk task area has; remove it");
  }
  if (const auto usual = table.find("usual_lux")) area.usual_lux = usual->positive();
  return area;
}

std::vector<DesignArea> read_areas(const TomlValue& areas, const Scene& scene,
                                   const std::vector<CalculationGrid>& grids) {
  if (!areas.is_array()) areas.fail("must be an array of tables; write [[areas]]");
  std::vector<DesignArea> result;
  for (const TomlValue& value : areas.elements("area")) {
    result.push_back(read_area(value, scene, grids, result));
  }
  return result;
}

MaintenanceParts read_maintenance(const TomlValue& value) {
  const TomlTable table = value.table({"lamp_flux", "lamp_survival", "luminaire", "room"});
  const auto part = [&](const char* key) {
    constexpr double least = 1e-3;  // a factor of 0 would report darkness
    const auto given = table.find(key);
    return given ? given->number_within(least, 1.0) : 1.0;
  };
  return {.lamp_flux = part("lamp_flux"),
          .lamp_survival = part("lamp_survival"),
          .luminaire = part("luminaire"),
          .room = part("room")};
}

LightingUse read_use(const TomlValue& value, const Scene& scene) {
  const TomlTable table =
      value.table({"surface", "daylight_hours", "night_hours", "daylight", "occupancy",
                   "constant_illuminance", "standby_watts", "charging_watts", "charging_hours"});
  constexpr double hours_of_a_year = 8760.0;
  const auto number = [&](const char* key, double most, double usual) {
    const auto given = table.find(key);
    return given ? given->number_within(0.0, most) : usual;
  };
  constexpr double any = 1e9;  // no building has as much
  LightingUse use{.surface = find_surface(table.require("surface"), scene),
                  .daylight_hours = number("daylight_hours", hours_of_a_year, 0.0),
                  .night_hours = number("night_hours", hours_of_a_year, 0.0),
                  .daylight = number("daylight", 1.0, 1.0),
                  .occupancy = number("occupancy", 1.0, 1.0),
                  .standby_watts = number("standby_watts", any, 0.0),
                  .charging_watts = number("charging_watts", any, 0.0),
                  .charging_hours = number("charging_hours", hours_of_a_year, 0.0)};
  if (const auto dimmed = table.find("constant_illuminance")) {
    use.is_constant_illuminance = dimmed->boolean();
  }
  if (use.daylight_hours + use.night_hours > hours_of_a_year) {
    table.fail("has more hours of use than the 8760 of a year; check both numbers of hours");
  }
  return use;
}

ReportHeading read_heading(const TomlValue& report) {
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

}  // namespace

void read_toml_design(const TomlValue& document, const Scene& scene, LightingDesign& design) {
  if (const auto grids = document.member("grids")) {
    design.grids = read_grids(*grids, scene);
    design.areas.clear();  // they name earlier grids by index
  }
  if (const auto areas = document.member("areas")) {
    design.areas = read_areas(*areas, scene, design.grids);
  }
  if (const auto parts = document.member("maintenance")) {
    design.maintenance = read_maintenance(*parts);
  }
  if (const auto use = document.member("energy")) design.use = read_use(*use, scene);
  if (const auto report = document.member("report")) design.heading = read_heading(*report);
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

std::vector<int> matching_surfaces(const TomlValue& patterns, const Scene& scene) {
  std::vector<char> taken(scene.surfaces.size(), 0);
  const auto values =
      patterns.is_array() ? patterns.elements("pattern") : std::vector<TomlValue>{patterns};
  for (const TomlValue& value : values) {
    const std::string glob = value.name();
    bool matches_any = false;
    std::vector<std::string> known;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
      const Surface& surface = scene.surfaces[s];
      const std::string& material =
          scene.materials[static_cast<std::size_t>(surface.material)].name;
      if (matches_glob(glob, surface.name) || matches_glob(glob, material)) {
        matches_any = true;
        taken[s] = 1;
      }
      known.push_back(surface.name);
    }
    if (!matches_any) {
      value.fail(fmt::format("is '{}', and no surface or material of the scene matches that.{}",
                             glob, did_you_mean(glob, known)));
    }
  }
  std::vector<int> surfaces;
  for (std::size_t s = 0; s < taken.size(); ++s) {
    if (taken[s] != 0) surfaces.push_back(static_cast<int>(s));
  }
  if (surfaces.empty()) patterns.fail("is empty; name at least one surface");
  return surfaces;
}

}  // namespace lightwell
