#include "viewer/export/page_year.h"

#include <Eigen/Geometry>

#include "daylight/sky_year.h"
#include "scene/io/weather/sun_hours.h"
#include "viewer/export/baked_year.h"
#include "viewer/export/page_arrays.h"

namespace lightwell {
namespace {

// Sun and sky of each hour: light of the sun across its rays, of the dome on open ground (lx), and
// the dome's gradation a to e.
nlohmann::ordered_json append_hours(const BakedYear& year, std::string& bytes) {
  nlohmann::ordered_json about = {{"count", year.hours.size()}, {"numbers", bytes.size()}};
  for (const SkyHour& hour : year.hours) {
    append_bytes(bytes, static_cast<std::uint32_t>(hour.number));
  }
  about["skies"] = bytes.size();
  for (const SkyHour& hour : year.hours) {
    const SkyGradation& g = hour.gradation;
    for (const double x : {hour.sun_lux, hour.dome_lux, g.a, g.b, g.c, g.d, g.e}) {
      append_bytes(bytes, static_cast<float>(x));
    }
  }
  const BandArray by_hours = year.weight;  // the terms of an hour side by side
  about["weights"] = append_halves(numbers(by_hours), bytes);
  return about;
}

nlohmann::ordered_json append_panes(const BakedYear& year, std::string& bytes) {
  nlohmann::ordered_json about = {{"steps", pane_steps}, {"of_face", bytes.size()}};
  bytes.append(year.pane_of_face.begin(), year.pane_of_face.end());
  bytes.resize((bytes.size() + 3) / 4 * 4);
  about["transmittance"] = nlohmann::ordered_json::array();
  for (const RgbArray& table : year.panes) about["transmittance"].push_back(numbers(table));
  return about;
}

}  // namespace

nlohmann::ordered_json page_year(const BakedModel& model, std::string& bytes) {
  const BakedYear& year = *model.year;
  nlohmann::ordered_json about = {{"terms", year.weight.cols()},
                                  {"bands", year.bands},
                                  {"error", year.error},
                                  {"place", year.place},
                                  {"latitude", year.latitude},
                                  {"longitude", year.longitude},
                                  {"hours_east", year.hours_east},
                                  {"calendar", year_of_dates(year.is_leap_year)},
                                  {"ground", year.ground_reflectance},
                                  {"white", numbers(year.white)}};
  const Eigen::Vector3d east = year.north.cross(year.up);
  about["axes"] = nlohmann::ordered_json::array();
  for (const Eigen::Vector3d& axis : {year.north, east, year.up}) {
    about["axes"].push_back(vector_json(model.to_y_up * axis));
  }
  about["light"] = append_halves(numbers(year.light), bytes);
  about["reflectance"] = append_halves(numbers(year.reflectance), bytes);
  about["hours"] = append_hours(year, bytes);
  about["panes"] = append_panes(year, bytes);
  return about;
}

}  // namespace lightwell
