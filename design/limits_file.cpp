#include "design/limits_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "scene/io/text_file.h"
#include "scene/io/toml/toml_document.h"
#include "scene/io/toml/toml_value.h"
#include "scene/utf8.h"

namespace lightwell {
namespace {

constexpr std::array<LimitKind, 5> limits_of_grids = {
    LimitKind::mean_at_least, LimitKind::mean_at_most, LimitKind::uniformity_at_least,
    LimitKind::least_at_least, LimitKind::greatest_at_most};

std::string origin_of(const TomlValue& value) {
  return std::string(trimmed(value.located("")));
}

double limit_value(LimitKind kind, const TomlValue& value) {
  const double number = value.positive();
  if (kind == LimitKind::uniformity_at_least && number > 1.0) {
    value.fail("is above 1; U_0 is the least illuminance over the mean");
  }
  return number;
}

// Refuses limits of one grid that contradict each other, since E_min <= E_m <= E_max.
void require_consistent(const TomlTable& table) {
  for (const char* const low : {"least_at_least", "mean_at_least"}) {
    for (const char* const high : {"mean_at_most", "greatest_at_most"}) {
      const auto least = table.find(low), most = table.find(high);
      if (!least || !most || least->number() <= most->number()) continue;
      table.fail(fmt::format("cannot be met: {}, {:g} lx, is above {}, {:g} lx", low,
                             least->number(), high, most->number()));
    }
  }
}

void read_grid_limits(const TomlValue& value, LightingLimits& read) {
  const auto given = value.member("grid");
  const TomlValue named =
      given ? value.renamed(fmt::format("limits of grid '{}'", given->name())) : value;
  const TomlTable table =
      named.table({"grid", "mean_at_least", "mean_at_most", "uniformity_at_least", "least_at_least",
                   "greatest_at_most"});
  const std::string grid = table.require("grid").name();
  bool any = false;
  for (const LimitKind kind : limits_of_grids) {
    const auto limit = table.find(limit_key(kind));
    if (!limit) continue;
    any = true;
    read.limits.push_back({.kind = kind,
                           .place = grid,
                           .value = limit_value(kind, *limit),
                           .origin = origin_of(table.value())});
  }
  if (!any) {
    table.fail(
        "limit nothing; give at least one of mean_at_least, mean_at_most, uniformity_at_least, "
        "least_at_least, greatest_at_most");
  }
  require_consistent(table);
}

void read_glare_limit(const TomlValue& value, LightingLimits& read) {
  const auto given = value.member("observer");
  const TomlValue named =
      given ? value.renamed(fmt::format("glare of observer '{}'", given->name())) : value;
  const TomlTable table = named.table({"observer", "ugr_at_most"});
  constexpr double most = 50.0;  // the ratings of CIE 117 end at 31
  read.limits.push_back({.kind = LimitKind::ugr_at_most,
                         .place = table.require("observer").name(),
                         .value = table.require("ugr_at_most").number_within(1.0, most),
                         .origin = origin_of(table.value())});
}

// The tables of an array, which `read_one` takes one by one; no two have the same `key`.
void read_tables(const TomlTable& document, const char* array, const char* key,
                 void (*read_one)(const TomlValue&, LightingLimits&), LightingLimits& read) {
  const auto tables = document.find(array);
  if (!tables) return;
  if (!tables->is_array()) {
    tables->fail(fmt::format("must be an array of tables; write [[{}]]", array));
  }
  std::set<std::string> names;
  for (const TomlValue& value : tables->elements("table")) {
    read_one(value, read);
    const std::string name = value.member(key)->name();
    if (!names.insert(name).second) {
      value.fail(fmt::format("is of {} '{}' as an earlier one is; write one [[{}]] table for each",
                             key, name, array));
    }
  }
}

void read_dimming(const TomlValue& value, LightingLimits& read) {
  const TomlTable table = value.table({"least", "groups"});
  if (const auto least = table.find("least")) read.least_level = least->number_within(0.0, 1.0);
  const auto groups = table.find("groups");
  if (!groups) return;
  for (const TomlValue& group : groups->elements("group")) {
    WordedGroup worded{.origin = origin_of(group)};
    for (const TomlValue& name : group.elements("name")) worded.names.push_back(name.name());
    if (worded.names.empty()) group.fail("is empty; name the luminaires that dim together");
    read.groups.push_back(std::move(worded));
  }
}

// The axes of a word such as "xy".
std::vector<int> read_axes(const TomlValue& value) {
  const std::string word = value.name();
  std::vector<int> axes;
  for (const char letter : word) {
    if (letter < 'x' || letter > 'z') {
      value.fail(fmt::format(
          "is '{}'; write the axes that luminaires may be moved along, such as \"xy\"", word));
    }
    axes.push_back(letter - 'x');
  }
  std::ranges::sort(axes);
  if (std::ranges::adjacent_find(axes) != axes.end()) {
    value.fail(fmt::format("is '{}'; write each axis once", word));
  }
  return axes;
}

std::vector<double> read_bounds(const TomlValue& value, std::size_t axes) {
  std::vector<double> bounds;
  for (const TomlValue& bound : value.elements("bound")) bounds.push_back(bound.number());
  if (bounds.size() != axes) {
    value.fail(fmt::format(
        "must have as many numbers as there are axes, {}, in the order x, y, z; it has {}", axes,
        bounds.size()));
  }
  return bounds;
}

void read_move(const TomlValue& value, LightingLimits& read) {
  const TomlTable table = value.table({"luminaires", "axes", "lowest", "highest", "apart"});
  WordedMove move{.origin = origin_of(value)};
  const TomlValue names = table.require("luminaires");
  for (const TomlValue& name : names.elements("name")) move.names.push_back(name.name());
  if (move.names.empty()) names.fail("is empty; name the luminaires that may be moved");
  move.axes = read_axes(table.require("axes"));
  move.lowest = read_bounds(table.require("lowest"), move.axes.size());
  const TomlValue highest = table.require("highest");
  move.highest = read_bounds(highest, move.axes.size());
  for (std::size_t i = 0; i < move.axes.size(); ++i) {
    if (move.lowest[i] <= move.highest[i]) continue;
    highest.fail(fmt::format("has {:g}, which is below the lowest place, {:g}", move.highest[i],
                             move.lowest[i]));
  }
  if (const auto apart = table.find("apart")) move.apart = apart->number_at_least(0.0);
  read.moves.push_back(std::move(move));
}

}  // namespace

const char* limit_key(LimitKind kind) {
  switch (kind) {
    case LimitKind::mean_at_least:
      return "mean_at_least";
    case LimitKind::mean_at_most:
      return "mean_at_most";
    case LimitKind::least_at_least:
      return "least_at_least";
    case LimitKind::greatest_at_most:
      return "greatest_at_most";
    case LimitKind::uniformity_at_least:
      return "uniformity_at_least";
    case LimitKind::ugr_at_most:
      break;
  }
  return "ugr_at_most";
}

LightingLimits read_limits(const std::filesystem::path& path) {
  const TextFile file(path);
  const toml::table root = parse_toml(file);
  const TomlTable document =
      TomlValue(file.path(), root, "").table({"maintenance", "limits", "glare", "dimming", "move"});
  LightingLimits read;
  if (const auto factor = document.find("maintenance")) {
    read.maintenance_factor = factor->positive();
    if (*read.maintenance_factor > 1.0) {
      factor->fail("is above 1; it is the share of the first light that is left, such as 0.8");
    }
  }
  read_tables(document, "limits", "grid", &read_grid_limits, read);
  read_tables(document, "glare", "observer", &read_glare_limit, read);
  if (read.limits.empty()) {
    document.fail("there are no limits; add at least one [[limits]] or [[glare]] table");
  }
  if (const auto dimming = document.find("dimming")) read_dimming(*dimming, read);
  if (const auto moves = document.find("move")) {
    if (!moves->is_array()) moves->fail("must be an array of tables; write [[move]]");
    for (const TomlValue& move : moves->elements("table")) read_move(move, read);
  }
  return read;
}

}  // namespace lightwell
