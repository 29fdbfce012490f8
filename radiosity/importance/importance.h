#pragma once

#include <span>
#include <vector>

#include "radiosity/paths/light_path.h"
#include "radiosity/solution/scene_parts.h"
#include "scene/rays/ray_caster.h"

namespace lightwell {

/// The least importance of a patch, of one in the room that somebody looks into, and the largest of
/// a patch that is not seen.
constexpr float least_importance = 1.0f / 64.0f, least_in_view = 0.25f,
                most_unseen_importance = 0.99f;

/// How much relative errors on each patch matter for what `view_rays` see.
///
/// - 1: a view ray ends there, also by way of mirrors and glass. The patch is seen.
/// - Less, for a patch that sends light to seen patches. From where a view ray ends, a random walk
///   goes on as diffuse reflection would, and each place where the walk arrives is as important as
///   the light from there is for the view (the adjoint of the radiosity equation; Smits, Arvo &
///   Salesin 1992). The importance is 4 times the arrivals per area of the patch over those of seen
///   patches, times the patch's radiosity over that of seen patches.
/// - In a scene of several parts, 1 for all patches of the parts where a hundredth of the view rays
///   end, and of those from which a twentieth of the light seen there comes: rooms between the lamp
///   and what somebody looks at. Their errors reach what is seen through a door, and are not
///   averaged over a room. Patches of other parts have less than 1.
///
/// Importance weighs squared errors, so 1/4 allows twice the error. `paths` is of the caster's
/// scene; `brightness` is the radiosity of each patch, in any sum of bands. All patches have 1 if
/// no ray meets any.
std::vector<float> find_importance(const ElementCaster& caster, const LightPaths& paths,
                                   const SceneParts& parts, std::span<const Ray> view_rays,
                                   std::span<const float> brightness);

}  // namespace lightwell
