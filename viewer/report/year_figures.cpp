#include <fmt/format.h>

#include <iterator>

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
  return json;
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
  return text;
}

}  // namespace lightwell
