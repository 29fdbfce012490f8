#include "scene/io/radiance/radiance_sky.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "scene/environment_map.h"
#include "scene/rotation_between.h"

namespace lightwell {
namespace {

using std::numbers::pi;

constexpr double widest_sun = 10.0;                // degrees, the most that a Sun may have
constexpr int map_width = 1024, map_height = 512;  // 0.35 degrees

// Unit vector across `up`, as near to `wished` as can be.
Eigen::Vector3d across(const Eigen::Vector3d& up, const Eigen::Vector3d& wished) {
  const Eigen::Vector3d part = wished - wished.dot(up) * up;
  return part.norm() > 1e-3 ? part.normalized() : up.unitOrthogonal();
}

double pixel_solid_angle(int row) {
  return 2.0 * pi / map_width *
         (std::cos(pi * row / map_height) - std::cos(pi * (row + 1) / map_height));
}

// Sets the pixels whose middles a disc covers.
void paint(const Sun& disc, const RadianceLight& light, const Eigen::Matrix3d& to_map,
           BandArray& radiance) {
  const double edge = disc.cosine_of_edge();
  for (int y = 0; y < map_height; ++y) {
    for (int x = 0; x < map_width; ++x) {
      const Eigen::Vector3d ray =
          to_map.transpose() * map_direction((x + 0.5) / map_width, (y + 0.5) / map_height);
      if (disc.direction.dot(ray) < edge) continue;
      radiance.row(std::int64_t{y} * map_width + x) = light.radiance(ray, 1.0).transpose();
    }
  }
}

// Adds the light of a disc that the middles of pixels may miss, from a grid of points of equal
// solid angle.
void add_disc(const Sun& disc, const RadianceLight& light, const Eigen::Matrix3d& to_map,
              BandArray& radiance) {
  constexpr int grid =
      16;  // points in either direction, finer than pixels on discs up to 5 degrees
  const Eigen::Quaterniond aim = rotation_between(Eigen::Vector3d::UnitZ(), disc.direction);
  for (int i = 0; i < grid * grid; ++i) {
    const double height = 1.0 - (1.0 - disc.cosine_of_edge()) * (i / grid + 0.5) / grid;
    const double turn = 2.0 * pi * (i % grid + 0.5) / grid, out = std::sqrt(1.0 - height * height);
    const Eigen::Vector3d ray =
        aim * Eigen::Vector3d(out * std::cos(turn), out * std::sin(turn), height);
    const Eigen::Vector2d at = map_position(to_map * ray);
    const int x = std::min(static_cast<int>(at.x() * map_width), map_width - 1);
    const int y = std::min(static_cast<int>(at.y() * map_height), map_height - 1);
    const double share = disc.solid_angle() / (grid * grid * pixel_solid_angle(y));
    radiance.row(std::int64_t{y} * map_width + x) +=
        static_cast<float>(share) * light.radiance(ray, 1.0).transpose();
  }
}

}  // namespace

void RadianceSky::add(const RadiancePrimitive& source, RadianceLight light) {
  source.require_reals(4);
  const Eigen::Vector3d towards = source.point(0);
  const double angle = source.reals[3];
  if (!(towards.stableNorm() > 0.0)) source.fail("has a direction without length");
  if (!(angle > 0.0)) source.fail(fmt::format("is {} degrees across; give more than 0", angle));
  sources_.push_back(
      {.name = source.name,
       .disc = {.direction = towards.stableNormalized(), .angle_degrees = std::min(angle, 360.0)},
       .light = std::move(light)});
}

// The narrow source that sends the most light.
const RadianceSky::Source* RadianceSky::sun() const {
  const auto irradiance = [](const Source& s) {
    return s.light.radiance(s.disc.direction, 1.0).sum() * static_cast<float>(s.disc.solid_angle());
  };
  const Source* best = nullptr;
  for (const Source& s : sources_) {
    if (s.disc.angle_degrees > widest_sun || !(irradiance(s) > 0.0f)) continue;
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
  std::ranges::stable_sort(others, {}, [](const Source* s) { return s->disc.angle_degrees; });
  Sky dark = dark_sky(scene.bands);
  dark.up = up;
  scene.sky = dome(others, dark);
  if (scene.sky->map) {
    remarks.mention(fmt::format("Skies were tabulated by direction, as a picture of {} x {}",
                                map_width, map_height),
                    others.back()->name);
  }
  if (!sun) return;
  scene.sky->sun = sun->disc;
  scene.sky->sun->irradiance =
      sun->light.radiance(sun->disc.direction, 1.0) * static_cast<float>(sun->disc.solid_angle());
}

// `sources` from the narrowest to the widest.
Sky RadianceSky::dome(const std::vector<const Source*>& sources, const Sky& dark) const {
  Sky sky = dark;
  // The pattern of a sky tells its zenith and north. Without one, the brighter of the hemispheres
  // is above.
  const auto pattern =
      std::ranges::find_if(sources, [](const Source* s) { return !s->light.patterns.empty(); });
  Eigen::Vector3d north = Eigen::Vector3d::UnitY();
  if (pattern != sources.end()) {
    const Eigen::Matrix3d& turn = (*pattern)->light.patterns.front()->turn();
    sky.up = turn.col(2);
    north = turn.col(1);
  } else {
    float brightest = 0.0f;
    for (const Source* s : sources) {
      const float radiance = s->light.color.sum();
      if (s->disc.angle_degrees != 180.0 || !(radiance > brightest)) continue;
      brightest = radiance;
      sky.up = s->disc.direction;
    }
  }
  sky.north = across(sky.up, north);
  const Eigen::Matrix3d map = to_map_around(sky.up, sky.north);
  BandArray radiance = BandArray::Zero(std::int64_t{map_width} * map_height, 3);
  for (auto s = sources.rbegin(); s != sources.rend(); ++s) {  // the narrowest last
    if ((*s)->disc.angle_degrees > widest_sun) paint((*s)->disc, (*s)->light, map, radiance);
  }
  for (const Source* s : sources) {
    if (s->disc.angle_degrees <= widest_sun) add_disc(s->disc, s->light, map, radiance);
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
