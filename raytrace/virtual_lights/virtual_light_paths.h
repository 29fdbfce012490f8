#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/paths/light_path.h"
#include "raytrace/caustics/caustic_map.h"
#include "scene/progress.h"

namespace lightwell {

/// Finds about `count` virtual lights (Keller 1997), which together send on all light that surfaces
/// of the scene reflect, by paths that begin where light is reflected first:
///
/// - Points are drawn uniformly over all surfaces that reflect, transmit or emit light. The flux of
///   a point is its share of the area times rho E_direct, with the light of `caustics` (null: none)
///   and the emission that DirectLight leaves to rays.
/// - Paths start at points that are drawn again in proportion to the square root of that flux.
/// - A path goes on in a cosine-distributed direction, through mirrors and clear surfaces, to the
///   next diffuse surface, and ends there with probability 1 - rho (Russian roulette).
///
/// All points on a path are virtual lights. The mean over random numbers is the flux that the
/// surfaces send on. `most` is VirtualLight::most; `key`: of the random numbers. The same lights
/// for any number of threads. Throws Interrupted when progress says stop.
std::vector<FreeSource> find_virtual_lights(const LitScene& lit, const LightPaths& paths,
                                            const CausticMap* caustics, int count, double most,
                                            std::uint64_t key, const Progress& progress = {});

/// The area of surfaces that a virtual light may lie on, both sides, m^2.
double area_of_virtual_lights(const LitScene& lit);

}  // namespace lightwell
