#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "scene/bands.h"

namespace lightwell {

/// Energy balance, W per band: rows emitted, absorbed, escaped and unshot.
using BandEnergy = Eigen::Array<double, 4, Eigen::Dynamic>;

/// Energy of free sources (see free_source_count), W per band: rows emitted and missed. Missed
/// light left the scene without meeting anything. BandEnergy includes both.
using FreeEnergy = Eigen::Array<double, 2, Eigen::Dynamic>;

/// Light of emitters that are dimmed and recoloured together. Light is linear in emission, B =
/// sum_c s_c B_c, so each B_c needs to be computed only once.
struct LightChannel {
  std::string name{};
  std::vector<std::string> surfaces{};  ///< names of emitting surfaces, and of lamps
  Spectrum scale{};                     ///< s_c: factor of the channel's emission per band, >= 0

  // Light of this channel alone, with all scales 1; arrays as in RadiositySolution.
  BandArray patch_radiosity{};
  BandArray direct_irradiance{}, indirect_irradiance{}, caustic_irradiance{};
  BandEnergy energy{};
  FreeEnergy free_energy{};  ///< empty without free sources
};

/// Columns of all channels side by side, channel after channel: `rows` x (channels * bands).
BandArray side_by_side(const std::vector<LightChannel>& channels,
                       BandArray LightChannel::*quantity);

/// Splits columns of all channels side by side into the channels. Does nothing if `columns` is
/// empty.
void split_columns(const BandArray& columns, BandArray LightChannel::*quantity,
                   std::vector<LightChannel>& channels);

/// Sum of the channels in columns side by side: `rows` x bands.
BandArray channel_sum(BandArray columns, int bands);

}  // namespace lightwell
