#include <fmt/format.h>

#include "scene/errors.h"
#include "scene/io/text_file.h"
#include "scene/io/toml/toml_document.h"
#include "scene/io/toml/toml_value.h"
#include "standards/sports.h"

namespace lightwell {
namespace {

SportLimits read_sport_class(const TomlValue& value) {
  const TomlTable table = value.table({"mean", "uniformity", "glare_rating", "colour_rendering"});
  constexpr double most_colour_rendering = 100.0, most_glare = 100.0;
  SportLimits limits{.mean = table.require("mean").positive()};
  if (const auto share = table.find("uniformity")) {
    limits.uniformity = share->number_within(0.0, 1.0);
  }
  if (const auto rating = table.find("glare_rating")) {
    limits.glare_rating = rating->number_within(0.0, most_glare);
  }
  if (const auto index = table.find("colour_rendering")) {
    limits.colour_rendering = index->number_within(0.0, most_colour_rendering);
  }
  return limits;
}

std::vector<Sport> sports_of(const TomlValue& document) {
  const TomlTable table = document.table({"sports"});
  std::vector<Sport> sports;
  for (const auto& [key, value] : table.require("sports").members("sport")) {
    const TomlTable of = value.table({"title", "I", "II", "III"});
    Sport sport{.key = key, .title = key};
    if (const auto title = of.find("title")) sport.title = title->name();
    sport.classes = {read_sport_class(of.require("I")), read_sport_class(of.require("II")),
                     read_sport_class(of.require("III"))};
    sports.push_back(std::move(sport));
  }
  if (sports.empty()) table.fail("holds no sport; add a table [sports.NAME]");
  return sports;
}

}  // namespace

std::vector<Sport> usual_sports() {
  const toml::table root = toml::parse(standards_data::sports);
  const std::filesystem::path name = "sports.toml";
  return sports_of(TomlValue(name, root, "table of sports"));
}

std::vector<Sport> read_sports(const std::filesystem::path& path) {
  const TextFile file(path);
  const toml::table root = parse_toml(file);
  return sports_of(TomlValue(file.path(), root, "table of sports"));
}

}  // namespace lightwell
