#include <fmt/format.h>

#include <set>

#include "scene/io/cue_file.h"
#include "scene/io/text_file.h"
#include "scene/io/toml/toml_document.h"
#include "scene/io/toml/toml_value.h"
#include "scene/utf8.h"

namespace lightwell {
namespace {

constexpr double longest_time = 86400.0;  // s, a day

WordedLevel read_level(const std::string& channels, const TomlValue& value) {
  return {.channels = channels,
          .value = value.is_number() ? fmt::format("{}", value.number()) : value.string(),
          .place = std::string(trimmed(value.located("")))};
}

double read_time(const TomlTable& table, const char* key, double otherwise) {
  const auto time = table.find(key);
  return time ? time->number_within(0.0, longest_time) : otherwise;
}

WordedCue read_cue(const TomlValue& value, std::size_t number, std::set<std::string>& names) {
  const auto given = value.member("name");
  WordedCue cue{.name = given ? plain_text(given->file_name()) : fmt::format("cue{}", number)};
  const TomlTable table =
      value.renamed(fmt::format("cue '{}'", cue.name))
          .table({"name", "channels", "others", "fade", "fade_up", "fade_down", "wait", "hold"});
  if (!names.insert(cue.name).second) {
    table.fail("has a name that an earlier cue has; give it another");
  }
  if (const auto channels = table.find("channels")) {
    for (const auto& [name, level] : channels->members("level")) {
      cue.levels.push_back(
          read_level(name, level.renamed(fmt::format("level '{}' of cue '{}'", name, cue.name))));
    }
  }
  if (const auto others = table.find("others")) cue.others = read_level("*", *others);
  if (cue.levels.empty() && !cue.others) {
    table.fail(
        "changes nothing; give levels of channels, as in channels = { desk = 0.3 }, or of all "
        "others, as in others = \"off\"");
  }
  const double fade = read_time(table, "fade", 0.0);
  cue.fade_up = read_time(table, "fade_up", fade);
  cue.fade_down = read_time(table, "fade_down", fade);
  cue.wait = read_time(table, "wait", 0.0);
  cue.hold = read_time(table, "hold", 0.0);
  return cue;
}

}  // namespace

std::vector<WordedCue> read_cues(const std::filesystem::path& path) {
  const TextFile file(path);
  const toml::table root = parse_toml(file);
  const TomlTable document = TomlValue(file.path(), root, "").table({"cues"});
  const auto tables = document.find("cues");
  if (!tables) document.fail("there are no cues; add at least one [[cues]] table");
  if (!tables->is_array()) tables->fail("must be an array of tables; write [[cues]]");
  std::vector<WordedCue> cues;
  std::set<std::string> names;
  for (const TomlValue& value : tables->elements("cue")) {
    cues.push_back(read_cue(value, cues.size() + 1, names));
  }
  if (cues.empty()) tables->fail("is empty; add at least one [[cues]] table");
  return cues;
}

}  // namespace lightwell
