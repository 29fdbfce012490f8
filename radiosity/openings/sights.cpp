#include "radiosity/openings/sights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// A path leaves the passage behind an opening when a ray is longer than so many widths and ends
// where no other surface is nearer than so many.
constexpr double long_ray = 5.0, passage = 2.0;
constexpr int most_rays = 96;

double number(std::uint64_t path, int i) {
  return random_uniform(random_key(path, static_cast<std::uint64_t>(i)));
}

Vector3d scattered(const Vector3d& normal, std::uint64_t path, int i) {
  Vector3d x, y;
  tangent_frame(normal, x, y);
  const Vector3d d = cosine_direction(static_cast<float>(number(path, i)),
                                      static_cast<float>(number(path, i + 1)));
  return d.x() * x + d.y() * y + d.z() * normal;
}

// A ray along a passage: the logarithm of tan is even over two decades, since of
// cosine-distributed rays one in (length / width)^2 gets to the end of a passage.
Vector3d along_passage(const Vector3d& normal, std::uint64_t path, int i) {
  constexpr double ln_100 = 4.6;
  Vector3d x, y;
  tangent_frame(normal, x, y);
  const double tan = std::exp(ln_100 * number(path, i)),
               turn = 2.0 * std::numbers::pi * number(path, i + 1);
  return (tan * (std::cos(turn) * x + std::sin(turn) * y) + normal).normalized();
}

}  // namespace

void Sights::look(const Opening& opening, std::uint64_t key, int side, int begin, int end,
                  Sight& sight) const {
  for (int i = begin; i < end || (sight.paths == 0 && i < most_paths); ++i) {
    const std::uint64_t path =
        random_key(key, RandomPurpose::portal_paths, static_cast<std::uint64_t>(2 * i + side));
    follow(opening, path, side == 0 ? opening.normal : Vector3d(-opening.normal), sight);
  }
}

// True if another surface is near before the point at which a ray ended, whose normal is
// `normal`.
bool Sights::is_in_passage(const Vector3d& at, const Vector3d& normal, int facet,
                           double width) const {
  const Ray across{
      .origin = at, .direction = normal, .t_max = passage * width, .origin_group = facet};
  std::uint8_t is_near = 0;
  caster_.occluded({&across, 1}, {&is_near, 1});
  return is_near != 0;
}

void Sights::follow(const Opening& opening, std::uint64_t path, const Vector3d& outwards,
                    Sight& sight) const {
  const double width = 2.0 * opening.across.norm(), far = long_ray * width;
  Ray ray{.origin = opening.center + (2.0 * number(path, 0) - 1.0) * opening.along +
                    (2.0 * number(path, 1) - 1.0) * opening.across,
          .direction = scattered(outwards, path, 2)};
  for (int i = 0; i < most_rays; ++i) {
    ElementHit hit;
    caster_.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.facet < 0) {
      ++sight.paths;
      return;
    }
    const Vector3d at = ray.origin + hit.t * ray.direction;
    // A path that came back out of the passage says nothing about this side.
    if ((at - opening.center).dot(outwards) < 0.0) return;
    Vector3d normal = hit.element >= 0 ? element_center(caster_.mesh(), hit.element).normal
                                       : Vector3d(-ray.direction);
    if (normal.dot(ray.direction) > 0.0) normal = -normal;
    const bool goes_on = hit.t > far && is_in_passage(at, normal, hit.facet, width);
    if ((hit.t > far && !goes_on) || hit.element < 0) {
      ++sight.paths;
      sight.region.extend(at);
      sight.distance += (at - opening.center).norm();
      sight.squares += (at - opening.center).squaredNorm();
      const double across = (at - opening.center).dot(opening.across);
      sight.spread = std::max(sight.spread, std::abs(across) / opening.across.squaredNorm());
      if (hit.element >= 0) {
        const auto element = static_cast<std::size_t>(hit.element);
        sight.brightness += brightness_[element];
        if (!reference_.empty()) sight.reference += reference_[element];
      }
      return;
    }
    const int next = 2 * i + 4;
    ray = {.origin = at,
           .direction = goes_on ? along_passage(normal, path, next) : scattered(normal, path, next),
           .origin_group = hit.facet};
  }
}

}  // namespace lightwell
