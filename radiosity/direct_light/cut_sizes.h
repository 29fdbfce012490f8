#pragma once

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"

namespace lightwell {

/// Lights that points ask for their direct light.
struct CutSizes {
  int lights = 0;     ///< all of them
  double mean = 0.0;  ///< over points in the middle of patches
  int most = 0;
};

/// The lights that the middles of up to 256 patches ask for, which reflect light. 0 of each if no
/// lights are clustered.
CutSizes cut_sizes(const ElementCaster& caster, const DirectLight& direct_light,
                   const ShadowOptions& shadows);

}  // namespace lightwell
