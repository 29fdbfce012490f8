#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "viewer/document/page_frame.h"
#include "viewer/export/page_data.h"
#include "viewer/report/heat_map.h"
#include "viewer/report/plan_svg.h"
#include "viewer/report/year_operation.h"
#include "viewer/report/year_ratings.h"
#include "viewer/report/year_report.h"

namespace lightwell {
namespace {

void add_heading(const YearReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  const Weather& weather = report.weather;
  fmt::format_to(out, "<h1>{}: a year of daylight</h1>\n<dl class=\"heading\">",
                 html_text(report.title));
  fmt::format_to(out, "<dt>Weather</dt><dd>{} ({}, {})</dd>", html_text(weather.place),
                 html_text(weather.file.filename().string()), weather.format);
  fmt::format_to(out, "<dt>Place</dt><dd>{:.2f}° {}, {:.2f}° {}, UTC{:+g} h</dd>",
                 std::abs(weather.latitude), weather.latitude < 0.0 ? "S" : "N",
                 std::abs(weather.longitude), weather.longitude < 0.0 ? "W" : "E",
                 weather.hours_east);
  fmt::format_to(out, "<dt>Occupied</dt><dd>{} to {} h, every day</dd>", report.occupancy.from,
                 report.occupancy.to);
  fmt::format_to(out, "<dt>Made by</dt><dd>Lightwell {}</dd></dl>\n", html_text(report.version));
}

std::string with_bounds(double value, double least, double most) {
  return fmt::format("{:.1f}\u202f% <small>{:.1f} to {:.1f}</small>", value, least, most);
}

void add_table(const YearReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  page +=
      "<table><tr><th>Sensors</th><th>Number</th><th>sDA<sub>300/50%</sub></th>"
      "<th>ASE<sub>1000,250h</sub></th><th>DA<sub>300</sub></th><th>Mean year-round</th>"
      "<th>Daylight factor</th><th>EN 17037</th></tr>\n";
  for (const YearRoom& room : report.rooms) {
    const RoomMetrics& m = room.metrics;
    const bool is_sure = room.least.en_level == room.most.en_level;
    fmt::format_to(
        out,
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.1f}\u202f%</td><td>{}</td><td>{} lx</td>"
        "<td>{:.2f}\u202f% <small>median {:.2f}</small></td><td>{}{}</td></tr>\n",
        html_text(room.name), room.count,
        with_bounds(m.spatial_autonomy, room.least.spatial_autonomy, room.most.spatial_autonomy),
        m.sun_exposure,
        with_bounds(m.mean_autonomy, room.least.mean_autonomy, room.most.mean_autonomy),
        lux_text(m.mean_lux), m.mean_daylight_factor, m.median_daylight_factor, m.en_level,
        is_sure ? "" : " <small>too close to tell</small>");
  }
  fmt::format_to(out,
                 "</table>\n<p>Light without direct sunlight, in the mean of the year, is within "
                 "±{:.1f}\u202f% at a sensor "
                 "(odds of 19 to 1); the smaller figures say what that does to a measure. {} "
                 "EN 17037 by its second method.</p>\n",
                 100.0 * report.error,
                 report.windows.empty()
                     ? "sDA and ASE are those of IES LM-83 without blinds."
                     : "All are with operated windows, but ASE and the daylight factor, which have "
                       "all windows in their first state.");
}

struct Plan {
  const char* title;
  Eigen::ArrayXd values{};
  LuxRange range{};
  std::string unit{};
};

// The plans of a room.
std::vector<Plan> plans_of(const YearReport& report, const YearRoom& room) {
  const auto part = [&](const Eigen::ArrayXd& all) -> Eigen::ArrayXd {
    return all.segment(room.first, room.count);
  };
  const Eigen::ArrayXd factor = 100.0 * part(report.daylight_factor.cast<double>());
  std::vector<Plan> plans = {
      {"Daylight autonomy DA<sub>300</sub>: occupied hours with 300 lx or more",
       part(report.sensors.autonomy),
       {.low = 0.0, .high = 100.0},
       "%"},
      {"Daylight factor under the CIE overcast sky", factor, plan_range(field_of(factor)), "%"}};
  const Eigen::ArrayXd sun = part(report.sensors.sun_hours);
  if ((sun > 0.0).any()) {
    plans.push_back({"Occupied hours with 1000 lx or more straight from the sun",
                     sun,
                     {.low = 0.0, .high = plan_range(field_of(sun)).high},
                     "h"});
  }
  return plans;
}

void add_rooms(const YearReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  int number = 0;
  for (const YearRoom& room : report.rooms) {
    fmt::format_to(out, "<section class=\"surface\"><h2>{}</h2>\n", html_text(room.name));
    fmt::format_to(out,
                   "<figure><figcaption><b>Mean illuminance</b> of every hour of the year, "
                   "standard time</figcaption>\n{}</figure>\n",
                   heat_map_svg(room.mean_of_hours, lux_range(room.mean_of_hours), "lx"));
    if (room.grid) {
      CalculationSurface surface;
      surface.grid = *room.grid;
      surface.lines = room.lines;
      for (const Plan& plan : plans_of(report, room)) {
        const LuxField field = field_of(plan.values);
        fmt::format_to(out, "<figure><figcaption><b>{}</b></figcaption>\n{}</figure>\n", plan.title,
                       plan_svg({.surface = surface,
                                 .field = field,
                                 .range = plan.range,
                                 .number = ++number,
                                 .north = north_in(report.north, *room.grid),
                                 .metres_per_unit = report.metres_per_unit,
                                 .unit_name = report.unit_name,
                                 .unit = plan.unit}));
      }
    }
    page += "</section>\n";
  }
}

}  // namespace

std::string year_page(const YearReport& report) {
  std::string page = page_begin(report.title);
  add_heading(report, page);
  add_table(report, page);
  page += rating_sections(report);
  page += operation_sections(report);
  add_rooms(report, page);
  page += list_section("What is assumed", report.conventions);
  page += list_section("Notes", report.notes);
  return page + page_end;
}

}  // namespace lightwell
