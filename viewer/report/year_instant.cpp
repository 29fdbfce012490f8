#include "viewer/report/year_instant.h"

#include <fmt/format.h>

#include <iterator>

#include "viewer/document/page_frame.h"
#include "viewer/export/page_data.h"
#include "viewer/report/plan_svg.h"

namespace lightwell {
namespace {

// Illuminance of a room's sensors, lx.
Eigen::ArrayXd lux_of_room(const Eigen::ArrayXf& lux, const YearRoom& room) {
  return lux.segment(room.first, room.count).cast<double>();
}

void add_instant_plan(const InstantReport& report, const YearRoom& room, const char* title,
                      const Eigen::ArrayXd& lux, int number, std::string& page) {
  CalculationSurface surface;
  surface.grid = *room.grid;
  surface.lines = room.lines;
  const LuxField field = field_of(lux);
  page += fmt::format("<figure><figcaption><b>{}</b></figcaption>\n{}</figure>\n", title,
                      plan_svg({.surface = surface,
                                .field = field,
                                .range = plan_range(field),
                                .number = number,
                                .north = north_in(report.of.north, *room.grid),
                                .metres_per_unit = report.of.metres_per_unit,
                                .unit_name = report.of.unit_name}));
}

void add_instant_heading(const InstantReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  const SkyHour& sky = report.sky;
  fmt::format_to(out, "<h1>{}: daylight at {}</h1>\n<dl class=\"heading\">",
                 html_text(report.of.title), html_text(report.when));
  fmt::format_to(out, "<dt>Weather</dt><dd>{} ({}, {})</dd>", html_text(report.of.weather.place),
                 html_text(report.of.weather.file.filename().string()), report.of.weather.format);
  fmt::format_to(out, "<dt>Sun</dt><dd>{:.1f}° high, azimuth {:.1f}°, {} lx across its rays</dd>",
                 sky.altitude_degrees, sky.azimuth_degrees, lux_text(sky.sun_lux));
  fmt::format_to(out, "<dt>Dome</dt><dd>{} lx on open ground</dd>", lux_text(sky.dome_lux));
  if (!report.states.empty()) {
    fmt::format_to(out, "<dt>Windows</dt><dd>{}</dd>", html_text(report.states));
  }
  fmt::format_to(out, "<dt>Made by</dt><dd>Lightwell {}</dd></dl>\n", html_text(report.of.version));
}

void add_instant_table(const InstantReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  page +=
      "<table><tr><th>Sensors</th><th>Number</th><th>Mean</th><th>Least</th><th>Greatest</th>"
      "<th>Straight from the sun, mean</th></tr>\n";
  for (const YearRoom& room : report.of.rooms) {
    const Eigen::ArrayXd lux = lux_of_room(report.total, room);
    fmt::format_to(out,
                   "<tr><td>{}</td><td>{}</td><td>{} lx</td><td>{} lx</td><td>{} lx</td>"
                   "<td>{} lx</td></tr>\n",
                   html_text(room.name), room.count, lux_text(lux.mean()), lux_text(lux.minCoeff()),
                   lux_text(lux.maxCoeff()), lux_text(lux_of_room(report.sunlight, room).mean()));
  }
  fmt::format_to(out,
                 "</table>\n<p>Light without direct sunlight is within ±{:.1f}\u202f% at a sensor "
                 "(odds of 19 to 1).</p>\n",
                 100.0 * report.of.error);
}

}  // namespace

nlohmann::ordered_json instant_json(const InstantReport& report) {
  nlohmann::ordered_json json;
  json["at"] = report.when;
  json["sun"] = {{"altitude", report.sky.altitude_degrees},
                 {"azimuth", report.sky.azimuth_degrees},
                 {"lux", report.sky.sun_lux}};
  json["dome_lux"] = report.sky.dome_lux;
  if (!report.states.empty()) json["windows"] = report.states;
  json["relative_error"] = report.of.error;
  json["rooms"] = nlohmann::ordered_json::array();
  for (const YearRoom& room : report.of.rooms) {
    const Eigen::ArrayXd lux = lux_of_room(report.total, room);
    json["rooms"].push_back({{"name", room.name},
                             {"sensors", room.count},
                             {"mean_lux", lux.mean()},
                             {"least_lux", lux.minCoeff()},
                             {"greatest_lux", lux.maxCoeff()},
                             {"mean_sun_lux", lux_of_room(report.sunlight, room).mean()}});
  }
  return json;
}

std::string instant_text(const InstantReport& report) {
  std::string text =
      fmt::format("{}: sun {:.1f} degrees high, azimuth {:.1f}, {:.0f} lx; dome {:.0f} lx\n",
                  report.when, report.sky.altitude_degrees, report.sky.azimuth_degrees,
                  report.sky.sun_lux, report.sky.dome_lux);
  if (!report.states.empty()) text += fmt::format("windows: {}\n", report.states);
  for (const YearRoom& room : report.of.rooms) {
    const Eigen::ArrayXd lux = lux_of_room(report.total, room);
    text += fmt::format("{}: {:.1f} lx in the mean, {:.1f} to {:.1f} lx\n", room.name, lux.mean(),
                        lux.minCoeff(), lux.maxCoeff());
  }
  return text;
}

std::string instant_page(const InstantReport& report) {
  std::string page = page_begin(report.of.title);
  add_instant_heading(report, page);
  add_instant_table(report, page);
  int number = 0;
  for (const YearRoom& room : report.of.rooms) {
    if (!room.grid) continue;
    page += fmt::format("<section class=\"surface\"><h2>{}</h2>\n", html_text(room.name));
    add_instant_plan(report, room, "Illuminance", lux_of_room(report.total, room), ++number, page);
    const Eigen::ArrayXd sun = lux_of_room(report.sunlight, room);
    if ((sun > 0.0).any()) {
      add_instant_plan(report, room, "Illuminance straight from the sun", sun, ++number, page);
    }
    page += "</section>\n";
  }
  page += list_section("What is assumed", report.of.conventions);
  page += list_section("Notes", report.of.notes);
  return page + page_end;
}

}  // namespace lightwell
