#pragma once

#include <span>
#include <string>
#include <vector>

#include "radiosity/solution/relight.h"

namespace lightwell {

/// A setting of the channels that a name stands for: the channel called so, or without one all
/// channels whose names match it as a pattern (`*`, `?` and `[ab]` as in a shell).
struct NamedSetting {
  std::string channels{};
  ChannelSetting setting{};
  std::string place{};  ///< begins messages: a file, with line and cue where there are any
};

/// Scales of all channels, for relight(). A channel takes the setting with its own name, else the
/// one whose pattern matches, else `others`, else (null) it keeps the one in `scales`. Settings are
/// relative to the scene as solved.
///
/// Throws InputError that begins with the place of a setting
///   - if the setting stands for no channel;
///   - if patterns of two settings match the same channel;
///   - as channel_scale() does.
std::vector<Spectrum> apply_settings(const RadiositySolution& solution,
                                     std::span<const NamedSetting> settings,
                                     std::vector<Spectrum> scales,
                                     const NamedSetting* others = nullptr);

}  // namespace lightwell
