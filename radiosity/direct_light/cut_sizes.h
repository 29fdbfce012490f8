#pragma once

#include "radiosity/many_lights/light_choice.h"

namespace lightwell {

class DirectLight;
class ElementCaster;
struct ShadowOptions;

/// The lights that the middles of up to 256 patches ask for, which reflect light. 0 of each if no
/// lights are clustered.
CutSizes cut_sizes(const ElementCaster& caster, const DirectLight& direct_light,
                   const ShadowOptions& shadows);

}  // namespace lightwell
