#include "scene/io/toml/toml_windows.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "scene/errors.h"
#include "scene/io/comma_fields.h"
#include "scene/io/dashed_pair.h"
#include "scene/io/nearest_name.h"
#include "scene/io/text_file.h"
#include "scene/io/toml/toml_design.h"
#include "scene/io/toml/toml_document.h"
#include "scene/io/toml/toml_materials.h"
#include "scene/io/weather/weather_file.h"

namespace lightwell {
namespace {

constexpr std::size_t usual_hours = 8760, leap_hours = 8784;

// A state of the group by its name.
int state_of_name(const TomlValue& value, const WindowGroup& group) {
  const std::string name = value.name();
  std::vector<std::string> known;
  for (std::size_t s = 0; s < group.states.size(); ++s) {
    if (group.states[s].name == name) return static_cast<int>(s);
    known.push_back(group.states[s].name);
  }
  value.fail(fmt::format("is '{}', and the group has no such state; it has {}.{}", name,
                         quoted_list(known), did_you_mean(name, known)));
}

void read_window_day(const TomlTable& span, const char* key, int& month, int& day) {
  const auto value = span.find(key);
  if (!value) return;
  const std::string text = value->string();
  const auto date = dashed_pair(text);
  if (!date || number_of({.month = date->first, .day = date->second}, true) < 0) {
    value->fail(fmt::format("is '{}'; write month and day, such as \"05-31\"", text));
  }
  std::tie(month, day) = *date;
}

ScheduleSpan read_schedule_span(const TomlValue& value, const WindowGroup& group) {
  const TomlTable table = value.table({"state", "from", "to", "hours"});
  ScheduleSpan span{.state = state_of_name(table.require("state"), group)};
  read_window_day(table, "from", span.from_month, span.from_day);
  read_window_day(table, "to", span.to_month, span.to_day);
  if (const auto hours = table.find("hours")) {
    const std::string text = hours->string();
    const auto pair = dashed_pair(text);
    if (!pair || pair->first < 0 || pair->second < 0 || pair->first > hours_a_day ||
        pair->second > hours_a_day || pair->first == pair->second ||
        pair->first - pair->second == hours_a_day) {
      hours->fail(fmt::format(
          "is '{}'; write two different hours from 0 to 24, such as \"8-18\", or \"0-24\"", text));
    }
    std::tie(span.from_hour, span.to_hour) = *pair;
  }
  return span;
}

// The states of a file that has one line for each hour of the year, its last field the state.
std::vector<int> read_schedule_file(const TomlValue& value, const WindowGroup& group) {
  const auto path = (value.file().parent_path() / value.name()).lexically_normal();
  const TextFile file(path);
  std::map<std::string, int, std::less<>> states;
  std::vector<std::string> known;
  for (const WindowState& state : group.states) {
    states.emplace(state.name, static_cast<int>(states.size()));
    known.push_back(state.name);
  }
  std::vector<int> hours;
  file.for_each_line([&](int line, std::string_view text) {
    if (trimmed(text).empty()) return;
    const std::string_view name = comma_fields(text).back();
    if (const auto found = states.find(name); found != states.end()) {
      hours.push_back(found->second);
    } else if (line > 1 || name != "state") {
      file.fail(line,
                fmt::format("'{}' is no state of the windows '{}', which have {}.{}", excerpt(name),
                            group.name, quoted_list(known), did_you_mean(name, known)));
    }
  });
  if (hours.size() != usual_hours && hours.size() != leap_hours) {
    throw InputError(fmt::format(
        "{}: the schedule of the windows '{}' has {} hours; give a line for each hour of the year, "
        "{}, or {} for a leap year",
        path.string(), group.name, hours.size(), usual_hours, leap_hours));
  }
  return hours;
}

void read_schedule(const TomlTable& table, WindowGroup& group) {
  const TomlValue schedule = table.require("schedule");
  if (!schedule.is_array()) {
    group.hours = read_schedule_file(schedule, group);
    return;
  }
  for (const TomlValue& span : schedule.elements("span")) {
    group.spans.push_back(read_schedule_span(span, group));
  }
  if (group.spans.empty()) schedule.fail("is empty; give at least one span with a state");
}

void read_operation(const TomlTable& table, WindowGroup& group) {
  const auto refuse = [&](const char* key, const char* owner) {
    if (const auto value = table.find(key)) {
      value->fail(fmt::format("belongs to operation = \"{}\"; remove one of the two", owner));
    }
  };
  const auto operation = table.find("operation");
  const std::string word =
      operation ? operation->one_of({"always", "schedule", "lm-83", "illuminance"}) : "lm-83";
  if (word != "always") refuse("state", "always");
  if (word != "schedule") refuse("schedule", "schedule");
  if (word != "illuminance") {
    refuse("close_above", "illuminance");
    refuse("open_below", "illuminance");
  }
  if (word == "always" || word == "schedule") {
    if (const auto closed = table.find("closed")) {
      closed->fail("belongs to operation = \"lm-83\" or \"illuminance\"; remove one of the two");
    }
  } else if (const auto closed = table.find("closed")) {
    group.state = state_of_name(*closed, group);
    if (group.state == 0) closed->fail("is the first state, which is the open one; name another");
  }
  if (word == "always") {
    group.operation = WindowOperation::always;
    group.state = state_of_name(table.require("state"), group);
  } else if (word == "schedule") {
    group.operation = WindowOperation::schedule;
    read_schedule(table, group);
  } else if (word == "illuminance") {
    group.operation = WindowOperation::illuminance;
    group.close_above = table.require("close_above").positive();
    const auto open = table.find("open_below");
    group.open_below = open ? open->number_within(0.0, group.close_above) : group.close_above;
  }
}

int index_of_material(const TomlValue& value, const std::vector<Material>& materials) {
  const std::string name = value.name();
  std::vector<std::string> known;
  for (std::size_t m = 0; m < materials.size(); ++m) {
    if (materials[m].name == name) return static_cast<int>(m);
    known.push_back(materials[m].name);
  }
  value.fail(fmt::format("is '{}', and there is no material of that name.{}", name,
                         did_you_mean(name, known)));
}

// Reads the states of a group; their materials are indices into `materials`.
void read_states(const TomlValue& states, const std::vector<Material>& materials,
                 WindowGroup& group) {
  for (const TomlValue& value : states.elements("state")) {
    const TomlTable table = value.table({"name", "material"});
    WindowState state{.name = table.require("name").name()};
    const auto has_name = [&](const WindowState& other) { return other.name == state.name; };
    if (std::ranges::any_of(group.states, has_name)) {
      table.fail(
          fmt::format("is named '{}' like an earlier one; give it a name of its own", state.name));
    }
    if (const auto material = table.find("material")) {
      if (group.states.empty()) {
        material->fail(
            "is not for the first state, which is the scene as it stands; remove the key, or put a "
            "state without it first");
      }
      state.material = index_of_material(*material, materials);
    } else if (!group.states.empty()) {
      table.fail(fmt::format(
          "'{}' lacks the key 'material'; only the first state, the scene as it stands, needs none",
          state.name));
    }
    group.states.push_back(std::move(state));
  }
  if (group.states.size() < 2) {
    states.fail("must have at least two states, the open one first; add another");
  }
  if (group.states.size() > static_cast<std::size_t>(most_window_states)) {
    states.fail(
        fmt::format("has {} states; give at most {}", group.states.size(), most_window_states));
  }
}

// Refuses a group that shares its name or a surface with an earlier one.
void refuse_shared(const TomlTable& table, const WindowGroup& group, const Scene& scene,
                   const std::vector<WindowGroup>& earlier) {
  for (const WindowGroup& other : earlier) {
    if (other.name == group.name) {
      table.fail("has the name of an earlier group; give each its own");
    }
    for (const int surface : group.surfaces) {
      if (!std::ranges::binary_search(other.surfaces, surface)) continue;
      table.fail(fmt::format(
          "has the surface '{}', which the windows '{}' have, too; a surface belongs to one group",
          scene.surfaces[static_cast<std::size_t>(surface)].name, other.name));
    }
  }
}

// Reads a group of windows after those that `read` has.
WindowGroup read_group(const TomlValue& value, const Scene& scene, const OperatedWindows& read) {
  const auto given = value.member("name");
  WindowGroup group{.name =
                        given ? given->name() : fmt::format("windows{}", read.groups.size() + 1)};
  const TomlTable table = value.renamed(fmt::format("windows '{}'", group.name))
                              .table({"name", "surfaces", "states", "operation", "state", "closed",
                                      "schedule", "close_above", "open_below"});
  group.surfaces = matching_surfaces(table.require("surfaces"), scene);
  refuse_shared(table, group, scene, read.groups);
  read_states(table.require("states"), read.materials, group);
  read_operation(table, group);
  return group;
}

}  // namespace

bool ScheduleSpan::contains(int month, int day, int hour) const {
  constexpr int days = 100;  // more than those of a month
  const int at = month * days + day, from = from_month * days + from_day,
            to = to_month * days + to_day;
  const bool in_days = from <= to ? at >= from && at <= to : at >= from || at <= to;
  const bool in_hours = from_hour < to_hour ? hour >= from_hour && hour < to_hour
                                            : hour >= from_hour || hour < to_hour;
  return in_days && in_hours;
}

OperatedWindows read_toml_windows(const TomlValue& windows, const Scene& scene,
                                  const std::vector<Material>& materials) {
  if (!windows.is_array()) windows.fail("must be an array of tables; write [[windows]]");
  OperatedWindows read{.materials = materials};
  for (const TomlValue& value : windows.elements("windows")) {
    WindowGroup group = read_group(value, scene, read);
    read.groups.push_back(std::move(group));
  }
  return read;
}

OperatedWindows read_toml_windows(const Scene& scene) {
  const TextFile file(scene.file);
  const toml::table root = parse_toml(file);
  const auto windows = TomlValue(file.path(), root, "").member("windows");
  return windows ? read_toml_windows(*windows, scene, scene.materials) : OperatedWindows{};
}

OperatedWindows read_windows(const std::filesystem::path& path, const Scene& scene) {
  const TextFile file(path);
  const toml::table root = parse_toml(file);
  const TomlTable document = TomlValue(file.path(), root, "").table({"materials", "windows"});
  const auto windows = document.find("windows");
  if (!windows) document.fail("there are no windows; add at least one [[windows]] table");
  std::vector<Material> materials;
  if (const auto tables = document.find("materials")) {
    if (!scene.bands.wavelengths_nm.empty()) {
      tables->fail(
          "is of a scene with wavelengths; put these materials into the scene file, whose [bands] "
          "they follow");
    }
    TomlBands bands;
    bands.bands = scene.bands;
    PictureFiles pictures;
    for (const auto& [name, value] : tables->members("material")) {
      materials.push_back(read_toml_material(value, name, bands, pictures).material);
    }
  }
  materials.insert(materials.end(), scene.materials.begin(), scene.materials.end());
  OperatedWindows read = read_toml_windows(*windows, scene, materials);
  if (read.groups.empty()) windows->fail("is empty; add at least one [[windows]] table");
  return read;
}

}  // namespace lightwell
