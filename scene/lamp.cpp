#include "scene/lamp.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/limits.h"
#include "scene/projected_picture.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

double cone_value(const SpotCone& cone, double cosine) {
  const double inner = std::cos(cone.inner), outer = std::cos(cone.outer);
  if (cosine >= inner) return 1.0;
  if (!(cosine > outer)) return 0.0;
  if (cone.edge == SpotCone::Edge::straight) {
    return (cone.outer - std::acos(std::clamp(cosine, -1.0, 1.0))) / (cone.outer - cone.inner);
  }
  const double share = (cosine - outer) / (inner - outer);
  return share * share;
}

double cone_flux(const SpotCone& cone) {
  const double inner = std::cos(cone.inner), outer = std::cos(cone.outer);
  if (!(cone.outer > cone.inner)) return two_pi * (1.0 - inner);
  if (cone.edge == SpotCone::Edge::smooth) {
    return two_pi * ((1.0 - inner) + (inner - outer) / 3.0);
  }
  const double falling =
      inner - (std::sin(cone.outer) - std::sin(cone.inner)) / (cone.outer - cone.inner);
  return two_pi * ((1.0 - inner) + falling);
}

// Uniform direction in the spherical cap about -z whose cosines reach from 1 down to 1 - height.
Eigen::Vector3d cap_direction(double height, double u, double v) {
  const double cosine = 1.0 - u * height;
  const double sine = std::sqrt(std::max(0.0, u * height * (2.0 - u * height)));
  return {sine * std::cos(two_pi * v), sine * std::sin(two_pi * v), -cosine};
}

// The bands of r, g, b over the mean of the three.
Spectrum color_of(const ProjectedPicture& picture, const Eigen::Array3d& rgb) {
  const double mean = rgb.mean();
  return picture.in_bands(mean > 0.0 ? Eigen::Array3d(rgb / mean) : rgb);
}

}  // namespace

Eigen::Matrix3d lamp_axes(const Eigen::Vector3d& aim, const Eigen::Vector3d& c0) {
  const Eigen::Vector3d up = -aim.normalized();
  const auto across = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return v - v.dot(up) * up;
  };
  Eigen::Vector3d x = across(c0.norm() > 0.0 ? Eigen::Vector3d(c0.normalized()) : c0);
  if (!(x.norm() > parallel_sine)) x = across(Eigen::Vector3d::UnitX());
  if (!(x.norm() > parallel_sine)) x = across(Eigen::Vector3d::UnitZ());
  x.normalize();
  Eigen::Matrix3d axes;
  axes << x, up.cross(x), up;
  return axes;
}

double relative_intensity(const Lamp& lamp, const Eigen::Vector3d& direction, double distance) {
  if (const auto* picture = std::get_if<SharedPicture>(&lamp.shape)) {
    return (*picture)->towards(lamp.axes.transpose() * direction, distance).mean();
  }
  if (const auto* web = std::get_if<SharedWeb>(&lamp.shape)) {
    return (*web)->at(lamp.axes.transpose() * direction);
  }
  if (const auto* cone = std::get_if<SpotCone>(&lamp.shape)) {
    return cone_value(*cone, direction.dot(lamp.aim()));
  }
  return 1.0;
}

Spectrum relative_color(const Lamp& lamp, const Eigen::Vector3d& direction, double distance) {
  const auto* picture = std::get_if<SharedPicture>(&lamp.shape);
  if (!picture) return {};
  return color_of(**picture, (*picture)->towards(lamp.axes.transpose() * direction, distance));
}

Spectrum mean_color(const Lamp& lamp) {
  const auto* picture = std::get_if<SharedPicture>(&lamp.shape);
  return picture ? color_of(**picture, (*picture)->flux()) : Spectrum();
}

double relative_flux(const Lamp& lamp) {
  if (const auto* picture = std::get_if<SharedPicture>(&lamp.shape)) {
    return (*picture)->flux().mean();
  }
  if (const auto* web = std::get_if<SharedWeb>(&lamp.shape)) return (*web)->integral();
  if (const auto* cone = std::get_if<SpotCone>(&lamp.shape)) return cone_flux(*cone);
  return 2.0 * two_pi;
}

Spectrum lamp_flux(const Lamp& lamp) {
  return with_color(lamp.intensity, mean_color(lamp)) * static_cast<float>(relative_flux(lamp));
}

LampRay draw_ray(const Lamp& lamp, const Eigen::Array4f& u) {
  LampRay ray{.origin = ray_origin(lamp, u[2], u[3])};
  if (const auto* web = std::get_if<SharedWeb>(&lamp.shape)) {
    const DrawnDirection drawn = (*web)->draw(u[0], u[1]);
    ray.direction = lamp.axes * drawn.direction;
    ray.weight = drawn.weight;
    return ray;
  }
  if (const auto* picture = std::get_if<SharedPicture>(&lamp.shape)) {
    const Eigen::Vector3d lens_point = lamp.axes.transpose() * (ray.origin - lamp.position);
    const ProjectedPicture::Drawn drawn = (*picture)->draw(lens_point, u[0], u[1]);
    ray.direction = lamp.axes * drawn.direction;
    ray.weight = drawn.weight.mean();
    ray.color = color_of(**picture, drawn.weight);
    return ray;
  }
  const auto* cone = std::get_if<SpotCone>(&lamp.shape);
  const double height = cone ? 1.0 - std::cos(cone->outer) : 2.0;
  ray.direction = lamp.axes * cap_direction(height, u[0], u[1]);
  ray.weight = two_pi * height * relative_intensity(lamp, ray.direction);
  return ray;
}

Eigen::Vector3d ray_origin(const Lamp& lamp, double u, double v) {
  if (const auto* picture = std::get_if<SharedPicture>(&lamp.shape)) {
    return lamp.position + lamp.axes * (*picture)->lens_point(u, v);
  }
  return opening_point(lamp, u, v);
}

LampRay ray_along(const Lamp& lamp, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                  double solid_angle) {
  if (const auto* picture = std::get_if<SharedPicture>(&lamp.shape)) {
    const Eigen::Array3d rgb = (*picture)->along(lamp.axes.transpose() * (origin - lamp.position),
                                                 lamp.axes.transpose() * direction);
    return {.origin = origin,
            .direction = direction,
            .weight = solid_angle * rgb.mean(),
            .color = color_of(**picture, rgb)};
  }
  return {.origin = origin,
          .direction = direction,
          .weight = solid_angle * relative_intensity(lamp, direction)};
}

Eigen::Vector3d opening_point(const Lamp& lamp, double u, double v) {
  if (lamp.opening.is_point()) return lamp.position;
  double x = u - 0.5, y = v - 0.5;
  if (lamp.opening.is_round) {
    // The concentric map (Shirley & Chiu 1997) keeps neighbouring samples neighbours.
    const Eigen::Vector3d disk = cosine_direction(static_cast<float>(u), static_cast<float>(v));
    x = 0.5 * disk.x();
    y = 0.5 * disk.y();
  }
  return lamp.position + x * lamp.opening.along_c0 * lamp.axes.col(0) +
         y * lamp.opening.along_c90 * lamp.axes.col(1);
}

}  // namespace lightwell
