#pragma once

#include <vector>

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/solution/scene_parts.h"

namespace lightwell {

/// Parts whose light is balanced, and the gathers that find it.
struct PartBalance {
  const SceneParts& parts;
  std::vector<int> rays{};  ///< hemisphere rays at a sample point, by part
  GatherOptions gather{};   ///< all else of the gathers at the sample points
  /// Irradiance from lamps by way of mirrors and glass, W/m^2, vertices x columns, which gathers do
  /// not find; empty: none.
  BandArray caustic{};
};

/// Scales the reflected radiosity of each part of a scene, so that each part reflects the light
/// that arrives from all parts together:
///
///     s_p P_p = P_p0 + sum_q s_q P_pq
///
/// The factors are drawn towards 1 by the variance of the sample points against the error to expect
/// (0.3 %, and up to 30 % more for light from other parts): the light of lamps within a part is
/// balanced by the patches' equations already, and P_p - P_pp, a small difference in a bright part,
/// has the noise of few points.
///
/// P_p is the power that part p reflects by `radiosity`, P_p0 what it would reflect of the light
/// from lamps, caustics included, and of what other surfaces emit, and P_pq of the light that part
/// q reflects, all by gathers at sample points. Each band of each channel has equations of its own:
/// the error of the sun in a part says nothing of a lamp there, whose light would be wrong when the
/// sun is dimmed.
///
/// A gather corrects the light of a part by one reflection. Behind two or three doors most of the
/// light has been reflected often, and the error of coarse patches beside a door would decay too
/// slowly. (Chatelin & Miranker 1982, "Acceleration by aggregation of successive approximation
/// methods".)
///
/// `radiosity` (W/m^2, vertices x columns) is as gatherable_radiosity() makes it. At most 32 parts
/// are scaled, those with the most light. Nothing changes if fewer than two parts have light.
/// Throws Interrupted when progress says stop.
void balance_parts(const LitScene& lit, const PartBalance& balance, BandArray& radiosity);

}  // namespace lightwell
