#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/patch_sampler.h"
#include "scene/sampling.h"

namespace lightwell {

/// Irradiance by plain path tracing with light sampling (Kajiya 1986, "The rendering equation"): no
/// part of a solution, no interpolation, and no closed form. For closed scenes of diffuse surfaces
/// that are equally reflecting in all bands, lit by emitting surfaces that reflect nothing.
class PathTracer {
 public:
  /// Keeps a reference to the caster.
  explicit PathTracer(const ElementCaster& caster) : caster_(caster), mesh_(caster.mesh()) {
    for (int p = 0; p < mesh_.patch_count(); ++p) {
      if (!(mesh_.emission(p, 0) > 0.0f)) continue;
      total_ += mesh_.area[p] * mesh_.emission(p, 0);
      lamps_.push_back({PatchSampler(mesh_, p), p, total_});
    }
  }

  struct Estimate {
    double mean = 0.0, error = 0.0;  ///< W/m^2; standard error
  };

  /// Irradiance at a point of unit normal `normal` on `facet`, by `sets` independent sets of
  /// `direct` points of lamps and `paths` stratified paths. With `widths` above 1, for a gap that
  /// is so many of its widths deep, three rays in ten have the logarithm of the tangent of their
  /// angle with the normal evenly distributed up to ln `widths` (weighed by the balance heuristic),
  /// since cosine-distributed rays that leave a deep gap are too rare.
  Estimate irradiance(const Eigen::Vector3d& at, const Eigen::Vector3d& normal, int facet,
                      int direct, int paths, std::uint64_t key, double widths = 0.0) const {
    constexpr int sets = 8;
    const SobolPoints to_lamps(direct), to_room(paths);
    double sum = 0.0, squares = 0.0;
    for (std::uint64_t set = 0; set < sets; ++set) {
      double E = 0.0;
      for (int i = 0; i < direct; ++i) {
        const auto u = to_lamps.point(i, random_key(key, 1, set));
        E += from_lamp(at, normal, facet, u) / direct;
      }
      for (int i = 0; i < paths; ++i) {
        const auto u = to_room.point(i, random_key(key, 2, set));
        E += path(at, normal, facet, u, random_key(key, 3, set, static_cast<std::uint64_t>(i)),
                  widths) /
             paths;
      }
      sum += E;
      squares += E * E;
    }
    const double mean = sum / sets;
    return {mean, std::sqrt(std::max(squares / sets - mean * mean, 0.0) / (sets - 1))};
  }

 private:
  struct Lamp {
    PatchSampler sampler;
    int patch;
    double power_to;  // running sum
  };

  // Estimate of the irradiance straight from lamps, by one point of one lamp.
  double from_lamp(const Eigen::Vector3d& at, const Eigen::Vector3d& normal, int facet,
                   const Eigen::Array4f& u) const {
    const auto lamp =
        std::upper_bound(lamps_.begin(), lamps_.end() - 1, u[2] * total_,
                         [](double power, const Lamp& l) { return power < l.power_to; });
    const PatchPoint point = lamp->sampler.point(u[0], u[1]);
    const Eigen::Vector3d way = point.position - at;
    const double cosines = normal.dot(way) * -point.normal.dot(way), squared = way.squaredNorm();
    if (normal.dot(way) <= 0.0 || cosines <= 0.0) return 0.0;
    const Ray ray{.origin = at,
                  .direction = way,
                  .t_max = 1.0,
                  .origin_group = facet,
                  .target_group = mesh_.facet[point.element]};
    std::uint8_t blocked = 0;
    caster_.occluded({&ray, 1}, {&blocked, 1});
    return blocked ? 0.0 : total_ * cosines / (squared * squared * 3.14159265358979323846);
  }

  static constexpr double flat = 0.3;  // share of rays of which log tan is even

  // A direction about +z and its weight: the density of cosine-distributed ones over its own.
  static std::pair<Eigen::Vector3d, double> direction(const Eigen::Array4f& u, double widths) {
    Eigen::Vector3d d = cosine_direction(u[0], u[1]);
    if (!(widths > 1.0)) return {d, 1.0};
    const double range = std::log(widths);
    if (double{u[2]} < flat) {
      const double tan = std::exp(range * u[0]), phi = 2.0 * std::numbers::pi * u[1];
      d = Eigen::Vector3d(tan * std::cos(phi), tan * std::sin(phi), 1.0).normalized();
    }
    const double tan = std::hypot(d.x(), d.y()) / d.z();
    const double even = tan > 1.0 && tan < widths ? 1.0 / (range * tan) : 0.0;
    const double by_cosine = 2.0 * tan / std::pow(1.0 + tan * tan, 2);
    return {d, by_cosine / ((1.0 - flat) * by_cosine + flat * even)};
  }

  // Estimate of the reflected light that arrives, by one path; `u` is its first direction.
  double path(Eigen::Vector3d at, Eigen::Vector3d normal, int facet, Eigen::Array4f u,
              std::uint64_t key, double widths) const {
    double share = 1.0, sum = 0.0;
    for (std::uint64_t bounce = 0;; ++bounce) {
      Eigen::Vector3d a, b;
      tangent_frame(normal, a, b);
      const auto [d, weight] = direction(u, widths);
      const Ray ray{
          .origin = at, .direction = d.x() * a + d.y() * b + d.z() * normal, .origin_group = facet};
      ElementHit hit;
      caster_.closest_elements({&ray, 1}, {&hit, 1});
      if (hit.element < 0) return sum;
      const double rho = mesh_.reflectance(mesh_.patch[hit.element], 0);
      if (!(rho > 0.0)) return sum;
      // Paths end by chance from the fourth bounce on, those of great weight later.
      const double survival = bounce < 3 ? 1.0 : std::min(1.0, rho * std::max(1.0, weight));
      if (random_uniform(random_key(key, bounce, 9)) >= survival) return sum;
      share *= weight * rho / survival;
      at = ray.origin + hit.t * ray.direction;
      normal = element_center(mesh_, hit.element).normal;
      facet = hit.facet;
      const auto random = [&](std::uint64_t i) {
        return static_cast<float>(random_uniform(random_key(key, bounce, i)));
      };
      sum += share * from_lamp(at, normal, facet, {random(0), random(1), random(2), 0.0f});
      u = {random(3), random(4), random(5), 0.0f};
    }
  }

  const ElementCaster& caster_;
  const PatchMesh& mesh_;
  std::vector<Lamp> lamps_;
  double total_ = 0.0;  // W
};

}  // namespace lightwell
