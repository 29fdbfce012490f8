#include "radiosity/emitters/free_source.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "radiosity/emitters/clear_places.h"
#include "radiosity/visibility/shadow_rays.h"
#include "scene/sampling.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

// Clearances of the lamps, m: above the rounding of rays, below the gaps at which lamps hang.
std::vector<double> clearances(const Scene& scene) {
  constexpr double of_diagonal = 1e-5;
  const Eigen::AlignedBox3d scenery = scenery_box(scene);
  std::vector<double> clearances;
  for (const Lamp& lamp : scene.lamps) {
    const double across = 2.0 * (lamp.position - scenery.center()).norm();
    clearances.push_back(of_diagonal * std::max(scenery.diagonal().norm(), across));
  }
  return clearances;
}

// The kernel shape(omega) cos / r^2 of a sample point of the lamp.
double point_kernel(const Lamp& lamp, const Eigen::Vector3d& on_lamp, const Eigen::Vector3d& point,
                    const Eigen::Vector3d& normal) {
  const Eigen::Vector3d to = on_lamp - point;
  const double height = to.dot(normal), r2 = to.squaredNorm();
  if (!(height > 0.0 && r2 > 0.0)) return 0.0;
  const double r = std::sqrt(r2);
  return relative_intensity(lamp, -to / r, r) * height / (r2 * r);
}

constexpr std::array<double, 3> gauss_node = {0.1127016653792583, 0.5, 0.8872983346207417};
constexpr std::array<double, 3> gauss_weight = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

// A part of a rectangular opening, and the mean of the kernel over it.
struct Part {
  Eigen::Vector3d middle, a, b;  // half edges
};

double mean_kernel(const Lamp& lamp, const Part& part, int depth, const Eigen::Vector3d& point,
                   const Eigen::Vector3d& normal) {
  // Gauss's rule of 3 x 3 points is good to 1e-4 for parts no longer than half their distance.
  const double longest = 2.0 * std::max(part.a.norm(), part.b.norm());
  const double distance = (part.middle - point).norm() - part.a.norm() - part.b.norm();
  constexpr double small = 0.5;
  constexpr int deepest = 12;  // parts are a 64th of the opening then
  if (longest > small * std::max(distance, 0.0) && depth < deepest) {
    const bool splits_a = part.a.norm() >= part.b.norm();
    const Eigen::Vector3d half = 0.5 * (splits_a ? part.a : part.b);
    double sum = 0.0;
    for (const double side : {-1.0, 1.0}) {
      Part piece = part;
      piece.middle += side * half;
      (splits_a ? piece.a : piece.b) = half;
      sum += 0.5 * mean_kernel(lamp, piece, depth + 1, point, normal);
    }
    return sum;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < gauss_node.size(); ++i) {
    for (std::size_t j = 0; j < gauss_node.size(); ++j) {
      const Eigen::Vector3d on_lamp =
          part.middle + (2.0 * gauss_node[i] - 1.0) * part.a + (2.0 * gauss_node[j] - 1.0) * part.b;
      sum += gauss_weight[i] * gauss_weight[j] * point_kernel(lamp, on_lamp, point, normal);
    }
  }
  return sum;
}

// Gauss's rule of three points on rings of equal area, with equally spaced points around.
double mean_kernel_of_disc(const Lamp& lamp, const Eigen::Vector3d& point,
                           const Eigen::Vector3d& normal) {
  const LampOpening& opening = lamp.opening;
  const double radius = 0.5 * std::max(opening.along_c0, opening.along_c90);
  const double distance = std::max((lamp.position - point).norm() - radius, 0.05 * radius);
  const int rings = std::clamp(static_cast<int>(std::ceil(radius / distance)), 1, 8);
  const int around = 6 + 6 * rings;
  double sum = 0.0;
  for (int ring = 0; ring < rings; ++ring) {
    for (std::size_t i = 0; i < gauss_node.size(); ++i) {
      const double r = 0.5 * std::sqrt((ring + gauss_node[i]) / rings);
      for (int k = 0; k < around; ++k) {
        const double phi = 2.0 * std::numbers::pi * (k + 0.5) / around;
        const Eigen::Vector3d on_lamp = lamp.position +
                                        r * std::cos(phi) * opening.along_c0 * lamp.axes.col(0) +
                                        r * std::sin(phi) * opening.along_c90 * lamp.axes.col(1);
        sum += gauss_weight[i] * point_kernel(lamp, on_lamp, point, normal);
      }
    }
  }
  return sum / (static_cast<double>(rings) * around);
}

double kernel(const LampLight& light, const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  const Lamp& lamp = light.lamp;
  if (lamp.opening.is_point()) {
    // No ray of the lamp begins as near as that.
    if (!((lamp.position - point).norm() > light.clearance)) return 0.0;
    return point_kernel(lamp, lamp.position, point, normal);
  }
  if (lamp.opening.is_round) return mean_kernel_of_disc(lamp, point, normal);
  return mean_kernel(lamp,
                     {.middle = lamp.position,
                      .a = 0.5 * lamp.opening.along_c0 * lamp.axes.col(0),
                      .b = 0.5 * lamp.opening.along_c90 * lamp.axes.col(1)},
                     0, point, normal);
}

// The end t_max of a ray whose direction is the vector to the lamp: one less the clearance.
double clear_share(const LampLight& light, double distance) {
  return std::max(1.0 - light.clearance / distance, 0.0);
}

SourceRay ray_from(const LampLight& light, const LampRay& sent) {
  return {.ray = {.origin = sent.origin + light.clearance * sent.direction,
                  .direction = sent.direction},
          .weight = sent.weight,
          .color = sent.color};
}

double kernel(const VirtualLight& light, const Eigen::Vector3d& point,
              const Eigen::Vector3d& normal) {
  const Eigen::Vector3d to = light.position - point;
  const double height = to.dot(normal), above = -to.dot(light.normal), r2 = to.squaredNorm();
  if (!(height > 0.0 && above > 0.0)) return 0.0;
  return std::numbers::inv_pi * std::min(height * above / (r2 * r2), light.most);
}

// The end t_max of a ray whose direction is the vector to the light, before the light's surface.
constexpr double before_surface = 1.0 - 1e-5;

// A direction towards the disc of the sun, uniform, for (u, v) in [0,1)^2.
Eigen::Vector3d towards_sun(const Sun& sun, double u, double v) {
  const double half = 0.25 * sun.angle_degrees * std::numbers::pi / 180.0;
  const double height = 2.0 * std::pow(std::sin(half), 2);  // 1 - cos, without cancellation
  const double cosine = 1.0 - u * height, phi = 2.0 * std::numbers::pi * v;
  const double sine = std::sqrt(std::max(0.0, u * height * (2.0 - u * height)));
  Eigen::Vector3d a, b;
  tangent_frame(sun.direction, a, b);
  return sine * (std::cos(phi) * a + std::sin(phi) * b) + cosine * sun.direction;
}

// A ray of the sun through a disc about `center`, starting outside the scene.
SourceRay sun_ray(const SunLight& light, const Eigen::Vector3d& on_lamp, double radius,
                  const Eigen::Array4f& u) {
  const Eigen::Vector3d direction = -towards_sun(light.sun, u[0], u[1]);
  Eigen::Vector3d a, b;
  tangent_frame(direction, a, b);
  const double r = radius * std::sqrt(static_cast<double>(u[2]));
  const double phi = 2.0 * std::numbers::pi * static_cast<double>(u[3]);
  const double before = (on_lamp - light.center).norm() + light.radius;
  return {
      .ray = {.origin = on_lamp + r * (std::cos(phi) * a + std::sin(phi) * b) - before * direction,
              .direction = direction},
      .weight = std::numbers::pi * radius * radius};
}

}  // namespace

std::vector<FreeSource> free_sources(const Scene& scene, const BandArray& scale,
                                     const std::vector<int>& channel_of) {
  std::vector<FreeSource> sources;
  if (free_source_count(scene) == 0 || scene.surfaces.empty()) return sources;
  if (scale.size() > 0 && scale.rows() != free_source_count(scene)) {
    throw std::invalid_argument(
        fmt::format("{} factors for {} free sources", scale.rows(), free_source_count(scene)));
  }
  const auto add = [&](const Spectrum& light, auto shape) {
    const auto number = static_cast<int>(sources.size());
    FreeSource source{.number = number, .light = light, .shape = std::move(shape)};
    if (!channel_of.empty()) {
      source.channel = std::max(0, channel_of[static_cast<std::size_t>(number)]);
    }
    if (scale.size() > 0) source.light *= scale.row(number).transpose();
    sources.push_back(std::move(source));
  };
  const Bounds bounds = scene_bounds(scene);
  const std::vector<double> clearance = clearances(scene);
  const std::vector<Eigen::Vector3d> places = clear_places(scene, clearance);
  for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
    LampLight light{.lamp = scene.lamps[i], .clearance = clearance[i]};
    light.lamp.position = places[i];
    add(scene.lamps[i].intensity, std::move(light));
  }
  if (!scene.sky) return sources;
  if (has_dome(*scene.sky)) add(constant_spectrum(scene.bands, 1.0f), DomeLight{});
  if (scene.sky->sun) {
    add(scene.sky->sun->irradiance, SunLight{.sun = *scene.sky->sun,
                                             .center = 0.5 * (bounds.low + bounds.high),
                                             .radius = 0.5 * bounds.diagonal()});
  }
  return sources;
}

bool has_sharp_shadows(const FreeSource& source) {
  if (source.is_distant()) return false;
  if (std::holds_alternative<VirtualLight>(source.shape)) return true;
  return std::get<LampLight>(source.shape).lamp.opening.is_point();
}

double unoccluded_kernel(const FreeSource& source, const Eigen::Vector3d& point,
                         const Eigen::Vector3d& normal) {
  if (const auto* sun = std::get_if<SunLight>(&source.shape)) {
    return std::max(0.0, sun->sun.direction.dot(normal));
  }
  if (source.is_dome()) return 0.0;
  if (const auto* light = std::get_if<VirtualLight>(&source.shape)) {
    return kernel(*light, point, normal);
  }
  return kernel(std::get<LampLight>(source.shape), point, normal);
}

Spectrum light_towards(const FreeSource& source, const Eigen::Vector3d& point) {
  const auto* light = std::get_if<LampLight>(&source.shape);
  if (!light) return source.light;
  const Eigen::Vector3d from = point - light->lamp.position;
  const double r = from.norm();
  if (!(r > 0.0)) return source.light;
  return with_color(source.light, relative_color(light->lamp, from / r, r));
}

ShadowSample shadow_sample(const FreeSource& source, const SurfacePoint& at, double u, double v) {
  const auto& [point, normal, facet] = at;
  if (const auto* sun = std::get_if<SunLight>(&source.shape)) {
    const Eigen::Vector3d direction = towards_sun(sun->sun, u, v);
    return {.ray = {.origin = point, .direction = direction, .origin_group = facet},
            .weight = std::max(0.0, direction.dot(normal))};
  }
  if (source.is_dome()) return {};
  if (const auto* light = std::get_if<VirtualLight>(&source.shape)) {
    return {.ray = {.origin = point,
                    .direction = light->position - point,
                    .t_max = before_surface,
                    .origin_group = facet,
                    .target_group = light->facet},
            .weight = kernel(*light, point, normal)};
  }
  const auto& light = std::get<LampLight>(source.shape);
  const Eigen::Vector3d on_lamp = opening_point(light.lamp, u, v);
  const Eigen::Vector3d to = on_lamp - point;
  const double distance = to.norm();
  if (!(distance > light.clearance)) return {};  // no ray of the lamp begins as near
  return {.ray = {.origin = point,
                  .direction = to,
                  .t_max = clear_share(light, distance),
                  .origin_group = facet},
          .weight = point_kernel(light.lamp, on_lamp, point, normal)};
}

SourceRay source_ray(const FreeSource& source, const Eigen::Array4f& u) {
  if (const auto* sun = std::get_if<SunLight>(&source.shape)) {
    return sun_ray(*sun, sun->center, sun->radius, u);
  }
  if (source.is_dome()) return {};
  if (const auto* light = std::get_if<VirtualLight>(&source.shape)) {
    Eigen::Vector3d a, b;
    tangent_frame(light->normal, a, b);
    const Eigen::Vector3d d = cosine_direction(u[0], u[1]);
    return {.ray = {.origin = light->position,
                    .direction = d.x() * a + d.y() * b + d.z() * light->normal,
                    .origin_group = light->facet},
            .weight = 1.0};
  }
  const auto& light = std::get<LampLight>(source.shape);
  return ray_from(light, draw_ray(light.lamp, u));
}

std::optional<SourceRay> source_ray_towards(const FreeSource& source, const Eigen::Vector3d& center,
                                            double radius, const Eigen::Array4f& u) {
  if (const auto* sun = std::get_if<SunLight>(&source.shape)) {
    return sun_ray(*sun, center, radius, u);
  }
  if (source.is_dome()) return std::nullopt;
  if (std::holds_alternative<VirtualLight>(source.shape)) return source_ray(source, u);
  const auto& light = std::get<LampLight>(source.shape);
  const Eigen::Vector3d on_lamp = ray_origin(light.lamp, u[2], u[3]);
  const Eigen::Vector3d to = center - on_lamp;
  const double distance = to.norm();
  // Close to the sphere, or inside, its cone is no better than all directions.
  constexpr double widest_sine = 0.8;
  SourceRay sent;
  if (!(radius < widest_sine * distance)) {
    sent = ray_from(light, draw_ray(light.lamp, u));
  } else {
    const double sine = radius / distance;
    const double height = sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
    const double cosine = 1.0 - u[0] * height, phi = 2.0 * std::numbers::pi * u[1];
    const double across = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    Eigen::Vector3d a, b;
    const Eigen::Vector3d axis = to / distance;
    tangent_frame(axis, a, b);
    const Eigen::Vector3d direction =
        across * (std::cos(phi) * a + std::sin(phi) * b) + cosine * axis;
    sent =
        ray_from(light, ray_along(light.lamp, on_lamp, direction, 2.0 * std::numbers::pi * height));
  }
  if (!(sent.weight > 0.0)) return std::nullopt;
  return sent;
}

double total_weight(const FreeSource& source) {
  if (const auto* sun = std::get_if<SunLight>(&source.shape)) {
    return std::numbers::pi * sun->radius * sun->radius;
  }
  if (source.is_dome()) return 0.0;
  if (std::holds_alternative<VirtualLight>(source.shape)) return 1.0;
  return relative_flux(std::get<LampLight>(source.shape).lamp);
}

Spectrum mean_light(const FreeSource& source) {
  const auto* light = std::get_if<LampLight>(&source.shape);
  return light ? with_color(source.light, mean_color(light->lamp)) : source.light;
}

SourceSample sample_source(const FreeSource& source, const Eigen::Vector3d& from, double u,
                           double v) {
  if (const auto* sun = std::get_if<SunLight>(&source.shape)) {
    return {.direction = towards_sun(sun->sun, u, v),
            .distance = std::numeric_limits<double>::infinity(),
            .irradiance = 1.0};
  }
  if (source.is_dome()) return {};
  if (const auto* light = std::get_if<VirtualLight>(&source.shape)) {
    const Eigen::Vector3d to = light->position - from;
    const double distance = to.norm();
    if (!(distance > 0.0)) return {};
    const Eigen::Vector3d direction = to / distance;
    return {.direction = direction,
            .distance = before_surface * distance,
            .irradiance = kernel(*light, from, direction)};
  }
  const auto& light = std::get<LampLight>(source.shape);
  const Eigen::Vector3d to = opening_point(light.lamp, u, v) - from;
  const double distance = to.norm();
  if (!(distance > 0.0)) return {};
  const Eigen::Vector3d direction = to / distance;
  return {
      .direction = direction,
      .distance = distance * clear_share(light, distance),
      .irradiance = relative_intensity(light.lamp, -direction, distance) / (distance * distance)};
}

}  // namespace lightwell
