#pragma once

#include <cstdint>

#include "scene/rays/ray_caster.h"
#include "scene/sampling.h"
#include "scene/surface_point.h"

namespace lightwell {

/// A ray from a point of a surface, with a direction about its normal of density cos / pi by the
/// random numbers of `key`.
inline Ray cosine_ray(const SurfacePoint& from, std::uint64_t key) {
  Eigen::Vector3d along, across;
  tangent_frame(from.normal, along, across);
  const Eigen::Vector3d d =
      cosine_direction(static_cast<float>(random_uniform(random_key(key, 1))),
                       static_cast<float>(random_uniform(random_key(key, 2))));
  return {.origin = from.position,
          .direction = d.x() * along + d.y() * across + d.z() * from.normal,
          .origin_group = from.facet};
}

}  // namespace lightwell
