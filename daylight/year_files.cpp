#include "daylight/year_files.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <bit>
#include <string>

#include "scene/io/comma_fields.h"
#include "scene/io/weather/weather_file.h"

namespace lightwell {
namespace {

// The header is as long for any number of rows, so that it can be written again.
constexpr std::size_t header_bytes = 128;

static_assert(std::endian::native == std::endian::little, "'<f4' in NumPy's header");

}  // namespace

NumpyRows::NumpyRows(const std::filesystem::path& file, int columns)
    : file_(file), columns_(columns) {
  write_header();
}

void NumpyRows::write_header() {
  std::string header = "\x93NUMPY";
  header += '\x01';
  header += '\x00';
  constexpr std::size_t preamble = 10;
  constexpr auto rest = static_cast<char>(header_bytes - preamble);
  header += rest;
  header += '\x00';
  header += fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}), }}", rows_,
                        columns_);
  header.resize(header_bytes - 1, ' ');
  header += '\n';
  file_.stream().write(header.data(), static_cast<std::streamsize>(header.size()));
}

void NumpyRows::append(const Eigen::ArrayXXf& values) {
  // Columns of an Eigen array are contiguous.
  file_.stream().write(reinterpret_cast<const char*>(values.data()),
                       static_cast<std::streamsize>(values.size() * sizeof(float)));
  rows_ += values.cols();
}

void NumpyRows::commit() {
  file_.stream().seekp(0);
  write_header();
  file_.commit();
}

HourlyFiles::HourlyFiles(const std::filesystem::path& folder, int sensors)
    : sensors_(sensors),
      total_(folder / "illuminance.npy", sensors),
      sunlight_(folder / "sunlight.npy", sensors) {}

void HourlyFiles::append(const HourBlock& block) {
  total_.append(block.total.topRows(sensors_));
  sunlight_.append(block.sunlight.topRows(sensors_));
}

void HourlyFiles::commit() {
  total_.commit();
  sunlight_.commit();
}

void write_sensors(const std::filesystem::path& csv, std::span<const Probe> sensors,
                   const SensorMetrics& metrics, const Eigen::ArrayXf& daylight_factor,
                   double metres_per_unit) {
  AtomicStream file(csv);
  std::ostream& out = file.stream();
  fmt::print(out,
             "x,y,z,nx,ny,nz,DA300,cDA300,UDI_below_100,UDI_100_300,UDI_300_3000,UDI_above_3000,"
             "sun_hours_1000,mean_lux,EN_above_100,EN_above_300,EN_above_500,EN_above_750,"
             "EN_median_lux,DF\n");
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const Eigen::Vector3d p = sensors[s].position / metres_per_unit, &n = sensors[s].normal;
    const auto i = static_cast<Eigen::Index>(s);
    fmt::print(out, "{},{},{},{},{},{}", p.x(), p.y(), p.z(), n.x(), n.y(), n.z());
    for (const Eigen::ArrayXd* values :
         {&metrics.autonomy, &metrics.continuous_autonomy, &metrics.below_100,
          &metrics.from_100_to_300, &metrics.from_300_to_3000, &metrics.above_3000,
          &metrics.sun_hours, &metrics.mean_lux, &metrics.en_above_100, &metrics.en_above_300,
          &metrics.en_above_500, &metrics.en_above_750, &metrics.en_median_lux}) {
      fmt::print(out, ",{:.6g}", (*values)[i]);
    }
    fmt::print(out, ",{:.6g}\n", 100.0 * double{daylight_factor[i]});
  }
  file.commit();
}

void write_hours(const std::filesystem::path& csv, const HourTable& table) {
  AtomicStream file(csv);
  std::ostream& out = file.stream();
  fmt::print(out, "hour,month,day,standard_time,sun_altitude,sun_azimuth,sun_lux,dome_lux");
  for (const WindowGroup& group : table.windows.groups)
    fmt::print(out, ",{}", quoted_field(group.name));
  fmt::print(out, "\n");
  for (std::size_t h = 0; h < table.hours.size(); ++h) {
    const SkyHour& hour = table.hours[h];
    const auto [month, day, of_day] = hour_of_year(hour.number, table.is_leap_year);
    fmt::print(out, "{},{},{},{:.1f},{:.4f},{:.4f},{:.6g},{:.6g}", hour.number, month, day,
               of_day + 0.5, hour.altitude_degrees, hour.azimuth_degrees, hour.sun_lux,
               hour.dome_lux);
    for (std::size_t g = 0; g < table.windows.groups.size(); ++g) {
      const int state = table.states(static_cast<Eigen::Index>(g), static_cast<Eigen::Index>(h));
      const WindowState& named = table.windows.groups[g].states[static_cast<std::size_t>(state)];
      fmt::print(out, ",{}", quoted_field(named.name));
    }
    fmt::print(out, "\n");
  }
  file.commit();
}

void write_glare(const std::filesystem::path& csv, std::span<const SkyHour> hours,
                 std::span<const GlareOfYear> eyes) {
  AtomicStream file(csv);
  std::ostream& out = file.stream();
  fmt::print(out, "hour");
  for (const GlareOfYear& eye : eyes) {
    fmt::print(out, ",{},{}", quoted_field(eye.name + " lux"), quoted_field(eye.name + " DGP"));
  }
  fmt::print(out, "\n");
  for (std::size_t h = 0; h < hours.size(); ++h) {
    fmt::print(out, "{}", hours[h].number);
    for (const GlareOfYear& eye : eyes) {
      fmt::print(out, ",{:.6g},{:.4f}", eye.vertical_lux[h], eye.dgp[h]);
    }
    fmt::print(out, "\n");
  }
  file.commit();
}

void write_instant(const std::filesystem::path& csv, std::span<const Probe> sensors,
                   const Eigen::ArrayXf& total, const Eigen::ArrayXf& sunlight,
                   double metres_per_unit) {
  AtomicStream file(csv);
  std::ostream& out = file.stream();
  fmt::print(out, "x,y,z,nx,ny,nz,lux,sun_lux\n");
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const Eigen::Vector3d p = sensors[s].position / metres_per_unit, &n = sensors[s].normal;
    const auto i = static_cast<Eigen::Index>(s);
    fmt::print(out, "{},{},{},{},{},{},{:.6g},{:.6g}\n", p.x(), p.y(), p.z(), n.x(), n.y(), n.z(),
               total[i], sunlight[i]);
  }
  file.commit();
}

}  // namespace lightwell
