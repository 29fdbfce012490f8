#pragma once

#include <string>
#include <vector>

#include "radiosity/solution/relight.h"

namespace lightwell {

/// Dimmers of a solution's light channels, one of which the keys can change.
class LightBoard {
 public:
  /// Begins with the solution's effective scales.
  explicit LightBoard(const RadiositySolution& solution);

  bool has_channels() const { return !names_.empty(); }
  /// True if a channel is chosen, which the keys then change.
  bool is_chosen() const { return chosen_ >= 0; }
  /// Chooses the next channel (1) or the previous one (-1). After the last comes no channel.
  void choose(int step);
  /// Brightens (1) or dims (-1) the chosen channel by a third of a stop, within 1 % to 10000 %.
  /// Below 1 % the channel is off; from off, brightening switches it on at 1 %.
  void dim(int steps);
  /// Switches the chosen channel off, or back on at the factor before.
  void switch_chosen();
  /// Gives the chosen channel its next colour: its own, then warmer and cooler whites, as filters
  /// of channel_scale() in relight.h. Returns a message: the new colour, or the reason for no
  /// change (no channel is chosen, the bands are not RGB, or no light of the channel passes the
  /// filter).
  std::string next_colour();

  /// Follows scales that were set elsewhere, per channel and band.
  void follow(const std::vector<Spectrum>& scales);
  /// Scales of all channels, per band, as relight() takes them.
  std::vector<Spectrum> scales() const;
  /// A line with each channel's name and factor, the chosen channel in brackets. Empty without
  /// channels.
  std::string text() const;

 private:
  struct Dimmer {
    float factor = 1.0f, before = 1.0f;  ///< `before`: the last above 0
    Spectrum colour{};                   ///< scale at factor 1
    int preset = 0;
  };
  std::vector<LightChannel> channels_;  // without irradiance
  Bands bands_;
  std::vector<std::string> names_;
  std::vector<Dimmer> dimmers_;
  int chosen_ = -1;
};

}  // namespace lightwell
