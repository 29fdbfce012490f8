#include "scene/io/text_file.h"
#include "scene/io/toml/toml_document.h"
#include "scene/io/toml/toml_value.h"
#include "standards/daylight_rating.h"
#include "standards/table_key.h"

namespace lightwell {
namespace {

double positive_within(const TomlValue& value, double high) {
  value.positive();
  return value.number_within(0.0, high);
}

RatingStep read_step(const TomlValue& value) {
  constexpr int most_points = 100;
  constexpr double most_percent = 100.0;
  const TomlTable table = value.table({"at_least", "points"});
  return {.at_least = positive_within(table.require("at_least"), most_percent),
          .points = static_cast<int>(table.require("points").integer_within(1, most_points))};
}

std::vector<RatingStep> read_steps(const TomlTable& table, const char* key) {
  std::vector<RatingStep> steps;
  if (const auto values = table.find(key)) {
    for (const TomlValue& value : values->elements("step")) steps.push_back(read_step(value));
  }
  return steps;
}

HoursLimit read_hours(const TomlTable& table, const char* key) {
  constexpr double hours_of_a_year = 8760.0;
  const auto value = table.find(key);
  if (!value) return {};
  const TomlTable of = value->table({"lux", "hours"});
  return {.lux = of.require("lux").positive(),
          .hours = positive_within(of.require("hours"), hours_of_a_year)};
}

// Refuses a rating that gives no points, or whose points rest on nothing.
void require_sense(const TomlTable& table, const DaylightRating& rating) {
  if (rating.autonomy.empty() == rating.area.empty()) {
    table.fail(
        "gives points by 'autonomy', the sDA of all rooms, or by 'area', the share in rooms that "
        "comply; write one of the two, such as area = [{ at_least = 80, points = 2 }]");
  }
  if (rating.autonomy.empty() && !(rating.daylight_factor > 0.0) && !rating.has_hours()) {
    table.fail("says nothing of which rooms comply; add 'daylight_factor', 'mean' or 'point'");
  }
}

DaylightRating read_rating(const std::string& key, const TomlValue& value) {
  const TomlTable table =
      value.table({"title", "source", "points", "notes", "autonomy", "autonomy_of_each",
                   "sun_exposure", "area", "daylight_factor", "uniformity", "mean", "point"});
  constexpr double most_percent = 100.0;
  DaylightRating rating{.key = key, .title = key};
  if (const auto title = table.find("title")) rating.title = title->name();
  if (const auto source = table.find("source")) rating.source = source->name();
  if (const auto points = table.find("points")) rating.points = points->name();
  if (const auto notes = table.find("notes")) {
    for (const TomlValue& note : notes->elements("note")) rating.notes.push_back(note.name());
  }
  rating.autonomy = read_steps(table, "autonomy");
  if (const auto each = table.find("autonomy_of_each")) rating.autonomy_of_each = read_step(*each);
  if (const auto most = table.find("sun_exposure")) {
    rating.sun_exposure = most->number_within(0.0, most_percent);
  }
  rating.area = read_steps(table, "area");
  if (const auto least = table.find("daylight_factor")) {
    rating.daylight_factor = least->number_within(0.0, most_percent);
  }
  if (const auto least = table.find("uniformity")) {
    rating.uniformity = least->number_within(0.0, 1.0);
  }
  rating.mean = read_hours(table, "mean");
  rating.point = read_hours(table, "point");
  require_sense(table, rating);
  return rating;
}

std::vector<DaylightRating> ratings_of(const TomlValue& document) {
  const TomlTable table = document.table({"ratings"});
  std::vector<DaylightRating> ratings;
  for (const auto& [key, value] : table.require("ratings").members("rating")) {
    ratings.push_back(read_rating(key, value));
  }
  if (ratings.empty()) table.fail("holds no rating; add a table [ratings.NAME]");
  return ratings;
}

}  // namespace

std::vector<DaylightRating> usual_daylight_ratings() {
  const toml::table root = toml::parse(standards_data::daylight_ratings);
  const std::filesystem::path name = "daylight_ratings.toml";
  return ratings_of(TomlValue(name, root, "table of ratings"));
}

std::vector<DaylightRating> read_daylight_ratings(const std::filesystem::path& path) {
  const TextFile file(path);
  const toml::table root = parse_toml(file);
  return ratings_of(TomlValue(file.path(), root, "table of ratings"));
}

const DaylightRating& find_daylight_rating(const std::vector<DaylightRating>& ratings,
                                           const std::string& key, const std::string& asked_by) {
  return find_entry(ratings,
                    {.key = key, .asked_by = asked_by, .noun = "rating", .option = "--ratings"});
}

std::vector<DaylightRating> find_daylight_ratings(std::span<const std::string> keys,
                                                  const std::filesystem::path& file,
                                                  const std::string& asked_by) {
  std::vector<DaylightRating> asked;
  if (keys.empty()) return asked;
  const std::vector<DaylightRating> known =
      file.empty() ? usual_daylight_ratings() : read_daylight_ratings(file);
  for (const std::string& key : keys) asked.push_back(find_daylight_rating(known, key, asked_by));
  return asked;
}

}  // namespace lightwell
