#include <fmt/format.h>
#include <fmt/ostream.h>

#include <array>

#include "cli/shortwave.h"
#include "scene/atomic_file.h"
#include "scene/io/comma_fields.h"

namespace lightwell {
namespace {

// Names of the columns of light in W/m^2, or, of hours, in kWh/m^2.
template <std::size_t count>
void write_names(std::ostream& out, const std::array<const char*, count>& names, bool is_of_hours) {
  for (const char* name : names) fmt::print(out, ",{}{}", name, is_of_hours ? "_kwh" : "");
  out << '\n';
}

double unit_of(const ShortwaveResult& of) {
  constexpr double kilo = 1e3;
  return of.is_of_hours() ? kilo : 1.0;
}

}  // namespace

void write_shortwave_rows(const std::filesystem::path& csv, const ShortwaveResult& of) {
  AtomicStream target(csv);
  std::ostream& out = target.stream();
  out << "row,surface,facet,area,albedo,sky_view_factor";
  write_names(out, std::array{"direct", "diffuse", "reflected", "net"}, of.is_of_hours());
  const ViewFactorRows& rows = of.found.rows;
  const double unit = unit_of(of);
  for (int i = 0; i < rows.count(); ++i) {
    const auto r = static_cast<std::size_t>(i);
    fmt::print(out, "{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", i + 1,
               quoted_field(rows.name[r]), rows.facet[r], of.found.factors.area[r], of.albedo[i],
               of.sky_view[i], of.sums.direct[i] / unit, of.sums.diffuse[i] / unit,
               of.sums.reflected[i] / unit, of.sums.net[i] / unit);
  }
  target.commit();
}

void write_shortwave_points(const std::filesystem::path& csv, const ShortwaveResult& of,
                            double metres_per_unit) {
  AtomicStream target(csv);
  std::ostream& out = target.stream();
  out << "x,y,z,nx,ny,nz,sky_view_factor";
  write_names(out, std::array{"direct", "diffuse", "reflected", "total"}, of.is_of_hours());
  const double unit = unit_of(of);
  for (std::size_t p = 0; p < of.probes.size(); ++p) {
    const Eigen::Vector3d at = of.probes[p].position / metres_per_unit, &n = of.probes[p].normal;
    const auto i = static_cast<Eigen::Index>(p);
    const double direct = of.sums.point_direct[i] / unit, diffuse = of.sums.point_diffuse[i] / unit,
                 reflected = of.sums.point_reflected[i] / unit;
    fmt::print(out, "{},{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", at.x(), at.y(),
               at.z(), n.x(), n.y(), n.z(), of.point_sky_view[i], direct, diffuse, reflected,
               direct + diffuse + reflected);
  }
  target.commit();
}

void write_shortwave_hours(const std::filesystem::path& csv, const ShortwaveResult& of) {
  AtomicStream target(csv);
  std::ostream& out = target.stream();
  out << "hour,month,day,time,altitude,azimuth,direct_normal,diffuse_horizontal,arriving,absorbed,"
         "escaped\n";
  for (std::size_t h = 0; h < of.hours.size(); ++h) {
    const SunHour& hour = of.hours[h];
    const HourPower& power = of.powers[h];
    const auto [month, day, begin] = hour_of_year(hour.number, of.weather.is_leap_year);
    fmt::print(out, "{},{},{},{:02d}:30,{:.4f},{:.4f},{:.6g},{:.6g},{:.9g},{:.9g},{:.9g}\n",
               hour.number, month, day, begin, hour.altitude_degrees, hour.azimuth_degrees,
               hour.direct_normal, hour.diffuse_horizontal, power.arriving, power.absorbed,
               power.escaped);
  }
  target.commit();
}

}  // namespace lightwell
