#include "radiosity/radiation/shortwave.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "python/binding/arrays.h"
#include "python/binding/found_form_factors.h"
#include "python/binding/long_work.h"
#include "python/binding/module.h"
#include "radiosity/radiation/shortwave_model.h"
#include "raytrace/readings/exposure_points.h"
#include "scene/io/weather/sun_hours.h"
#include "scene/sky.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

using RowMajor = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Light of instants: arrays of instants x rows or points, W/m^2, and of instants, W.
struct ShortwaveArrays {
  RowMajor direct{}, diffuse{}, reflected{}, net{};
  RowMajor point_direct{}, point_diffuse{}, point_reflected{};
  Eigen::ArrayXd arriving{}, absorbed{}, escaped{};
  Eigen::ArrayXd sky_view{}, point_sky_view{};

  ShortwaveArrays(Eigen::Index instants, const ShortwaveModel& model)
      : arriving(instants),
        absorbed(instants),
        escaped(instants),
        sky_view(model.sky_view()),
        point_sky_view(model.points().sky) {
    for (RowMajor* array : {&direct, &diffuse, &reflected, &net}) {
      array->resize(instants, sky_view.size());
    }
    for (RowMajor* array : {&point_direct, &point_diffuse, &point_reflected}) {
      array->resize(instants, point_sky_view.size());
    }
  }

  void set(Eigen::Index number, const ShortwaveInstant& light) {
    direct.row(number) = light.direct.transpose();
    diffuse.row(number) = light.diffuse.transpose();
    reflected.row(number) = light.exchange.reflected.transpose();
    net.row(number) = light.exchange.net.transpose();
    point_direct.row(number) = light.point_direct.transpose();
    point_diffuse.row(number) = light.point_diffuse.transpose();
    point_reflected.row(number) = light.point_reflected.transpose();
    arriving[number] = light.exchange.arriving;
    absorbed[number] = light.exchange.absorbed;
    escaped[number] = light.exchange.escaped;
  }
};

/// Sun and sky of instants, and what they fall on, as arrays.
struct ShortwaveQuestion {
  std::array<double, 3> up{0.0, 0.0, 1.0};  ///< unit
  PointsIn suns{};                          ///< unit
  ListIn<double> direct{}, diffuse{}, albedo{};
  PointsIn points{}, normals{};
  ListIn<std::int32_t> days{};  ///< of the year, from 1, under Perez' sky; none: an even sky
  int rays = rays_of_one_sun;
};

Eigen::ArrayXd array_from(const ListIn<double>& values) {
  return Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::Vector3d up_of(const ShortwaveQuestion& asked) {
  return {asked.up[0], asked.up[1], asked.up[2]};
}

std::vector<SunAndSky> instants_from(const ShortwaveQuestion& asked) {
  const std::vector<Eigen::Vector3d> suns = points_from(asked.suns);
  std::vector<SunAndSky> instants(suns.size());
  for (std::size_t h = 0; h < instants.size(); ++h) {
    instants[h] = {
        .sun = suns[h], .direct = asked.direct.data()[h], .diffuse = asked.diffuse.data()[h]};
    if (asked.days.size() == 0) continue;
    instants[h] = under_perez_sky(instants[h], up_of(asked), asked.days.data()[h]);
  }
  return instants;
}

std::vector<Probe> probes_of(const ShortwaveQuestion& asked) {
  const std::vector<Eigen::Vector3d> positions = points_from(asked.points),
                                     normals = points_from(asked.normals);
  std::vector<Probe> probes(positions.size());
  for (std::size_t i = 0; i < probes.size(); ++i) {
    probes[i] = {.position = positions[i], .normal = normals[i].normalized()};
  }
  return probes;
}

std::shared_ptr<ShortwaveArrays> shortwave(const FoundFormFactors& found,
                                           const ShortwaveQuestion& asked,
                                           const nb::object& progress) {
  const std::vector<SunAndSky> instants = instants_from(asked);
  const std::vector<Probe> probes = probes_of(asked);
  const Eigen::ArrayXd albedo = array_from(asked.albedo);
  const Eigen::Vector3d up = up_of(asked);
  const bool is_even = asked.days.size() == 0;
  const int rays = asked.rays;
  return result_of_long(progress, [&](const Progress& run) {
    const ElementCaster caster(found.factors.mesh);
    ShortwaveModel model(found.factors, caster, exposure_points(caster, probes), up, run);
    if (!is_even) model.see_dome(run);
    auto arrays =
        std::make_shared<ShortwaveArrays>(static_cast<Eigen::Index>(instants.size()), model);
    model.run(
        instants, albedo, rays,
        [&](int number, const ShortwaveInstant& light) { arrays->set(number, light); }, run);
    return arrays;
  });
}

ArrayOut table(const RowMajor& values) {
  return owned(RowMajor(values),
               {static_cast<std::size_t>(values.rows()), static_cast<std::size_t>(values.cols())});
}

ArrayOut list(const Eigen::ArrayXd& values) {
  return owned(Eigen::ArrayXd(values), {static_cast<std::size_t>(values.size())});
}

void add_weather(nb::module_& module) {
  nb::class_<Weather>(module, "WeatherData")
      .def_prop_ro("place", [](const Weather& w) { return w.place; })
      .def_ro("latitude", &Weather::latitude)
      .def_ro("longitude", &Weather::longitude)
      .def_ro("hours_east", &Weather::hours_east)
      .def_prop_ro("notes", [](const Weather& w) { return w.notes; })
      // Month, day and hour of the day, and the hour of the year.
      .def_prop_ro("dates",
                   [](const Weather& w) {
                     std::vector<int> dates;
                     for (const SunHour& hour : sun_hours(w)) {
                       const auto [month, day, begin] = hour_of_year(hour.number, w.is_leap_year);
                       dates.insert(dates.end(), {month, day, begin, hour.number});
                     }
                     const std::size_t count = dates.size() / 4;
                     return owned(std::move(dates), {count, 4});
                   })
      // Altitude and azimuth, degrees; direct and diffuse light, W/m^2.
      .def_prop_ro("light",
                   [](const Weather& w) {
                     std::vector<double> light;
                     for (const SunHour& hour : sun_hours(w)) {
                       light.insert(light.end(), {hour.altitude_degrees, hour.azimuth_degrees,
                                                  hour.direct_normal, hour.diffuse_horizontal});
                     }
                     const std::size_t count = light.size() / 4;
                     return owned(std::move(light), {count, 4});
                   })
      // Unit vectors to the sun of each hour; `up` and `north` are unit and at right angles.
      .def("suns", [](const Weather& w, const std::array<double, 3>& up,
                      const std::array<double, 3>& north) {
        Sky compass;
        compass.up = Eigen::Vector3d(up[0], up[1], up[2]);
        compass.north = Eigen::Vector3d(north[0], north[1], north[2]);
        std::vector<double> suns;
        for (const SunHour& hour : sun_hours(w)) {
          const Eigen::Vector3d sun =
              sky_direction(compass, hour.azimuth_degrees, hour.altitude_degrees);
          suns.insert(suns.end(), sun.begin(), sun.end());
        }
        const std::size_t count = suns.size() / 3;
        return owned(std::move(suns), {count, 3});
      });
  module.def("read_weather", [](const std::filesystem::path& path) {
    return result_of_long(nb::none(), [&](const Progress&) { return read_weather(path); });
  });
}

}  // namespace

void add_shortwave(nb::module_& module) {
  nb::class_<ShortwaveQuestion>(module, "ShortwaveQuestion")
      .def(nb::init<>())
      .def_rw("up", &ShortwaveQuestion::up)
      .def_rw("suns", &ShortwaveQuestion::suns)
      .def_rw("direct", &ShortwaveQuestion::direct)
      .def_rw("diffuse", &ShortwaveQuestion::diffuse)
      .def_rw("albedo", &ShortwaveQuestion::albedo)
      .def_rw("days", &ShortwaveQuestion::days)
      .def_rw("points", &ShortwaveQuestion::points)
      .def_rw("normals", &ShortwaveQuestion::normals)
      .def_rw("rays", &ShortwaveQuestion::rays);
  using Arrays = ShortwaveArrays;
  nb::class_<Arrays>(module, "ShortwaveArrays")
      .def_prop_ro("sky_view", [](const Arrays& a) { return list(a.sky_view); })
      .def_prop_ro("direct", [](const Arrays& a) { return table(a.direct); })
      .def_prop_ro("diffuse", [](const Arrays& a) { return table(a.diffuse); })
      .def_prop_ro("reflected", [](const Arrays& a) { return table(a.reflected); })
      .def_prop_ro("net", [](const Arrays& a) { return table(a.net); })
      .def_prop_ro("arriving", [](const Arrays& a) { return list(a.arriving); })
      .def_prop_ro("absorbed", [](const Arrays& a) { return list(a.absorbed); })
      .def_prop_ro("escaped", [](const Arrays& a) { return list(a.escaped); })
      .def_prop_ro("point_sky_view", [](const Arrays& a) { return list(a.point_sky_view); })
      .def_prop_ro("point_direct", [](const Arrays& a) { return table(a.point_direct); })
      .def_prop_ro("point_diffuse", [](const Arrays& a) { return table(a.point_diffuse); })
      .def_prop_ro("point_reflected", [](const Arrays& a) { return table(a.point_reflected); });
  module.def("shortwave", shortwave, nb::arg("found"), nb::arg("asked"),
             nb::arg("progress").none());
  module.attr("rays_of_one_sun") = rays_of_one_sun;
  module.attr("rays_of_many_suns") = rays_of_many_suns;
  add_weather(module);
}

}  // namespace lightwell::python
