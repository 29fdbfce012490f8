#include "viewer/report/year_operation.h"

#include <fmt/format.h>

#include <iterator>

#include "viewer/export/page_data.h"
#include "viewer/report/heat_map.h"
#include "viewer/report/plan_svg.h"

namespace lightwell {
namespace {

void add_windows(const YearReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  page +=
      "<section><h2>Operated windows</h2>\n<table><tr><th>Windows</th><th class=\"text\">Rule</th>"
      "<th class=\"text\">State</th><th>Occupied hours with light</th><th>All hours with "
      "light</th></tr>\n";
  for (const YearWindows& windows : report.windows) {
    for (const YearWindows::State& state : windows.states) {
      const bool is_first = &state == &windows.states.front();
      fmt::format_to(out,
                     "<tr><td>{}</td><td class=\"text\">{}</td><td "
                     "class=\"text\">{}</td><td>{}</td><td>{}</td></tr>\n",
                     is_first ? html_text(windows.name) : "",
                     is_first ? html_text(windows.operation) : "", html_text(state.name),
                     state.occupied_hours, state.hours);
    }
  }
  page += "</table>\n";
}

void add_states(const YearReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  page +=
      "<p>The year with the windows in one state throughout:</p>\n<table><tr><th>States</th>"
      "<th "
      "class=\"text\">Sensors</th><th>sDA<sub>300/50%</sub></th><th>ASE<sub>1000,250h</sub></th>"
      "<th>DA<sub>300</sub></th><th>Mean year-round</th><th>EN 17037</th><th>Within</th></tr>\n";
  for (const YearInStates& year : report.states) {
    for (std::size_t r = 0; r < year.rooms.size(); ++r) {
      const RoomMetrics& m = year.rooms[r];
      fmt::format_to(
          out,
          "<tr><td>{}</td><td class=\"text\">{}</td><td>{:.1f}\u202f%</td><td>{:.1f}\u202f%</td>"
          "<td>{:.1f}\u202f%</td><td>{} lx</td><td>{}</td><td>±{:.1f}\u202f%</td></tr>\n",
          r == 0 ? html_text(year.states) : "", html_text(report.rooms[r].name), m.spatial_autonomy,
          m.sun_exposure, m.mean_autonomy, lux_text(m.mean_lux), m.en_level, 100.0 * year.error);
    }
  }
  page += "</table>\n";
  if (report.is_superposed) {
    fmt::format_to(out,
                   "<p>Light of several changed groups is superposed; with all groups changed, "
                   "this differs from a computation by {:.1f}\u202f% of the light with no group "
                   "changed, which is part of the bounds.</p>\n",
                   100.0 * report.superposition);
  }
  page += "</section>\n";
}

// DGP of every hour of the year; hours without light have none.
std::vector<float> glare_of_hours(const YearReport& report, const GlareOfYear& glare) {
  std::vector<float> values(report.weather.hours.size(), 0.0f);
  for (std::size_t h = 0; h < glare.dgp.size(); ++h) {
    values[static_cast<std::size_t>(report.hour_numbers[h])] = glare.dgp[h];
  }
  return values;
}

void add_glare(const YearReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  page +=
      "<section><h2>Glare</h2>\n<table><tr><th>Observer</th><th>DGP above 0.35</th>"
      "<th>0.40</th><th>0.45</th><th>DGPs above 0.35</th><th>0.40</th><th>0.45</th>"
      "<th>EN 17037</th></tr>\n";
  for (const GlareOfYear& glare : report.glare) {
    fmt::format_to(out, "<tr><td>{}</td>", html_text(glare.name));
    for (const double share :
         {glare.above_35, glare.above_40, glare.above_45, glare.simplified_above_35,
          glare.simplified_above_40, glare.simplified_above_45}) {
      fmt::format_to(out, "<td>{:.1f}\u202f%</td>", share);
    }
    fmt::format_to(out, "<td>{}</td></tr>\n", glare.level);
  }
  page +=
      "</table>\n<p>Shares of the occupied hours. EN 17037: in at most 5\u202f% of them is the "
      "daylight glare probability above 0.35 (high), 0.40 (medium) or 0.45 (minimum). DGPs leaves "
      "out contrast, and is meant for hours without sun at the eye; all hours are counted. Glare "
      "has "
      "no bound of its error.</p>\n";
  for (const GlareOfYear& glare : report.glare) {
    constexpr LuxRange range{.low = 0.0, .high = 0.6};
    fmt::format_to(out,
                   "<figure><figcaption><b>Daylight glare probability</b> at {}</figcaption>\n{}"
                   "</figure>\n",
                   html_text(glare.name),
                   heat_map_svg(glare_of_hours(report, glare), range, "DGP"));
  }
  page += "</section>\n";
}

void add_exposure(const YearReport& report, std::string& page) {
  const auto out = std::back_inserter(page);
  const YearExposure& exposure = *report.exposure;
  fmt::format_to(out,
                 "<section><h2>Exposure to sunlight</h2>\n<p>Hours with the sun in sight on day {} "
                 "of month {}, without clouds, the sun at least {:g}° high. EN 17037: minimum "
                 "1.5 h, medium 3 h, high 4 h.</p>\n<table><tr><th>Point, {}</th><th>Hours</th>"
                 "<th>EN 17037</th></tr>\n",
                 exposure.day.day, exposure.day.month, exposure.day.least_altitude_degrees,
                 html_text(report.unit_name));
  for (std::size_t p = 0; p < exposure.points.size(); ++p) {
    const Eigen::Vector3d at = exposure.points[p] / report.metres_per_unit;
    const double hours = exposure.hours[static_cast<Eigen::Index>(p)];
    fmt::format_to(out, "<tr><td>{:.4g}, {:.4g}, {:.4g}</td><td>{:.2f}</td><td>{}</td></tr>\n",
                   at.x(), at.y(), at.z(), hours, exposure_level(hours));
  }
  page += "</table></section>\n";
}

}  // namespace

std::string operation_sections(const YearReport& report) {
  std::string page;
  if (!report.windows.empty()) {
    add_windows(report, page);
    add_states(report, page);
  }
  if (!report.glare.empty()) add_glare(report, page);
  if (report.exposure) add_exposure(report, page);
  return page;
}

}  // namespace lightwell
