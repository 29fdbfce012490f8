#include "radiosity/visibility/seams.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>

#include "scene/sampling.h"

namespace lightwell {
namespace {

bool passes_seam(const ElementCaster& caster, const Ray& ray, double width) {
  const double aside = std::numbers::sqrt2 * width;
  Eigen::Vector3d x, y;
  tangent_frame(ray.direction, x, y);
  std::array<Ray, 4> beside{ray, ray, ray, ray};
  beside[0].origin += aside * x;
  beside[1].origin -= aside * x;
  beside[2].origin += aside * y;
  beside[3].origin -= aside * y;
  std::array<std::uint8_t, 4> stopped{};
  caster.occluded(beside, stopped);
  return (stopped[0] != 0 && stopped[1] != 0) || (stopped[2] != 0 && stopped[3] != 0);
}

}  // namespace

void stop_in_seams(const ElementCaster& caster, std::span<const Ray> rays, double width,
                   std::span<std::uint8_t> is_stopped) {
  constexpr std::size_t rays_for_one = 16;
  const auto passing = static_cast<std::size_t>(std::ranges::count(is_stopped, 0));
  if (passing * rays_for_one > rays.size()) return;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (is_stopped[i] == 0 && passes_seam(caster, rays[i], width)) is_stopped[i] = 1;
  }
}

}  // namespace lightwell
