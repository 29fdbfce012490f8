#include "radiosity/visibility/seams.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "scene/sampling.h"

namespace lightwell {

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

}  // namespace lightwell
