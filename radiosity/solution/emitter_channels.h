#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Which emitters are dimmed and recoloured together. Empty: light is not kept apart.
struct EmitterChannels {
  std::vector<std::string> names{};  ///< all different
  std::vector<int> of_surface{};     ///< of each Scene surface, into names; -1: it does not emit
  std::vector<int> of_source{};      ///< of each free source (see free_source_count), into names

  bool empty() const { return names.empty(); }
};

/// Emitters whose surface or material, and lamps which have a name like `glob` go to `channel`. In
/// a glob, `*` stands for any text, `?` for one character and `[ab]` for one of several, as in a
/// shell.
struct ChannelPattern {
  std::string channel{}, glob{};
};

/// What no pattern names goes here.
inline constexpr const char* rest_channel = "rest";

/// Each channel has a solution of its own in memory and in the file.
inline constexpr int most_channels = 256;

/// Every emitter and free source belongs to exactly one channel: that of the patterns its surface
/// or material or its own name matches, or rest_channel. Channels are in the order of their first
/// patterns, `rest` last.
///
/// Throws InputError if a pattern matches no emitter or two channels claim one, and if there are
/// more than most_channels.
EmitterChannels channels_by_pattern(const Scene& scene, std::span<const ChannelPattern> patterns);

/// A channel for each name among the surfaces that emit and the free sources, called after it.
/// Throws InputError if those are more than most_channels.
EmitterChannels channels_per_luminaire(const Scene& scene);

}  // namespace lightwell
