#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "daylight/year_files.h"
#include "python/binding/arrays.h"
#include "python/binding/checked.h"
#include "python/binding/long_work.h"
#include "python/binding/module.h"
#include "python/binding/scene_data.h"
#include "raytrace/cameras/choose_camera.h"
#include "scene/io/text_file.h"
#include "scene/io/weather/clock_time.h"
#include "standards/daylight_rating.h"
#include "viewer/export/write_whole.h"
#include "viewer/report/year_study.h"
#include "viewer/report/year_walk.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

/// Options of a study of daylight that do not depend on the scene, and names of what is in it.
struct DaylightSettings {
  DaylightStudy study{.version = LIGHTWELL_VERSION, .points_name = "points"};
  double north_degrees = 0.0;
  std::vector<std::string> ratings{};
  std::filesystem::path windows{}, rooms{}, rating_table{};  ///< files; empty: none
};
using SharedStudy = std::shared_ptr<const DaylightStudy>;

/// A year of daylight as Python holds it: never changed once made, so that arrays may be views of
/// it. Light of sensors x hours, lx.
struct DaylightYearData {
  SharedStudy study{};
  StudiedYear year{};
  Eigen::ArrayXXf total{}, sunlight{};
};
using SharedYear = std::shared_ptr<const DaylightYearData>;

struct DaylightInstantData {
  SharedStudy study{};
  std::vector<Probe> sensors{};
  InstantReport report{};
};

// The windows of a file, of the scene's tables, or of the scene's file.
OperatedWindows windows_of(const SceneData& scene, const std::filesystem::path& file) {
  if (file.empty() && scene.text) return read_windows_text(*scene.text, scene.clean);
  const FilesRead read = scene.references == References::inside_folder
                             ? FilesRead::inside_folder_of(file.empty() ? scene.clean.file : file)
                             : FilesRead();
  return file.empty() ? read_windows(scene.clean) : read_windows(file, scene.clean);
}

SharedStudy study_of(const SharedScene& scene, const Weather& weather,
                     const DaylightSettings& settings) {
  return result_of_long(nb::none(), [&](const Progress&) -> SharedStudy {
    auto study = std::make_shared<DaylightStudy>(settings.study);
    study->weather = weather;
    study->scene = scene->clean;
    study->clean_up = scene->clean_up;
    study->windows = windows_of(*scene, settings.windows);
    study->grids = (scene->text ? read_lighting_text(*scene->text, scene->clean)
                                : read_lighting_design(scene->clean))
                       .grids;
    study->sensor_grids = read_sensor_grids(scene->clean);
    if (!settings.rooms.empty()) study->rooms = read_room_uses(settings.rooms);
    study->ratings = find_daylight_ratings(settings.ratings, settings.rating_table, "ratings");
    set_compass(settings.north_degrees, *study);
    check_study(*study);
    return study;
  });
}

// Keeps the light of the hours, a column each, in place of the files of the command line.
void keep(const HourBlock& block, Eigen::Index& hours, DaylightYearData& made) {
  const auto count = static_cast<Eigen::Index>(block.hours.size());
  made.total.middleCols(hours, count) = block.total.topRows(made.total.rows());
  made.sunlight.middleCols(hours, count) = block.sunlight.topRows(made.sunlight.rows());
  hours += count;
}

SharedYear daylight_year(const SharedStudy& study, const std::filesystem::path& walk,
                         const nb::object& progress) {
  return result_of_long(progress, [&](const Progress& run) -> SharedYear {
    auto made = std::make_shared<DaylightYearData>();
    made->study = study;
    std::vector<SkyHour> hours = sky_hours(study->weather, study->up, study->north);
    require_light(study->weather, hours);
    if (!walk.empty()) check_walk(*study, hours);
    const StudiedModel of = model_of_year(*study, run);
    made->total = Eigen::ArrayXXf::Zero(static_cast<Eigen::Index>(of.sensors.probes.size()),
                                        static_cast<Eigen::Index>(hours.size()));
    made->sunlight = made->total;
    Eigen::Index kept = 0;
    made->year = study_year(*study, of, std::move(hours),
                            [&](const HourBlock& block) { keep(block, kept, *made); });
    if (!walk.empty()) write_walk(walk, *study, of, made->year);
    return made;
  });
}

using SharedInstant = std::shared_ptr<const DaylightInstantData>;

std::vector<SharedInstant> daylight_instants(const SharedStudy& study,
                                             const std::vector<std::string>& texts,
                                             const nb::object& progress) {
  std::vector<SkyHour> skies;
  if (texts.empty()) return {};
  for (const std::string& text : texts) {
    skies.push_back(sky_of_instant(*study, read_clock_time(text), text));
  }
  return result_of_long(progress, [&](const Progress& run) {
    std::vector<SharedInstant> all;
    const StudiedModel of = model_of_instants(*study, run);
    for (std::size_t i = 0; i < skies.size(); ++i) {
      auto made = std::make_shared<DaylightInstantData>();
      made->study = study;
      made->sensors = of.sensors.probes;
      made->report = study_instant(*study, of, skies[i], texts[i]);
      all.push_back(std::move(made));
    }
    return all;
  });
}

void save_year(const SharedYear& made, const std::filesystem::path& folder, bool hourly) {
  run_long(nb::none(), [&](const Progress&) {
    write_year(folder, *made->study, made->year);
    if (!hourly) return;
    HourlyFiles files(folder, static_cast<int>(made->total.rows()));
    files.append({.hours = made->year.hours, .total = made->total, .sunlight = made->sunlight});
    files.commit();
  });
}

void save_instant(const SharedInstant& made, const std::filesystem::path& folder) {
  run_long(nb::none(),
           [&](const Progress&) { write_instant_files(folder, made->sensors, made->report); });
}

// Positions and normals of sensors, n x 3 each.
nb::tuple places_of(const std::vector<Probe>& sensors) {
  std::vector<double> positions, normals;
  for (const Probe& probe : sensors) {
    positions.insert(positions.end(), probe.position.begin(), probe.position.end());
    normals.insert(normals.end(), probe.normal.begin(), probe.normal.end());
  }
  return nb::make_tuple(owned(std::move(positions), {sensors.size(), 3}),
                        owned(std::move(normals), {sensors.size(), 3}));
}

using YearHandle = nb::handle_t<DaylightYearData>;

// A view of light of sensors x hours as hours x sensors.
ArrayOut hours_of_light(Eigen::ArrayXXf DaylightYearData::*light, const YearHandle& self) {
  const Eigen::ArrayXXf& values = nb::cast<const DaylightYearData&>(self).*light;
  return view_of(values.data(),
                 {static_cast<std::size_t>(values.cols()), static_cast<std::size_t>(values.rows())},
                 self);
}

template <class Scalar>
ArrayOut view_of_values(const Eigen::Array<Scalar, Eigen::Dynamic, 1>& values, nb::handle owner) {
  return view_of(values.data(), {static_cast<std::size_t>(values.size())}, owner);
}

// Views of the measures of sensors, in the order of their declaration.
nb::tuple views_of(const SensorMetrics& metrics, nb::handle owner) {
  const auto view = [&](const Eigen::ArrayXd& values) { return view_of_values(values, owner); };
  return nb::make_tuple(view(metrics.autonomy), view(metrics.continuous_autonomy),
                        view(metrics.below_100), view(metrics.from_100_to_300),
                        view(metrics.from_300_to_3000), view(metrics.above_3000),
                        view(metrics.sun_hours), view(metrics.mean_lux), view(metrics.en_above_100),
                        view(metrics.en_above_300), view(metrics.en_above_500),
                        view(metrics.en_above_750), view(metrics.en_median_lux));
}

std::vector<double> numbers_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

// Name, first sensor, number of sensors and grid of each room. A grid has its rows, columns, cell
// of each sensor, corner, directions of columns and of rows, and the two sizes of a cell, m.
nb::list rooms_of(const std::vector<YearRoom>& rooms) {
  nb::list all;
  for (const YearRoom& room : rooms) {
    nb::object grid = nb::none();
    if (room.grid) {
      const LuxGrid& g = *room.grid;
      grid = nb::make_tuple(g.rows, g.columns, owned(std::vector<int>(g.cell), {g.cell.size()}),
                            numbers_of(g.corner), numbers_of(g.u), numbers_of(g.v), g.step_u,
                            g.step_v);
    }
    all.append(nb::make_tuple(room.name, room.first, room.count, grid));
  }
  return all;
}

void add_hours(nb::class_<DaylightYearData>& year) {
  // Number in the year, month, day and hour of the day of each hour.
  year.def_prop_ro("dates",
                   [](const DaylightYearData& y) {
                     std::vector<int> dates;
                     for (const SkyHour& hour : y.year.hours) {
                       const auto [month, day, of_day] =
                           hour_of_year(hour.number, y.study->weather.is_leap_year);
                       dates.insert(dates.end(), {hour.number, month, day, of_day});
                     }
                     return owned(std::move(dates), {y.year.hours.size(), 4});
                   })
      // Altitude and azimuth of the sun, degrees, lux of the sun and of the dome.
      .def_prop_ro("sky",
                   [](const DaylightYearData& y) {
                     std::vector<double> sky;
                     for (const SkyHour& hour : y.year.hours) {
                       sky.insert(sky.end(), {hour.altitude_degrees, hour.azimuth_degrees,
                                              hour.sun_lux, hour.dome_lux});
                     }
                     return owned(std::move(sky), {y.year.hours.size(), 4});
                   })
      .def_prop_ro("lux",
                   [](const YearHandle& y) { return hours_of_light(&DaylightYearData::total, y); })
      .def_prop_ro(
          "sun_lux",
          [](const YearHandle& y) { return hours_of_light(&DaylightYearData::sunlight, y); })
      .def_prop_ro("window_states", [](const YearHandle& self) {
        const Eigen::ArrayXXi& states = nb::cast<const DaylightYearData&>(self).year.states;
        return view_of(
            states.data(),
            {static_cast<std::size_t>(states.cols()), static_cast<std::size_t>(states.rows())},
            self);
      });
}

void add_year(nb::module_& module) {
  nb::class_<DaylightYearData> year(module, "DaylightYearData");
  add_hours(year);
  year.def_prop_ro(
          "days",
          [](const DaylightYearData& y) { return y.study->weather.hours.size() / hours_a_day; })
      .def_prop_ro("study", [](const DaylightYearData& y) { return y.study; })
      .def_prop_ro("places", [](const DaylightYearData& y) { return places_of(y.year.sensors); })
      .def_prop_ro("rooms", [](const DaylightYearData& y) { return rooms_of(y.year.report.rooms); })
      .def_prop_ro("measures",
                   [](const YearHandle& self) {
                     const StudiedYear& y = nb::cast<const DaylightYearData&>(self).year;
                     return nb::make_tuple(views_of(y.report.sensors, self),
                                           views_of(y.bounds.least, self),
                                           views_of(y.bounds.most, self));
                   })
      .def_prop_ro("daylight_factor",
                   [](const YearHandle& self) {
                     // Observers come behind the sensors.
                     const StudiedYear& y = nb::cast<const DaylightYearData&>(self).year;
                     return view_of(y.report.daylight_factor.data(), {y.sensors.size()}, self);
                   })
      // Name, DGP and vertical lux of each observer.
      .def_prop_ro("glare",
                   [](const YearHandle& self) {
                     nb::list all;
                     for (const GlareOfYear& eye :
                          nb::cast<const DaylightYearData&>(self).year.report.glare) {
                       all.append(nb::make_tuple(
                           eye.name, view_of(eye.dgp.data(), {eye.dgp.size()}, self),
                           view_of(eye.vertical_lux.data(), {eye.vertical_lux.size()}, self)));
                     }
                     return all;
                   })
      .def_prop_ro("figures",
                   [](const DaylightYearData& y) { return json_text(year_json(y.year.report)); })
      .def_prop_ro("text", [](const DaylightYearData& y) { return year_text(y.year.report); });
}

void add_instant(nb::module_& module) {
  using InstantHandle = nb::handle_t<DaylightInstantData>;
  nb::class_<DaylightInstantData>(module, "DaylightInstantData")
      .def_prop_ro("places", [](const DaylightInstantData& i) { return places_of(i.sensors); })
      .def_prop_ro("rooms",
                   [](const DaylightInstantData& i) { return rooms_of(i.report.of.rooms); })
      .def_prop_ro("lux",
                   [](const InstantHandle& i) {
                     return view_of_values(nb::cast<const DaylightInstantData&>(i).report.total, i);
                   })
      .def_prop_ro("sun_lux",
                   [](const InstantHandle& i) {
                     return view_of_values(nb::cast<const DaylightInstantData&>(i).report.sunlight,
                                           i);
                   })
      .def_prop_ro("when", [](const DaylightInstantData& i) { return i.report.when; })
      .def_prop_ro("figures",
                   [](const DaylightInstantData& i) { return json_text(instant_json(i.report)); });
}

using SettingsClass = nb::class_<DaylightSettings>;

void add_sensor_settings(SettingsClass& settings) {
  settings
      .def("set_points",
           [](DaylightSettings& s, const PointsIn& points, const PointsIn& normals) {
             s.study.points = probes_from(points, normals);
           })
      .def("set_sun_points",
           [](DaylightSettings& s, const PointsIn& points) {
             s.study.sun_points = points_from(points);
           })
      .def("add_plane",
           [](DaylightSettings& s, const std::string& name, double height) {
             s.study.request.planes.push_back({name, height});
           })
      .def("add_observer",
           [](DaylightSettings& s, const Camera& eye) { s.study.eyes.push_back(eye); })
      .def("add_observer_named",
           [](DaylightSettings& s, const SharedScene& scene, const std::string& name) {
             s.study.eyes.push_back(choose_camera(scene->clean, name));
           })
      .def_prop_rw(
          "surfaces", [](const DaylightSettings& s) { return s.study.request.surfaces; },
          [](DaylightSettings& s, std::vector<std::string> names) {
            s.study.request.surfaces = std::move(names);
          })
      .def_prop_rw(
          "margin", [](const DaylightSettings& s) { return s.study.request.margin; },
          [](DaylightSettings& s, std::optional<double> v) { s.study.request.margin = v; })
      .def_prop_rw(
          "spacing", [](const DaylightSettings& s) { return s.study.request.spacing; },
          [](DaylightSettings& s, double v) { s.study.request.spacing = positive("spacing", v); });
}

void add_settings(nb::module_& module) {
  SettingsClass settings(module, "DaylightSettings");
  settings.def(nb::init<>());
  add_sensor_settings(settings);
  settings.def_rw("north", &DaylightSettings::north_degrees)
      .def_rw("windows", &DaylightSettings::windows)
      .def_rw("rooms", &DaylightSettings::rooms)
      .def_rw("ratings", &DaylightSettings::ratings)
      .def_rw("rating_table", &DaylightSettings::rating_table)
      .def_prop_rw(
          "ground", [](const DaylightSettings& s) { return s.study.ground_reflectance; },
          [](DaylightSettings& s, double v) { s.study.ground_reflectance = v; })
      .def("set_occupied",
           [](DaylightSettings& s, const std::string& hours) {
             s.study.occupancy = read_occupancy(hours);
           })
      .def("set_sun_day",
           [](DaylightSettings& s, const std::string& day, double least_altitude_degrees) {
             s.study.sun_day = read_exposure_day(day);
             s.study.sun_day.least_altitude_degrees = least_altitude_degrees;
           })
      .def_prop_rw(
          "sky", [](const DaylightSettings& s) { return s.study.options.sky_subdivision; },
          [](DaylightSettings& s, int v) {
            s.study.options.sky_subdivision = whole_number("sky", v, 1, 8);
          })
      .def_prop_rw(
          "rays", [](const DaylightSettings& s) { return s.study.options.gather_rays; },
          [](DaylightSettings& s, int v) { s.study.options.gather_rays = power_of_two("rays", v); })
      .def_prop_rw(
          "max_patch_size",
          [](const DaylightSettings& s) { return s.study.options.mesh.max_patch_size; },
          [](DaylightSettings& s, double v) {
            s.study.options.mesh.max_patch_size = positive("max_patch_size", v);
          });
}

}  // namespace

void add_daylight(nb::module_& module) {
  add_settings(module);
  add_year(module);
  add_instant(module);
  nb::class_<DaylightStudy>(module, "DaylightStudy");
  module.def("daylight_study", study_of, nb::arg("scene"), nb::arg("weather"), nb::arg("settings"));
  module.def("daylight_year", daylight_year, nb::arg("study"), nb::arg("walk"),
             nb::arg("progress").none());
  module.def("daylight_instants", daylight_instants, nb::arg("study"), nb::arg("times"),
             nb::arg("progress").none());
  module.def("save_year", save_year, nb::arg("year"), nb::arg("folder"), nb::arg("hourly"));
  module.def("save_instant", save_instant, nb::arg("instant"), nb::arg("folder"));
}

}  // namespace lightwell::python
