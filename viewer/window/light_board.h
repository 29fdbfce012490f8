#pragma once

#include <string>
#include <vector>

#include "radiosity/solution/relight.h"

namespace lightwell {

/// The dimmers of a solution's light channels, and which of them the keys move.
class LightBoard {
 public:
  /// Begins with the scales in force.
  explicit LightBoard(const RadiositySolution& solution);

  bool has_channels() const { return !names_.empty(); }
  /// A channel is chosen; else keys are for something else.
  bool is_chosen() const { return chosen_ >= 0; }
  /// The next channel (1) or the one before (-1); behind the last comes none.
  void choose(int step);
  /// A third of a stop brighter (1) or darker (-1); from off it comes on at 1 %.
  void dim(int steps);
  /// Off, or as it was before.
  void switch_chosen();
  /// Its own colour, then warmer and cooler whites: a filter, by relight.h's channel_scale. Says
  /// why where bands are no RGB.
  std::string next_colour();

  /// For relight().
  std::vector<Spectrum> scales() const;
  /// Channels and factors in a line; the chosen one in brackets. Empty without channels.
  std::string text() const;

 private:
  struct Dimmer {
    float factor = 1.0f, before = 1.0f;  ///< `before` it was switched off
    Spectrum colour{};                   ///< scale at factor 1
    int preset = 0;
  };
  std::vector<LightChannel> channels_;  // without their light
  Bands bands_;
  std::vector<std::string> names_;
  std::vector<Dimmer> dimmers_;
  int chosen_ = -1;
};

}  // namespace lightwell
