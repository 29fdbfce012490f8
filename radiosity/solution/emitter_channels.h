#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Partition of emitters into channels that are dimmed and recoloured together. Empty: one solution
/// for all light.
struct EmitterChannels {
  std::vector<std::string> names{};  ///< all different
  /// Index into `names` per surface of the Scene; -1: no emitter.
  std::vector<int> of_surface{};
  std::vector<int> of_source{};  ///< index into `names` per free source (see free_source_count)

  bool empty() const { return names.empty(); }
};

/// Assigns emitters to `channel` whose surface, material or lamp name matches `glob`. In a glob,
/// `*` stands for any text, `?` for one character and `[ab]` for one of several characters, as in a
/// shell.
struct ChannelPattern {
  std::string channel{}, glob{};
};

/// Channel of emitters that match no pattern.
inline constexpr const char* rest_channel = "rest";

/// Most channels. Each channel has a solution of its own in memory and in the file.
inline constexpr int most_channels = 256;

/// Channels by pattern. Every emitter and free source belongs to exactly one channel: the channel
/// of the patterns that match its surface, material or name, otherwise rest_channel. Channels are
/// in the order of their first patterns, `rest` last.
///
/// Throws InputError in these cases:
///   - a pattern matches no emitter;
///   - patterns of two channels match the same emitter;
///   - there are more than most_channels channels.
EmitterChannels channels_by_pattern(const Scene& scene, std::span<const ChannelPattern> patterns);

/// Channel of lamps and emitting surfaces in channels_by_kind().
inline constexpr const char* electric_channel = "electric";

/// One channel for the dome of the sky, "sky", one for the sun, "sun", and one for lamps and
/// emitting surfaces, as far as the scene has them. Empty if the scene has but one of the three.
EmitterChannels channels_by_kind(const Scene& scene);

/// One channel per name of emitting surfaces and free sources, with that name. Throws InputError
/// for more than most_channels channels.
EmitterChannels channels_per_luminaire(const Scene& scene);

}  // namespace lightwell
