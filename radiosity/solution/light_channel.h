#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "scene/bands.h"

namespace lightwell {

/// Where light went, W of each band: rows emitted, absorbed, escaped and unshot.
using BandEnergy = Eigen::Array<double, 4, Eigen::Dynamic>;

/// Of free sources (see free_source_count) alone, W of each band: rows emitted, and missed, which
/// is what of it left the scene without having met anything. Both are in BandEnergy as well.
using FreeEnergy = Eigen::Array<double, 2, Eigen::Dynamic>;

/// Light of emitters that are dimmed and recoloured together. Light is linear in emission:
/// B = sum_c s_c B_c, so these need to be found only once.
struct LightChannel {
  std::string name{};
  std::vector<std::string> surfaces{};  ///< names of those that emit, and of lamps
  Spectrum scale{};                     ///< s_c in force: factor of its emission per band, >= 0

  // As in RadiositySolution, with every scale at 1.
  BandArray patch_radiosity{};
  BandArray direct_irradiance{}, indirect_irradiance{}, caustic_irradiance{};
  BandEnergy energy{};
  FreeEnergy free_energy{};  ///< empty where there are no free sources
};

/// Columns of all channels side by side, channel after channel: `rows` x (channels * bands).
BandArray side_by_side(const std::vector<LightChannel>& channels,
                       BandArray LightChannel::*quantity);

/// The opposite; moves nothing if `columns` is empty.
void split_columns(const BandArray& columns, BandArray LightChannel::*quantity,
                   std::vector<LightChannel>& channels);

/// Columns of all channels added: `rows` x bands.
BandArray channel_sum(BandArray columns, int bands);

}  // namespace lightwell
