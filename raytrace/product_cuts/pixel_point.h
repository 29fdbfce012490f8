#pragma once

#include <memory>
#include <optional>

#include "mesh/elements/element_caster.h"
#include "radiosity/many_lights/light_choice.h"
#include "scene/bands.h"
#include "scene/coat.h"
#include "scene/relief.h"
#include "scene/surface_point.h"

namespace lightwell {

/// A diffuse place that a sample of a pixel shows, whose direct light is still to be found.
struct PixelPoint {
  SurfacePoint at{};
  Spectrum weight{};   ///< radiance of the sample over irradiance at the point, 1/sr, per band
  double about = 0.0;  ///< radiance of the sample as the solution has it, mean of the bands
  Lights lights = Lights::all;
  /// See LightQuery::base and LightQuery::relief; null, empty: neither.
  std::shared_ptr<const CoatedBase> base{};
  std::optional<ReliefSlope> relief{};
  /// Caster with bodies at their places at the sample's time. Precondition of asking: not null.
  const ElementCaster* caster = nullptr;

  /// Bound of the radiance over the irradiance of a light, 1/sr, mean of the bands: base and relief
  /// weigh light by its direction.
  double strength() const;
};

}  // namespace lightwell
