#include "standards/road/road_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/degree.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Directions of C0, of C90 and of the zenith of a luminaire whose side of the road looks along
// `facing` times y.
Eigen::Matrix3d road_axes(const RoadLuminaires& luminaires, double facing) {
  const double tilt = luminaires.tilt * degree;
  const Vector3d side(0.0, facing, 0.0), up = Vector3d::UnitZ();
  const Vector3d street = std::cos(tilt) * side + std::sin(tilt) * up;
  const Vector3d zenith = std::cos(tilt) * up - std::sin(tilt) * side;
  // The plane C = street_side has the direction `street`; azimuths grow counter-clockwise.
  const Vector3d along = street.cross(zenith);
  const double turn = luminaires.street_side * degree;
  Eigen::Matrix3d axes;
  axes.col(0) = std::cos(turn) * street + std::sin(turn) * along;
  axes.col(1) = zenith.cross(axes.col(0));
  axes.col(2) = zenith;
  return axes;
}

// Angle in degrees between the vertical planes of sight and of light: 0 where the light comes from
// straight beyond the point, and below a luminaire.
double beta_of(const Vector3d& sight, const Vector3d& to_light) {
  const double cross = std::abs(sight.x() * to_light.y() - sight.y() * to_light.x());
  const double dot = sight.x() * to_light.x() + sight.y() * to_light.y();
  return std::atan2(cross, dot) / degree;
}

}  // namespace

RoadLight::RoadLight(const Road& road, double from, double to)
    : file_(road.luminaires.file),
      flux_factor_(road.luminaires.flux_factor),
      height_(road.luminaires.height) {
  const double spacing = road.luminaires.spacing;
  for (const LuminaireRowPlace& row : luminaire_rows(road)) {
    const Eigen::Matrix3d axes = road_axes(road.luminaires, row.facing);
    const double begin = std::ceil((from - row.first) / spacing);
    for (double k = begin; row.first + k * spacing <= to; k += 1.0) {
      placed_.push_back({{row.first + k * spacing, row.y, height_}, axes});
    }
  }
}

double RoadLight::intensity(const Placed& luminaire, const Vector3d& way) const {
  return flux_factor_ * file_->web->at(luminaire.axes.transpose() * way);
}

// Visits the luminaires within 5 heights along and across with the vector from them to the point.
template <class Visit>
void RoadLight::for_each_near(const Vector3d& point, Visit&& visit) const {
  const double reach = heights_around_point * height_;
  for (const Placed& luminaire : placed_) {
    const Vector3d way = point - luminaire.position;
    if (std::abs(way.x()) <= reach && std::abs(way.y()) <= reach) visit(luminaire, way);
  }
}

double RoadLight::illuminance(const Vector3d& point) const {
  double lux = 0.0;
  for_each_near(point, [&](const Placed& luminaire, const Vector3d& way) {
    const double d = way.norm();
    lux += intensity(luminaire, way) * -way.z() / (d * d * d);
  });
  return lux;
}

double RoadLight::semicylindrical(const Vector3d& point, const Vector3d& facing) const {
  double lux = 0.0;
  for_each_near(point, [&](const Placed& luminaire, const Vector3d& way) {
    const double d = way.norm(), level = std::hypot(way.x(), way.y());
    if (!(level > 0.0)) return;
    const double cosine = -way.dot(facing) / level;
    lux += intensity(luminaire, way) * (1.0 + cosine) * (level / d) / (std::numbers::pi * d * d);
  });
  return lux;
}

double RoadLight::vertical(const Vector3d& point, const Vector3d& facing) const {
  double lux = 0.0;
  for_each_near(point, [&](const Placed& luminaire, const Vector3d& way) {
    const double d = way.norm();
    lux += intensity(luminaire, way) * std::max(0.0, -way.dot(facing)) / (d * d * d);
  });
  return lux;
}

double RoadLight::luminance(const RTable& surface, const Vector3d& point,
                            const Vector3d& eye) const {
  const Vector3d sight = point - eye;
  const double way = sight.x() > 0.0 ? 1.0 : -1.0;
  const double reach = heights_around_point * height_;
  double sum = 0.0;
  for (const Placed& luminaire : placed_) {
    const Vector3d to_light = luminaire.position - point;
    const double beyond = way * to_light.x();
    if (beyond < -reach || beyond > heights_beyond_point * height_) continue;
    if (std::abs(to_light.y()) > reach) continue;
    const double tangent = std::hypot(to_light.x(), to_light.y()) / to_light.z();
    const double r = reduced_luminance_coefficient(surface, tangent, beta_of(sight, to_light));
    sum += r * intensity(luminaire, -to_light) / (to_light.z() * to_light.z());
  }
  return sum;
}

double RoadLight::veiling_luminance(const Vector3d& eye, double way) const {
  constexpr double screen = 20.0, down = 1.0, age = 23.0;
  constexpr double nearest_angle = 0.1, narrow = 1.5, widest = 60.0;  // degrees
  const double wide_factor = 9.86 * (1.0 + std::pow(age / 66.4, 4));
  const double narrow_factor = 5.0 * (1.0 + std::pow(age / 62.5, 4));
  const Vector3d look(way * std::cos(down * degree), 0.0, -std::sin(down * degree));
  double sum = 0.0;
  for (const Placed& luminaire : placed_) {
    const Vector3d to_light = luminaire.position - eye;
    const double ahead = way * to_light.x();
    if (!(ahead > 0.0) || ahead > farthest_glare) continue;
    if (to_light.z() > ahead * std::tan(screen * degree)) continue;
    const double d = to_light.norm(), cosine = std::min(1.0, to_light.dot(look) / d);
    const double theta = std::acos(cosine) / degree;
    if (theta < nearest_angle || theta > widest) continue;
    const double lux = intensity(luminaire, -to_light) * cosine / (d * d);
    sum += theta > narrow
               ? wide_factor * lux / (theta * theta)
               : (10.0 / (theta * theta * theta) + narrow_factor / (theta * theta)) * lux;
  }
  return sum;
}

double threshold_increment(double veiling, double mean) {
  constexpr double bright = 5.0;  // cd/m^2
  if (!(mean > 0.0)) return veiling > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
  return mean <= bright ? 65.0 * veiling / std::pow(mean, 0.8)
                        : 95.0 * veiling / std::pow(mean, 1.05);
}

}  // namespace lightwell
