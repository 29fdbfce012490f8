#include "scene/io/radiance/radiance_sky.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "scene/degree.h"

namespace lightwell {
namespace {

using std::numbers::pi;

constexpr double widest_sun = 10.0;                // degrees, the most that a Sun may have
constexpr int map_width = 1024, map_height = 512;  // 0.35 degrees

// Frame of a map: +y of the map is the zenith, +z the north.
Eigen::Matrix3d to_map(const Eigen::Vector3d& up, const Eigen::Vector3d& north) {
  Eigen::Matrix3d rows;
  rows << up.cross(north).transpose(), up.transpose(), north.transpose();
  return rows;
}

// Unit vector across `up`, as near to `wished` as can be.
Eigen::Vector3d across(const Eigen::Vector3d& up, const Eigen::Vector3d& wished) {
  const Eigen::Vector3d part = wished - wished.dot(up) * up;
  return part.norm() > 1e-3 ? part.normalized() : up.unitOrthogonal();
}

// Direction of a position in a map's picture, in the map's frame (see EnvironmentMap).
Eigen::Vector3d map_direction(double x, double y) {
  const double longitude = 2.0 * pi * (x / map_width - 0.5), polar = pi * y / map_height;
  return {-std::sin(polar) * std::sin(longitude), std::cos(polar),
          std::sin(polar) * std::cos(longitude)};
}

double pixel_solid_angle(int row) {
  return 2.0 * pi / map_width *
         (std::cos(pi * row / map_height) - std::cos(pi * (row + 1) / map_height));
}

}  // namespace

double RadianceSky::Source::cosine_of_edge() const {
  return std::cos(0.5 * degrees * degree);
}

double RadianceSky::Source::solid_angle() const {
  const double sine = std::sin(0.25 * degrees * degree);
  return 4.0 * pi * sine * sine;
}

void RadianceSky::add(const RadiancePrimitive& source, RadianceLight light) {
  source.require_reals(4);
  const Eigen::Vector3d towards(source.reals[0], source.reals[1], source.reals[2]);
  const double angle = source.reals[3];
  if (!(towards.stableNorm() > 0.0)) source.fail("has a direction without length");
  if (!(angle > 0.0)) source.fail(fmt::format("is {} degrees across; give more than 0", angle));
  sources_.push_back({.name = source.name,
                      .direction = towards.stableNormalized(),
                      .degrees = std::min(angle, 360.0),
                      .light = std::move(light)});
}

// The narrow source that sends the most light.
const RadianceSky::Source* RadianceSky::sun() const {
  const auto irradiance = [](const Source& s) {
    return s.light.radiance(s.direction, 1.0).sum() * static_cast<float>(s.solid_angle());
  };
  const Source* best = nullptr;
  for (const Source& s : sources_) {
    if (s.degrees > widest_sun || !(irradiance(s) > 0.0f)) continue;
    if (!best || irradiance(s) > irradiance(*best)) best = &s;
  }
  return best;
}

void RadianceSky::finish(Scene& scene, const Eigen::Vector3d& up, Remarks& remarks) const {
  if (sources_.empty()) return;
  const Source* sun = this->sun();
  std::vector<const Source*> others;
  for (const Source& s : sources_) {
    if (&s != sun) others.push_back(&s);
  }
  std::ranges::stable_sort(others, {}, &Source::degrees);
  scene.sky = dome(others, up);
  if (scene.sky->map) {
    remarks.mention(fmt::format("Skies were tabulated by direction, as a picture of {} x {}",
                                map_width, map_height),
                    others.back()->name);
  }
  if (!sun) return;
  scene.sky->sun = Sun{.direction = sun->direction,
                       .irradiance = sun->light.radiance(sun->direction, 1.0) *
                                     static_cast<float>(sun->solid_angle()),
                       .angle_degrees = sun->degrees};
}

// `sources` from the narrowest to the widest.
Sky RadianceSky::dome(const std::vector<const Source*>& sources, const Eigen::Vector3d& up) const {
  Sky sky{.name = "dark", .up = up, .scale = Spectrum::Zero(3), .ground = Spectrum::Zero(3)};
  Eigen::Vector3d north = Eigen::Vector3d::UnitY();
  bool is_oriented = false;
  for (const Source* s : sources) {
    if (s->light.patterns.empty()) continue;
    const Eigen::Matrix3d& turn = s->light.patterns.front()->turn();
    sky.up = turn.col(2);
    north = turn.col(1);
    is_oriented = true;
    break;
  }
  // Without a pattern, the brighter of the hemispheres is the sky.
  float brightest = 0.0f;
  for (const Source* s : sources) {
    const float radiance = s->light.radiance(s->direction, 1.0).sum();
    if (is_oriented || s->degrees != 180.0 || !(radiance > brightest)) continue;
    brightest = radiance;
    sky.up = s->direction;
  }
  sky.north = across(sky.up, north);
  if (sources.empty()) return sky;

  const Eigen::Matrix3d map = to_map(sky.up, sky.north);
  BandArray radiance = BandArray::Zero(std::int64_t{map_width} * map_height, 3);
  for (int y = 0; y < map_height; ++y) {
    for (int x = 0; x < map_width; ++x) {
      const Eigen::Vector3d ray = map.transpose() * map_direction(x + 0.5, y + 0.5);
      const auto seen = std::ranges::find_if(sources, [&](const Source* s) {
        return s->degrees > widest_sun && s->direction.dot(ray) >= s->cosine_of_edge();
      });
      if (seen == sources.end()) continue;
      radiance.row(std::int64_t{y} * map_width + x) = (*seen)->light.radiance(ray, 1.0).transpose();
    }
  }
  // Discs that the grid may miss: their light goes to the pixels that their middle meets.
  for (const Source* s : sources) {
    if (s->degrees > widest_sun) continue;
    constexpr int grid = 16;
    const Eigen::Quaterniond aim =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), s->direction);
    for (int i = 0; i < grid * grid; ++i) {
      const double height = 1.0 - (1.0 - s->cosine_of_edge()) * (i / grid + 0.5) / grid;
      const double turn = 2.0 * pi * (i % grid + 0.5) / grid,
                   out = std::sqrt(1.0 - height * height);
      const Eigen::Vector3d ray =
          aim * Eigen::Vector3d(out * std::cos(turn), out * std::sin(turn), height);
      const Eigen::Vector3d local = map * ray;
      const double u = 0.5 + std::atan2(-local.x(), local.z()) / (2.0 * pi);
      const double v = std::acos(std::clamp(local.y(), -1.0, 1.0)) / pi;
      const int x = std::min(static_cast<int>(u * map_width), map_width - 1);
      const int y = std::min(static_cast<int>(v * map_height), map_height - 1);
      const double share = s->solid_angle() / (grid * grid * pixel_solid_angle(y));
      radiance.row(std::int64_t{y} * map_width + x) +=
          static_cast<float>(share) * s->light.radiance(ray, 1.0).transpose();
    }
  }
  if (!(radiance > 0.0f).any()) return sky;
  sky.kind = SkyKind::map;
  sky.name = fmt::format("sky of '{}'", sources.back()->name);
  sky.to_map = map;
  sky.scale.setOnes();
  sky.map = std::make_shared<const EnvironmentMap>(map_width, map_height, std::move(radiance));
  return sky;
}

}  // namespace lightwell
