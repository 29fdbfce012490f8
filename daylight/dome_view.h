#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/visibility/clear_panes.h"
#include "scene/sky.h"
#include "scene/sky_patches.h"
#include "scene/surface_point.h"

namespace lightwell {

/// The surfaces and panes between a receiver and the sky.
struct Surroundings {
  const ElementCaster& caster;
  const ClearPanes& panes;
  /// Paths by way of mirrors and glass; null: there are none.
  const LightPaths* paths = nullptr;
  int bands = 3;
};

/// A receiver of light: a sensor is one point, a patch is points all over it.
using ReceiverPoints = std::span<const SurfacePoint>;

/// Rays of a receiver towards the dome and the ground.
struct DomeEffort {
  int search = 4;   ///< rays through each cell that look for those through which sky is seen
  int rays = 2048;  ///< rays spread over these cells and those around them
  /// One cell of so many in a row is searched, and one of so many closed ones gets a ray, which
  /// counts for all of them. At least 1.
  int stride = 1;
};

/// View of dome and ground from a receiver.
struct DomeView {
  /// Irradiance straight from each column's sky patch of radiance 1, columns x bands, sr.
  Eigen::ArrayXXf coefficient{};
  /// 1 for cells through which the sky may be seen: those that a ray found open, and those around.
  std::vector<char> open{};
};

/// The view of a receiver, whose points' results are averaged.
///
/// 1. Rays through cells above the receiver's horizon find those through which the sky is seen.
///    These rays serve no other purpose, so that what follows has no bias.
/// 2. Open cells and their neighbours get stratified rays in proportion to their irradiance. Other
///    cells get one ray each, or one in effort.stride does, which finds what the search has missed.
/// 3. A cell's coefficient is the irradiance of the unobstructed cell times the share of the rays'
///    cosines that arrives: exact for an unobstructed receiver.
/// 4. Rays that meet mirrors, coats, solid or frosted glass go on, and count for the patch in whose
///    direction they leave.
///
/// Cells that the horizon of an inclined receiver cuts have the bias of a ratio of few rays.
///
/// `key` decides the directions. Panes dim the light that passes through them.
DomeView view_of_dome(const Surroundings& around, const SkyPatches& sky, ReceiverPoints points,
                      const DomeEffort& effort, std::uint64_t key);

/// The sun as receivers see it: a disc at distance 1.
struct SunDisc {
  /// `towards` is the unit direction to the disc's middle, the angle that across.
  SunDisc(const SkyPatches& sky, const Eigen::Vector3d& towards,
          double angle_degrees = Sun{}.angle_degrees);

  Eigen::Vector3d direction;  ///< unit, to the middle
  Eigen::Vector3d a{}, b{};   ///< unit axes of the disc's plane
  double radius;
  int cell;  ///< of the sky
};

/// Irradiance of a receiver straight from each sun of irradiance 1 across its rays: suns x bands.
/// Points of the receiver send `rays` rays to points of each disc; where the points are more, other
/// ones send them for each sun. Both numbers are powers of two. Suns in cells that the view holds
/// closed get one ray each, so that openings which the search has missed are noise and no bias.
/// Solid glass counts where light leaves it towards the disc, as it leaves slabs; the sun in
/// mirrors, and through glass that bends or scatters its light, is left out.
Eigen::ArrayXXf sunlight(const Surroundings& around, ReceiverPoints points, const DomeView& view,
                         std::span<const SunDisc> suns, int rays, std::uint64_t key);

}  // namespace lightwell
