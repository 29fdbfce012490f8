#include <fmt/format.h>

#include "scene/errors.h"
#include "scene/io/activity_file.h"
#include "scene/io/text_file.h"
#include "scene/io/toml/toml_document.h"
#include "scene/io/toml/toml_value.h"

namespace lightwell {
namespace {

Activity read_limits(const std::string& key, const TomlValue& value) {
  const TomlTable table = value.table({"title", "mean", "raised", "uniformity", "colour_rendering",
                                       "glare", "cylindrical", "walls", "ceiling"});
  constexpr double most_colour_rendering = 100.0;
  Activity activity{.key = key, .title = key, .mean = table.require("mean").positive()};
  activity.raised_mean = activity.mean;
  if (const auto title = table.find("title")) activity.title = title->name();
  if (const auto mean = table.find("raised")) {
    activity.raised_mean = mean->number_at_least(activity.mean);
  }
  if (const auto share = table.find("uniformity")) {
    activity.uniformity = share->number_within(0.0, 1.0);
  }
  if (const auto index = table.find("colour_rendering")) {
    activity.colour_rendering = index->number_within(0.0, most_colour_rendering);
  }
  const auto limit = [&](const char* name) {
    const auto given = table.find(name);
    return given ? given->number_at_least(0.0) : 0.0;
  };
  activity.glare = limit("glare");
  activity.cylindrical = limit("cylindrical");
  activity.walls = limit("walls");
  activity.ceiling = limit("ceiling");
  return activity;
}

std::vector<Activity> activities_of(const TomlValue& document) {
  const TomlTable table = document.table({"activities"});
  std::vector<Activity> activities;
  for (const auto& [key, value] : table.require("activities").members("activity")) {
    activities.push_back(read_limits(key, value));
  }
  if (activities.empty()) table.fail("holds no activity; add a table [activities.NAME]");
  return activities;
}

}  // namespace

std::vector<Activity> read_activities(const std::filesystem::path& path) {
  const TextFile file(path);
  const toml::table root = parse_toml(file);
  return activities_of(TomlValue(file.path(), root, "table of activities"));
}

std::vector<Activity> parse_activities(std::string_view text, const std::filesystem::path& name) {
  try {
    const toml::table root = toml::parse(text);
    return activities_of(TomlValue(name, root, "table of activities"));
  } catch (const toml::parse_error& error) {
    throw InputError(
        fmt::format("{}:{}: {}", name.string(), error.source().begin.line, error.description()));
  }
}

}  // namespace lightwell
