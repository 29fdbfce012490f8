#include <fmt/format.h>

#include <iterator>

#include "viewer/report/year_ratings.h"
#include "viewer/report/year_report.h"

namespace lightwell {
namespace {

using Json = nlohmann::ordered_json;

Json room_json(const YearRoom& room) {
  const auto with_bounds = [&](double RoomMetrics::*value) {
    return Json{
        {"value", room.metrics.*value}, {"least", room.least.*value}, {"most", room.most.*value}};
  };
  Json json;
  json["name"] = room.name;
  json["sensors"] = room.count;
  json["sDA300_50"] = with_bounds(&RoomMetrics::spatial_autonomy);
  json["ASE1000_250"] = room.metrics.sun_exposure;
  json["mean_DA300"] = with_bounds(&RoomMetrics::mean_autonomy);
  json["mean_cDA300"] = with_bounds(&RoomMetrics::mean_continuous_autonomy);
  json["mean_lux"] = with_bounds(&RoomMetrics::mean_lux);
  json["mean_daylight_factor"] = room.metrics.mean_daylight_factor;
  json["median_daylight_factor"] = room.metrics.median_daylight_factor;
  json["en_17037"] = Json{{"level", room.metrics.en_level},
                          {"least", room.least.en_level},
                          {"most", room.most.en_level}};
  if (room.lighting) json["lighting"] = lighting_json(room);
  return json;
}

Json windows_json(const YearWindows& windows) {
  Json json{{"name", windows.name}, {"operation", windows.operation}, {"states", Json::array()}};
  for (const YearWindows::State& state : windows.states) {
    json["states"].push_back({{"name", state.name},
                              {"occupied_hours", state.occupied_hours},
                              {"hours_with_light", state.hours}});
  }
  return json;
}

// The year in one combination of states.
Json states_json(const YearReport& report, const YearInStates& year) {
  Json json{{"states", year.states}, {"relative_error", year.error}, {"rooms", Json::array()}};
  for (std::size_t r = 0; r < year.rooms.size(); ++r) {
    const RoomMetrics& m = year.rooms[r];
    json["rooms"].push_back({{"name", report.rooms[r].name},
                             {"sDA300_50", m.spatial_autonomy},
                             {"ASE1000_250", m.sun_exposure},
                             {"mean_DA300", m.mean_autonomy},
                             {"mean_cDA300", m.mean_continuous_autonomy},
                             {"mean_lux", m.mean_lux},
                             {"en_17037", m.en_level}});
  }
  return json;
}

Json glare_json(const GlareOfYear& glare) {
  return {{"observer", glare.name},
          {"DGP_above_0.35", glare.above_35},
          {"DGP_above_0.40", glare.above_40},
          {"DGP_above_0.45", glare.above_45},
          {"DGPs_above_0.35", glare.simplified_above_35},
          {"DGPs_above_0.40", glare.simplified_above_40},
          {"DGPs_above_0.45", glare.simplified_above_45},
          {"en_17037", glare.level}};
}

Json exposure_json(const YearExposure& exposure, double metres_per_unit) {
  Json points = Json::array();
  for (std::size_t p = 0; p < exposure.points.size(); ++p) {
    const Eigen::Vector3d at = exposure.points[p] / metres_per_unit;
    const double hours = exposure.hours[static_cast<Eigen::Index>(p)];
    points.push_back({{"point", {at.x(), at.y(), at.z()}},
                      {"hours", hours},
                      {"en_17037", exposure_level(hours)}});
  }
  return {{"month", exposure.day.month},
          {"day", exposure.day.day},
          {"least_sun_altitude", exposure.day.least_altitude_degrees},
          {"points", points}};
}

// Adds what is there of windows, glare and exposure.
void add_windows_and_people(const YearReport& report, Json& json) {
  if (!report.windows.empty()) {
    json["windows"] = Json::array();
    for (const YearWindows& windows : report.windows) {
      json["windows"].push_back(windows_json(windows));
    }
    json["method"] = report.is_superposed ? "superposition" : "combinations";
    json["superposition_error"] = report.superposition;
    json["states"] = Json::array();
    for (const YearInStates& year : report.states) {
      json["states"].push_back(states_json(report, year));
    }
  }
  if (!report.glare.empty()) {
    json["glare"] = Json::array();
    for (const GlareOfYear& glare : report.glare) json["glare"].push_back(glare_json(glare));
  }
  if (report.exposure) {
    json["exposure_to_sunlight"] = exposure_json(*report.exposure, report.metres_per_unit);
  }
}

}  // namespace

nlohmann::ordered_json year_json(const YearReport& report) {
  Json json;
  json["version"] = report.version;
  json["title"] = report.title;
  json["weather"] = Json{{"file", report.weather.file.filename().string()},
                         {"format", report.weather.format},
                         {"place", report.weather.place},
                         {"latitude", report.weather.latitude},
                         {"longitude", report.weather.longitude},
                         {"hours_east", report.weather.hours_east}};
  json["occupied_hours"] = Json::array({report.occupancy.from, report.occupancy.to});
  json["relative_error"] = report.error;
  json["conventions"] = report.conventions;
  json["notes"] = report.notes;
  json["rooms"] = Json::array();
  for (const YearRoom& room : report.rooms) json["rooms"].push_back(room_json(room));
  if (!report.ratings.empty()) json["ratings"] = ratings_json(report);
  add_windows_and_people(report, json);
  return json;
}

std::string year_text(const YearReport& report) {
  std::string text;
  for (const YearRoom& room : report.rooms) {
    const RoomMetrics& m = room.metrics;
    fmt::format_to(std::back_inserter(text),
                   "{}: {} sensors\n"
                   "  sDA300/50%    {:.1f} % ({:.1f} to {:.1f}), ASE1000,250h {:.1f} %\n"
                   "  DA300         {:.1f} % ({:.1f} to {:.1f}) in the mean\n"
                   "  EN 17037      {}{}\n"
                   "  factor        {:.2f} % in the mean, median {:.2f} %\n",
                   room.name, room.count, m.spatial_autonomy, room.least.spatial_autonomy,
                   room.most.spatial_autonomy, m.sun_exposure, m.mean_autonomy,
                   room.least.mean_autonomy, room.most.mean_autonomy, m.en_level,
                   room.least.en_level == room.most.en_level
                       ? ""
                       : fmt::format(" (from {} to {})", room.least.en_level, room.most.en_level),
                   m.mean_daylight_factor, m.median_daylight_factor);
  }
  text += ratings_text(report);
  for (const YearWindows& windows : report.windows) {
    fmt::format_to(std::back_inserter(text), "windows {}: {}\n", windows.name, windows.operation);
    for (const YearWindows::State& state : windows.states) {
      fmt::format_to(std::back_inserter(text), "  {:<13} {} occupied hours with light\n",
                     state.name, state.occupied_hours);
    }
  }
  for (const GlareOfYear& glare : report.glare) {
    fmt::format_to(std::back_inserter(text),
                   "glare at {}: DGP above 0.35 in {:.1f} %, 0.40 in {:.1f} %, 0.45 in {:.1f} % of "
                   "the occupied hours; EN 17037 {}\n",
                   glare.name, glare.above_35, glare.above_40, glare.above_45, glare.level);
  }
  if (report.exposure) {
    for (Eigen::Index p = 0; p < report.exposure->hours.size(); ++p) {
      const double hours = report.exposure->hours[p];
      fmt::format_to(std::back_inserter(text), "sun at point {}: {:.2f} h, EN 17037 {}\n", p + 1,
                     hours, exposure_level(hours));
    }
  }
  return text;
}

}  // namespace lightwell
