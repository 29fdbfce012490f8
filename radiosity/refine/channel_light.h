#pragma once

#include "radiosity/direct_light/direct_light.h"

namespace lightwell {

/// Light at the base's vertices with the columns of each channel side by side (see DirectLight);
/// W/m^2, vertices x columns.
struct ChannelLight {
  const DirectLight& direct_light;
  const BandArray& radiosity;  ///< as gatherable_radiosity makes it
  const BandArray& caustic;    ///< irradiance, or empty
};

}  // namespace lightwell
