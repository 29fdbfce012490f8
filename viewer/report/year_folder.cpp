// Files of a year of daylight, and of an instant, in a folder.
#include "daylight/honeybee_metrics.h"
#include "daylight/year_files.h"
#include "viewer/export/write_whole.h"
#include "viewer/report/year_ratings.h"
#include "viewer/report/year_study.h"

namespace lightwell {
namespace {

constexpr const char* metrics_folder = "metrics";
constexpr const char *instant_table = "instant.csv", *page_of_instant = "instant.html";

// True where ratings or lamps are asked for, whose figures have a file of their own.
bool has_rooms_file(const DaylightStudy& study) {
  return !study.ratings.empty() || !study.rooms.empty();
}

// The sensor grids of a Honeybee model that have sensors; their places are not known yet.
std::vector<MetricGrid> planned_grids(const DaylightStudy& study) {
  std::vector<MetricGrid> grids;
  for (const SensorGrid& grid : study.sensor_grids) {
    if (!grid.positions.empty()) grids.push_back({.name = grid.name, .group = grid.group});
  }
  return grids;
}

// The same among the rooms of the year.
std::vector<MetricGrid> metric_grids(const DaylightStudy& study, const YearReport& made) {
  std::vector<MetricGrid> grids = planned_grids(study);
  auto next = grids.begin();
  for (const YearRoom& room : made.rooms) {
    if (room.grid || next == grids.end() || room.name != next->name) continue;
    next->first = room.first;
    next->count = room.count;
    ++next;
  }
  return grids;
}

}  // namespace

std::vector<std::filesystem::path> year_files(const DaylightStudy& study) {
  std::vector<std::filesystem::path> files = {"sensors.csv", "hours.csv", "year.html", "year.json"};
  if (!study.eyes.empty()) files.emplace_back("glare.csv");
  if (has_rooms_file(study)) files.emplace_back("rooms.csv");
  if (const auto grids = planned_grids(study); !grids.empty()) {
    for (const std::filesystem::path& file : honeybee_metric_files(grids)) {
      files.push_back(metrics_folder / file);
    }
  }
  return files;
}

std::vector<std::filesystem::path> instant_files() {
  return {instant_table, page_of_instant};
}

void write_year(const std::filesystem::path& folder, const DaylightStudy& study,
                const StudiedYear& year) {
  const YearReport& made = year.report;
  write_sensors(folder / "sensors.csv", year.sensors, made.sensors, made.daylight_factor,
                study.scene.metres_per_unit);
  write_hours(folder / "hours.csv", {.hours = year.hours,
                                     .is_leap_year = study.weather.is_leap_year,
                                     .windows = study.windows,
                                     .states = year.states});
  if (!made.glare.empty()) write_glare(folder / "glare.csv", year.hours, made.glare);
  if (const auto grids = metric_grids(study, made); !grids.empty()) {
    write_honeybee_metrics(folder / metrics_folder, grids, made.sensors);
  }
  if (has_rooms_file(study)) write_whole(folder / "rooms.csv", {rooms_csv(made)});
  write_whole(folder / "year.html", {year_page(made)});
  write_whole(folder / "year.json", {json_text(year_json(made))});
}

void write_instant_files(const std::filesystem::path& folder, std::span<const Probe> sensors,
                         const InstantReport& instant) {
  write_instant(folder / instant_table, sensors, instant.total, instant.sunlight,
                instant.of.metres_per_unit);
  write_whole(folder / page_of_instant, {instant_page(instant)});
}

}  // namespace lightwell
