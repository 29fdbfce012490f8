#pragma once

#include <cstdint>
#include <span>

#include "radiosity/direct_light/direct_light.h"
#include "raytrace/product_cuts/pixel_point.h"

namespace lightwell {

/// How the direct light of gather points is found together.
struct GatherEffort {
  std::uint64_t key = 0;  ///< of all random numbers
  /// Shadow rays of a light that gives much; ShadowOptions::cluster_share is that of the radiance
  /// of all points, which a pair of clusters may give at most.
  ShadowOptions shadows{};
  double other = 0.0;  ///< radiance of the same samples besides, sum, mean of the bands
};

/// Radiance that gather points send by direct light.
struct GatheredLight {
  Spectrum radiance{};  ///< sum over points, W/(m^2 sr) per band
  double noise = 0.0;   ///< its standard error, mean of the bands, by the two members of each pair
  /// Variance between points of their radiance, mean of the bands, as if all lights were visible
  /// alike; 0 for more than 32 points, which say no more about a pixel and take longer.
  double spread = 0.0;
  int asked = 0;  ///< lights, one for each point that asks
};

/// Radiance sum_i weight_i E(x_i) over gather points of the direct light of all lights, by a cut of
/// the product of points and lights: two members (a point and a light) are drawn of each pair of
/// clusters, so that the mean over keys is the sum over all points and lights. Lights without
/// clusters are asked by every point. Precondition: `points` is not empty.
GatheredLight gathered_light(const DirectLight& direct_light, std::span<const PixelPoint> points,
                             const GatherEffort& effort);

}  // namespace lightwell
