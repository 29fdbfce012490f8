#pragma once

#include <span>
#include <string>
#include <vector>

#include "radiosity/solution/relight.h"
#include "scene/io/cue_file.h"

namespace lightwell {

/// A lighting cue of a solution: scales that its channels fade to. Times are seconds, >= 0.
struct Cue {
  std::string name{};
  std::vector<Spectrum> scales{};  ///< of all channels, as relight() takes them
  double fade_up = 0.0;            ///< of channels whose luminous flux rises or stays
  double fade_down = 0.0;          ///< of channels whose luminous flux falls
  double wait = 0.0;               ///< before the fade
  double hold = 0.0;               ///< after the fade, before the next cue follows
};

/// Cues of a file for the channels of a solution. Channels without a level track, as on the
/// consoles of theatres: they keep the scale of the cue before, and in the first cue the effective
/// one. Throws InputError for a level that fits no channel, for two that fit the same one, and for
/// values that channel_setting() refuses, with file, line and cue.
std::vector<Cue> cues_for(const RadiositySolution& solution, std::span<const WordedCue> worded);

/// A cross-fade between two states of all channels, linear in time and so in light:
///   s_c(t) = s_c(0) + clamp((t - wait) / fade_c, 0, 1) (s_c(end) - s_c(0))
struct CueFade {
  std::vector<Spectrum> from{}, to{};  ///< scales
  std::vector<double> fade{};          ///< duration for each channel, s
  double wait = 0.0;                   ///< s
  double seconds = 0.0;                ///< until the last channel has arrived, `wait` included
};

/// Fade from any scales to a cue of the solution.
CueFade fade_to(const RadiositySolution& solution, std::vector<Spectrum> from, const Cue& cue);

/// Scales at a time (s) after the begin of a fade. From `seconds` on they are exactly those of the
/// cue.
std::vector<Spectrum> scales_at(const CueFade& fade, double second);

/// A state of all channels, and its share of the light of a moment.
struct FadeShare {
  std::vector<Spectrum> scales{};
  double share = 1.0;  ///< (0, 1]
};

/// The scales of scales_at() as a mean of a few states' scales, by shares that add up to 1. Light
/// is linear in scales, so the light of the moment is the same mean of the light of these states.
/// The states are those of the fade whatever the moment, and at most one more than the different
/// durations of its channels: state k has the channels of the k shortest durations at their end,
/// and the others at their start.
std::vector<FadeShare> shares_at(const CueFade& fade, double second);

/// Cues one after another, from the solution's effective scales on: each begins when the one before
/// has faded and held.
class CueSequence {
 public:
  CueSequence(const RadiositySolution& solution, std::span<const Cue> cues);
  /// Duration of all cues, s.
  double seconds() const { return ends_.empty() ? 0.0 : ends_.back(); }
  /// Scales at a time (s) in [0, seconds()]; later those of the last cue.
  std::vector<Spectrum> at(double second) const;
  /// The scales of at() as a mean of a few states, as shares_at() of a fade gives them.
  std::vector<FadeShare> shares_at(double second) const;

 private:
  /// A fade, and the seconds since its begin.
  struct Moment {
    const CueFade& fade;
    double second = 0.0;
  };
  Moment moment(double second) const;

  std::vector<CueFade> fades_{};
  std::vector<double> ends_{};  // of each cue, hold included
};

}  // namespace lightwell
