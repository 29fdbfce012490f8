#include "scene/io/mitsuba/mitsuba_sunsky.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scene/clear_sky.h"
#include "scene/degree.h"
#include "scene/io/mitsuba/mitsuba_transform.h"
#include "scene/sun_position.h"

namespace lightwell {
namespace {

// Directions of an emitter in the scene.
struct Axes {
  Eigen::Vector3d up{}, north{}, east{};
};

bool is_before_mitsuba_2(const MitsubaTree& tree) {
  const std::string* version = tree.root().attribute("version");
  return version && version->starts_with("0.");
}

Axes axes_of(const MitsubaNode& emitter, bool is_old) {
  const Eigen::Matrix3d turn = read_turn(emitter);
  const auto x = turn.col(0), y = turn.col(1), z = turn.col(2);
  if (is_old) return {.up = y, .north = -z, .east = x};
  return {.up = z, .north = -x, .east = -y};
}

double number_within(const MitsubaNode& emitter, const char* name, double otherwise, double least,
                     double most) {
  const double value = emitter.number_or(name, otherwise);
  if (!(value >= least && value <= most)) {
    emitter.fail(fmt::format("has the {} {:g}; give {:g} to {:g}", name, value, least, most));
  }
  return value;
}

int whole_within(const MitsubaNode& emitter, const char* name, int otherwise, int least, int most) {
  const double value = number_within(emitter, name, otherwise, least, most);
  if (value != std::floor(value)) {
    emitter.fail(fmt::format("has the {} {:g}; give a whole number", name, value));
  }
  return static_cast<int>(value);
}

// Unit direction towards the sun. Whatever of date and place is missing is that of Mitsuba: Tokyo
// on 10 July 2010, 15:00.
Eigen::Vector3d sun_direction_of(const MitsubaNode& emitter, const Axes& axes) {
  if (const MitsubaNode* given = emitter.property("sun_direction")) {
    const Eigen::Vector3d direction = read_mitsuba_point(*given);
    if (!(direction.stableNorm() > 0.0)) emitter.fail("has a sun_direction without length");
    return direction.stableNormalized();
  }
  const ClockTime when{.year = whole_within(emitter, "year", 2010, 1900, 2100),
                       .month = whole_within(emitter, "month", 7, 1, 12),
                       .day = whole_within(emitter, "day", 10, 1, 31),
                       .hour = number_within(emitter, "hour", 15.0, 0.0, 24.0) +
                               number_within(emitter, "minute", 0.0, 0.0, 60.0) / 60.0 +
                               number_within(emitter, "second", 0.0, 0.0, 60.0) / 3600.0,
                       .hours_east = number_within(emitter, "timezone", 9.0, -14.0, 14.0)};
  try {
    const SunPosition at =
        sun_position(when, number_within(emitter, "latitude", 35.6894, -90.0, 90.0),
                     number_within(emitter, "longitude", 139.6917, -180.0, 180.0));
    const double azimuth = at.azimuth_degrees * degree, altitude = at.altitude_degrees * degree;
    return (std::cos(altitude) * (std::cos(azimuth) * axes.north + std::sin(azimuth) * axes.east) +
            std::sin(altitude) * axes.up)
        .normalized();
  } catch (const std::invalid_argument& error) {
    emitter.fail(fmt::format("has a sun that stands nowhere: {}", error.what()));
  }
}

double scale_of(const MitsubaNode& emitter, const char* name) {
  const double scale = emitter.number_or(name, emitter.number_or("scale", 1.0));
  if (!(scale >= 0.0)) emitter.fail(fmt::format("has the {} {:g}; give at least 0", name, scale));
  return scale;
}

// Angle across the disc of the sun.
double width_of_sun(const MitsubaNode& emitter, Remarks& remarks) {
  constexpr double usual = 0.5358, widest = 10.0;
  const double scale = emitter.number_or("sun_radius_scale", 1.0);
  const double width = emitter.number_or("sun_aperture", scale == 0.0 ? usual : usual * scale);
  if (!(width > 0.0)) emitter.fail(fmt::format("has a sun {:g} degrees across", width));
  if (width > widest) remarks.add("Suns were narrowed to 10 degrees", emitter.label());
  return std::min(width, widest);
}

}  // namespace

SkyParts clear_day_parts(const MitsubaNode& emitter) {
  const bool is_both = emitter.type == "sunsky";
  return {.dome = is_both || emitter.type == "sky", .sun = is_both || emitter.type == "sun"};
}

void set_clear_day(const MitsubaNode& emitter, const MitsubaTree& tree, MitsubaColors& colors,
                   Remarks& remarks, const SkyParts& parts, Sky& sky) {
  const bool is_old = is_before_mitsuba_2(tree);
  const Axes axes = axes_of(emitter, is_old);
  sky.up = axes.up;
  sky.north = axes.north;
  const Eigen::Vector3d to_sun = sun_direction_of(emitter, axes);
  const double altitude = std::asin(std::clamp(to_sun.dot(axes.up), -1.0, 1.0)) / degree;
  if (!(altitude > 0.0)) {
    emitter.fail(
        fmt::format("has its sun {:.1f} degrees below the horizon, where its model has no light; "
                    "give another time, or a sun_direction above the horizon",
                    -altitude));
  }
  const ClearDay day{
      .turbidity = number_within(emitter, "turbidity", 3.0, 1.0, 10.0),
      .sun_altitude_degrees = altitude,
      .albedo = colors.share_or(emitter, "albedo", is_old ? 0.2f : 0.3f, Pixels::all)};
  const double stretch = number_within(emitter, "stretch", 1.0, 1.0, 2.0);
  const double dome_scale = parts.dome ? scale_of(emitter, "sky_scale") : 0.0;
  const double sun_scale = parts.sun ? scale_of(emitter, "sun_scale") : 0.0;
  if (dome_scale > 0.0) {
    set_clear_dome(day, {.scale = dome_scale, .stretch = stretch, .below = Spectrum::Zero(3)},
                   to_sun, sky);
    remarks.add(
        "Skies by Hosek & Wilkie became fits to them, within 4% in illuminance for turbidities of "
        "2 to 8 and a sun 5 degrees high or more",
        emitter.label());
    if (emitter.boolean_or("extend", false)) {
      remarks.add("Skies that extend below the horizon end there", emitter.label());
    }
  }
  if (sun_scale > 0.0) {
    remarks.add(
        "Suns behind clear air became fits to their models, within 8% in illuminance for "
        "turbidities of 2 to 8 and a sun 10 degrees high or more",
        emitter.label());
    const ClearSunModel model = is_old ? ClearSunModel::preetham : ClearSunModel::hosek_wilkie;
    // A stretched dome takes the sun along.
    const double zenith = std::min((90.0 - altitude) * stretch, 180.0) * degree;
    const Eigen::Vector3d level = (to_sun - to_sun.dot(axes.up) * axes.up).normalized();
    sky.sun = Sun{
        .direction = stretch == 1.0
                         ? to_sun
                         : Eigen::Vector3d(std::cos(zenith) * axes.up + std::sin(zenith) * level),
        .irradiance =
            clear_sun_irradiance(model, day.turbidity, altitude) * static_cast<float>(sun_scale),
        .angle_degrees = width_of_sun(emitter, remarks)};
    sky.sun->direction.normalize();
  }
}

}  // namespace lightwell
