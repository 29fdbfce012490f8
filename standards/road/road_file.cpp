#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "scene/io/nearest_name.h"
#include "scene/io/text_file.h"
#include "scene/io/toml/toml_document.h"
#include "scene/io/toml/toml_value.h"
#include "standards/road/road.h"

namespace lightwell {
namespace {

constexpr double widest_road = 200.0, farthest_mast = 500.0, lowest = 2.0, highest = 100.0;  // m

std::filesystem::path beside(const TomlValue& name) {
  return (name.file().parent_path() / name.name()).lexically_normal();
}

RoadClass read_class(const TomlValue& value) {
  const std::string key = value.name();
  if (auto known = find_road_class(key)) return *known;
  std::vector<std::string> keys;
  for (const RoadClass& one : road_classes()) keys.push_back(one.key);
  value.fail(fmt::format(
      "is '{}', which is no class of EN 13201-2.{} There are M1 to M6, C0 to C5, P1 to P7, SC1 to "
      "SC9 and EV1 to EV6",
      key, did_you_mean(key, keys)));
}

// One class, or an array of several.
std::vector<RoadClass> read_classes(const TomlTable& table) {
  std::vector<RoadClass> classes;
  const auto given = table.find("class");
  if (!given) return classes;
  if (!given->is_array()) return {read_class(*given)};
  for (const TomlValue& value : given->elements("class")) classes.push_back(read_class(value));
  if (classes.empty()) given->fail("is empty; name a class such as \"M3\", or leave the key out");
  return classes;
}

RTable read_surface(const TomlValue& value) {
  const std::string name = value.name();
  const std::vector<std::string> known = r_table_names();
  if (std::ranges::find(known, name) != known.end()) return standard_r_table(name);
  if (is_file(beside(value))) return read_r_table(beside(value));
  value.fail(fmt::format("is '{}', which is neither {} nor a file.{}", name, quoted_list(known),
                         did_you_mean(name, known)));
}

void read_carriageway(const TomlValue& value, Road& road) {
  const TomlTable table = value.table({"width", "lanes", "oncoming_lanes", "driving_side", "median",
                                       "class", "surface", "q0", "wet_surface", "hours"});
  constexpr double least_width = 1.0;
  constexpr std::int64_t most_lanes = 16;
  road.width = table.require("width").number_within(least_width, widest_road);
  road.lanes = static_cast<int>(table.require("lanes").integer_within(1, most_lanes));
  if (const auto lanes = table.find("oncoming_lanes")) {
    road.oncoming = static_cast<int>(lanes->integer_within(0, road.lanes));
  }
  if (const auto side = table.find("driving_side")) {
    road.drives_on_left = side->one_of({"right", "left"}) == "left";
  }
  if (const auto width = table.find("median")) {
    road.median = width->number_within(0.0, widest_road);
  }
  road.classes = read_classes(table);
  const auto surface = table.find("surface");
  road.surface = surface ? read_surface(*surface) : standard_r_table("R3");
  if (const auto q0 = table.find("q0")) {
    road.surface = scaled_to(road.surface, q0->number_within(darkest_road, lightest_road));
  }
  if (const auto wet = table.find("wet_surface")) road.wet_surface = read_surface(*wet);
  constexpr double hours_of_year = 8784.0;
  if (const auto hours = table.find("hours")) {
    road.hours = hours->number_within(0.0, hours_of_year);
  }
}

RoadArrangement read_arrangement(const TomlValue& value) {
  const std::string word =
      value.one_of({"single-right", "single-left", "opposite", "staggered", "median"});
  for (const auto arrangement : {RoadArrangement::single_left, RoadArrangement::opposite,
                                 RoadArrangement::staggered, RoadArrangement::median}) {
    if (word == arrangement_name(arrangement)) return arrangement;
  }
  return RoadArrangement::single_right;
}

std::shared_ptr<const LuminaireFile> read_road_luminaire(const TomlTable& table) {
  const TomlValue name = table.require("file");
  constexpr std::int64_t most_sets = 100;
  const auto set = table.find("lamp_set");
  LuminaireFile file =
      read_luminaire(beside(name), set ? static_cast<int>(set->integer_within(1, most_sets)) : 1);
  if (file.is_radiometric) name.fail("is in watts; roads need candela");
  if (!(file.flux() > 0.0)) name.fail("has no light");
  return std::make_shared<const LuminaireFile>(std::move(file));
}

void read_road_luminaires(const TomlValue& value, RoadLuminaires& luminaires) {
  const TomlTable table =
      value.table({"file", "lamp_set", "lumens", "watts", "street_side", "arrangement", "spacing",
                   "height", "overhang", "tilt", "maintenance"});
  luminaires.file = read_road_luminaire(table);
  luminaires.watts = luminaires.file->watts;
  if (const auto lumens = table.find("lumens")) {
    luminaires.flux_factor = lumens->positive() / luminaires.file->flux();
    luminaires.watts = 0.0;  // another lamp takes another power
  }
  if (const auto watts = table.find("watts")) luminaires.watts = watts->positive();
  constexpr double turn = 360.0, quarter = 90.0, least_factor = 0.01;
  if (const auto plane = table.find("street_side")) {
    luminaires.street_side = plane->number_within(0.0, turn);
  }
  if (const auto word = table.find("arrangement")) {
    luminaires.arrangement = read_arrangement(*word);
  }
  luminaires.spacing = table.require("spacing").number_within(1.0, farthest_mast);
  luminaires.height = table.require("height").number_within(lowest, highest);
  if (const auto overhang = table.find("overhang")) {
    luminaires.overhang = overhang->number_within(-highest, highest);
  }
  if (const auto tilt = table.find("tilt")) {
    luminaires.tilt = tilt->number_within(-quarter, quarter);
  }
  if (const auto factor = table.find("maintenance")) {
    luminaires.maintenance = factor->number_within(least_factor, 1.0);
  }
}

void read_strips(const TomlValue& strips, Road& road) {
  if (!strips.is_array()) strips.fail("must be an array of tables; write [[strips]]");
  for (const TomlValue& value : strips.elements("strip")) {
    const auto given = value.member("name");
    RoadStrip strip{.name =
                        given ? given->name() : fmt::format("strip {}", road.strips.size() + 1)};
    const TomlTable table = value.renamed(fmt::format("strip '{}'", strip.name))
                                .table({"name", "side", "gap", "width", "class"});
    if (strip.name == "carriageway" ||
        std::ranges::find(road.strips, strip.name, &RoadStrip::name) != road.strips.end()) {
      table.fail("has a name that is taken; give each strip its own");
    }
    strip.is_left = table.require("side").one_of({"right", "left"}) == "left";
    constexpr double narrowest = 0.1;
    strip.width = table.require("width").number_within(narrowest, widest_road);
    if (const auto gap = table.find("gap")) strip.gap = gap->number_within(0.0, widest_road);
    strip.classes = read_classes(table);
    for (const RoadClass& one : strip.classes) {
      if (one.is_of_luminance()) {
        table.fail(
            fmt::format("has class {}, which is of luminance and for carriageways; use a C "
                        "or P class",
                        one.key));
      }
    }
    road.strips.push_back(std::move(strip));
  }
}

// Requires a class that limits something, and one of luminance where a wet surface is given.
void require_limits(const TomlTable& document, const Road& road) {
  bool has_class = !road.classes.empty();
  bool has_limits = std::ranges::any_of(road.classes, &RoadClass::has_limits);
  for (const RoadStrip& strip : road.strips) {
    has_class = has_class || !strip.classes.empty();
    has_limits = has_limits || std::ranges::any_of(strip.classes, &RoadClass::has_limits);
  }
  const TomlValue at = document.require("road");
  if (!has_class) at.fail("has no class, and no strip has one; write class = \"M3\"");
  if (!has_limits) {
    at.fail(
        "is of class P7 alone, which has no limit, so there is nothing to hold the road to; name "
        "another class, such as \"P6\"");
  }
  if (road.wet_surface && std::ranges::none_of(road.classes, &RoadClass::is_of_luminance)) {
    at.fail(
        "has a wet_surface, of which M classes alone limit a figure, and no M class; name one, or "
        "leave 'wet_surface' out");
  }
}

// Refuses strips that overlap on one side, or reach over the median.
void require_apart(const TomlTable& document, const Road& road) {
  constexpr double rounding = 1e-9;  // m
  for (const bool is_left : {false, true}) {
    std::vector<const RoadStrip*> side;
    for (const RoadStrip& strip : road.strips) {
      if (strip.is_left == is_left) side.push_back(&strip);
    }
    std::ranges::sort(side, {}, &RoadStrip::gap);
    for (std::size_t i = 1; i < side.size(); ++i) {
      const double end = side[i - 1]->gap + side[i - 1]->width;
      if (!(side[i]->gap < end - rounding)) continue;
      document.require("strips").fail(fmt::format(
          "overlap: '{}' reaches to {:g} m from the carriageway, and '{}' begins at {:g} m; make "
          "its 'gap' {:g} or more",
          side[i - 1]->name, end, side[i]->name, side[i]->gap, end));
    }
    if (side.empty() || !road.has_median_at(is_left)) continue;
    const double end = side.back()->gap + side.back()->width;
    if (end > road.median + rounding) {
      document.require("strips").fail(fmt::format(
          "reach over the median: '{}' ends {:g} m from the carriageway, and the median "
          "is {:g} m wide; make the strip narrower",
          side.back()->name, end, road.median));
    }
  }
}

void require_consistent_road(const TomlTable& document, const Road& road) {
  const bool has_median = road.median > 0.0;
  if (has_median != (road.luminaires.arrangement == RoadArrangement::median)) {
    document.require(has_median ? "road" : "luminaires")
        .fail(has_median ? "has a median, in which the luminaires must stand; write arrangement = "
                           "\"median\", or leave 'median' out and compute each carriageway alone"
                         : "stand in a median; write its width as 'median' in [road]");
  }
  if (has_median && road.oncoming > 0) {
    document.require("road").fail(
        "has a median, so its other carriageway has the oncoming traffic; leave 'oncoming_lanes' "
        "out");
  }
  require_limits(document, road);
  require_apart(document, road);
}

}  // namespace

const char* arrangement_name(RoadArrangement arrangement) {
  switch (arrangement) {
    case RoadArrangement::single_left:
      return "single-left";
    case RoadArrangement::opposite:
      return "opposite";
    case RoadArrangement::staggered:
      return "staggered";
    case RoadArrangement::median:
      return "median";
    case RoadArrangement::single_right:
      break;
  }
  return "single-right";
}

std::vector<LuminaireRowPlace> luminaire_rows(const Road& road) {
  const RoadLuminaires& luminaires = road.luminaires;
  const LuminaireRowPlace right{luminaires.overhang, 1.0};
  const LuminaireRowPlace left{road.width - luminaires.overhang, -1.0};
  switch (luminaires.arrangement) {
    case RoadArrangement::single_left:
      return {left};
    case RoadArrangement::opposite:
      return {right, left};
    case RoadArrangement::staggered:
      return {right, {left.y, left.facing, 0.5 * luminaires.spacing}};
    case RoadArrangement::median:
      // The other carriageway lies across the median, to the right where traffic keeps left.
      if (road.drives_on_left) return {right, {-road.median - right.y, -1.0}};
      return {left, {road.width + road.median + right.y, 1.0}};
    case RoadArrangement::single_right:
      break;
  }
  return {right};
}

Road read_road(const std::filesystem::path& path) {
  const TextFile file(path);
  const toml::table root = parse_toml(file);
  const TomlTable document =
      TomlValue(file.path(), root, "").table({"title", "road", "luminaires", "strips"});
  Road road{.file = path, .title = path.stem().string()};
  if (const auto title = document.find("title")) road.title = title->name();
  read_carriageway(document.require("road"), road);
  read_road_luminaires(document.require("luminaires"), road.luminaires);
  if (const auto strips = document.find("strips")) read_strips(*strips, road);
  require_consistent_road(document, road);
  return road;
}

}  // namespace lightwell
