#include "scene/sky_patch_means.h"

#include <algorithm>
#include <cmath>

#include "scene/degree.h"

namespace lightwell {
namespace {

// Points across a patch.
int steps_across(const SkyPatches& patches) {
  constexpr double widest = 5.0 * degree;
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(patches.solid_angle(0)) / widest)));
}

}  // namespace

SkyPatchMeans::SkyPatchMeans(const SkyPatches& patches)
    : on_ground_(patches.irradiances(patches.up()).head(patches.dome_count())) {
  const int steps = steps_across(patches);
  points_ = steps * steps;
  towards_.resize(3, Eigen::Index{points_} * patches.dome_count());
  Eigen::Index at = 0;
  for (int p = 0; p < patches.dome_count(); ++p) {
    if (steps == 1) {
      towards_.col(at++) = patches.middle(p);
      continue;
    }
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; j < steps; ++j) {
        towards_.col(at++) = patches.direction(p, (i + 0.5) / steps, (j + 0.5) / steps);
      }
    }
  }
}

Eigen::ArrayXd SkyPatchMeans::of(const Sky& sky) const {
  Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(on_ground_.size());
  Eigen::Index at = 0;
  for (double& patch : mean) {
    for (int i = 0; i < points_; ++i) patch += double{sky_radiance(sky, towards_.col(at++))[0]};
  }
  return mean / points_;
}

}  // namespace lightwell
