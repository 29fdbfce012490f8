#pragma once

#include <cstdint>

#include "scene/surface_point.h"

namespace lightwell {

/// Choices of a point among many lights. All but `sorted` are unbiased.
enum class ManyLights {
  lightcuts,  ///< clusters of the light tree (Walter et al. 2005)
  sorted,     ///< lights in order of what they may give, until the rest is too little; the rest is
           ///< visible as far as these are (Ward 1991, "Adaptive shadow testing for ray tracing")
  importance,  ///< lights that may give much, and two drawn among all others (Shirley, Wang &
               ///< Zimmerman 1996, "Monte Carlo techniques for direct lighting calculations")
  all,         ///< every light
};

/// Lights that give a sum: all, free sources only, sky and sun only, or all but the sky's dome.
enum class Lights { all, free, distant, all_but_dome };

/// A light that a point asks for. What the light gives counts over `chance`.
struct LightSample {
  int light = 0;  ///< of LightList
  double chance = 1.0;
  int cluster = -1;  ///< of which two are drawn; -1: a light by itself
};

/// A point that lights are chosen for, and how.
struct LightChoice {
  SurfacePoint at{};
  std::uint64_t key = 0;  ///< of the random numbers that draw members of clusters
  Lights lights = Lights::all;
  /// The greatest share of the point's light that a cluster of lights may give.
  double cluster_share = 0.01;
  ManyLights many_lights = ManyLights::lightcuts;
};

/// Lights that points ask for their direct light.
struct CutSizes {
  int lights = 0;     ///< all of them
  double mean = 0.0;  ///< over points in the middle of patches
  int most = 0;
};

/// The fewest emitters, or lamps, of a channel that are clustered. A cut of fewer has few clusters,
/// and saves less than its pilot costs.
constexpr int fewest_clustered = 32;

}  // namespace lightwell
