#include "radiosity/emitters/emitter_point.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiosity/emitters/emission_tree.h"
#include "scene/sampling.h"

namespace lightwell {

Eigen::Vector3d emitter_point(const Emitter& emitter, double u, double v) {
  const auto at = std::upper_bound(emitter.area_cdf.begin(), emitter.area_cdf.end() - 1, u);
  const auto i = static_cast<std::size_t>(at - emitter.area_cdf.begin());
  const double low = i == 0 ? 0.0 : emitter.area_cdf[i - 1];
  const double within = std::clamp((u - low) / (emitter.area_cdf[i] - low), 0.0, 1.0);
  const Eigen::Vector3d w = triangle_point(static_cast<float>(within), static_cast<float>(v));
  const auto& t = emitter.triangles[i];
  return w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
}

double approximate_kernel(const Emitter& emitter, const Eigen::Vector3d& from) {
  const Eigen::Vector3d to = from - emitter.center;
  const double distance2 = to.squaredNorm();
  if (emitter.is_sphere) return 1.0 / std::max(distance2, emitter.radius * emitter.radius);
  const double height = to.dot(emitter.normal);
  if (!emitter.emits_both_sides && !(height > 0.0)) return 0.0;
  const double size2 = emitter.area / std::numbers::pi;
  return (std::abs(height) + 0.1 * std::sqrt(size2)) /
         (std::sqrt(distance2 + size2) * (distance2 + size2));
}

Spectrum exitance_at(const Emitter& emitter, const Eigen::Vector3d& point) {
  if (!emitter.picture) return emitter.exitance;
  return emitter.picture_scale.head<3>() * emitter.picture->at(point);
}

}  // namespace lightwell
