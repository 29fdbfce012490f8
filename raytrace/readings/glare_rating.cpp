#include "raytrace/readings/glare_rating.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "mesh/patches/pictured_emission.h"
#include "mesh/patches/translucency.h"
#include "radiosity/emitters/free_source.h"
#include "raytrace/readings/glare.h"
#include "scene/degree.h"
#include "scene/lamp_faces.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

ElementHit first_on_way(const ElementCaster& caster, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& to, double share) {
  const Ray ray{.origin = from, .direction = to - from, .t_max = share};
  ElementHit hit;
  caster.closest_hits({&ray, 1}, {&hit, 1});
  return hit;
}

void add_emitting_elements(const Scene& scene, const ElementCaster& caster,
                           const Eigen::Vector3d& point, std::vector<ArrivingLight>& arriving) {
  const PatchMesh& mesh = caster.mesh();
  const PicturedEmission emission(mesh);
  constexpr double beyond = 1.01;  // a ray hits a sphere slightly off its elements
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double luminance = luminous(scene.bands, emission.of_element(e)) / std::numbers::pi;
    if (!(luminance > 0.0)) continue;
    const PatchPoint middle = element_center(mesh, e);
    const Eigen::Vector3d way = middle.position - point;
    const double d = way.norm(), cosine = -middle.normal.dot(way) / d;
    if (!(cosine > 0.0)) continue;
    if (first_on_way(caster, point, middle.position, beyond).facet != mesh.facet[e]) continue;
    arriving.push_back({way / d, luminance * mesh.element_area[e] * cosine / (d * d)});
  }
}

}  // namespace

std::vector<ArrivingLight> arriving_light(const Scene& scene, const ElementCaster& caster,
                                          const DirectLight& direct_light,
                                          const Eigen::Vector3d& point) {
  std::vector<ArrivingLight> arriving;
  add_emitting_elements(scene, caster, point, arriving);
  for (const FreeSource& source : direct_light.free_sources()) {
    const auto* light = std::get_if<LampLight>(&source.shape);
    if (!light) continue;
    const Lamp& lamp = light->lamp;
    const Eigen::Vector3d way = lamp.position - point;
    const double d = way.norm();
    const double candela =
        luminous(scene.bands, source.light) * relative_intensity(lamp, -way / d, d);
    if (!(candela > 0.0)) continue;
    if (first_on_way(caster, point, lamp.position, way_before_opening).facet >= 0) continue;
    arriving.push_back({way / d, candela / (d * d)});
  }
  return arriving;
}

double veiling_luminance(const std::vector<ArrivingLight>& arriving, const Eigen::Vector3d& look) {
  constexpr double narrowest = 1.5, widest = 60.0, factor = 10.0;  // degrees; CIE 112
  constexpr double surely_wider = 0.499;                           // below the cosine of `widest`
  double sum = 0.0;
  for (const ArrivingLight& light : arriving) {
    const double cosine = std::clamp(light.direction.dot(look), -1.0, 1.0);
    if (cosine < surely_wider) continue;
    const double theta = std::acos(cosine) / degree;
    if (theta < narrowest || theta > widest) continue;
    sum += factor * light.lux * cosine / (theta * theta);
  }
  return sum;
}

double environment_veil(double lux, double rho) {
  constexpr double factor = 0.035;
  return factor * lux * rho / std::numbers::pi;
}

double glare_rating(double luminaires_veil, double environment_veil) {
  if (!(luminaires_veil > 0.0)) return 0.0;
  return std::max(0.0, 27.0 + 24.0 * std::log10(luminaires_veil / std::pow(environment_veil, 0.9)));
}

double greatest_glare_rating(const std::vector<ArrivingLight>& arriving, double environment_veil,
                             const Eigen::Vector3d& up) {
  constexpr int directions = 4 * 360;
  constexpr double below = 2.0 * degree;
  Eigen::Vector3d a, b;
  tangent_frame(up, a, b);
  double greatest = 0.0;
  for (int i = 0; i < directions; ++i) {
    const double azimuth = 2.0 * std::numbers::pi * i / directions;
    const Eigen::Vector3d level = std::cos(azimuth) * a + std::sin(azimuth) * b;
    const Eigen::Vector3d look = std::cos(below) * level - std::sin(below) * up;
    greatest =
        std::max(greatest, glare_rating(veiling_luminance(arriving, look), environment_veil));
  }
  return greatest;
}

}  // namespace lightwell
