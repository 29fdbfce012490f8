#include "radiosity/emitter_channels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>

#include "scene/errors.h"
#include "scene/io/nearest_name.h"

namespace lightwell {
namespace {

[[noreturn]] void fail(const Scene& scene, const std::string& what) {
  throw InputError(scene.file.empty() ? what : fmt::format("{}: {}", scene.file.string(), what));
}

bool emits(const Scene& scene, const Surface& surface) {
  return scene.materials[surface.material].is_emitter();
}

bool matches(const std::string& glob, const Scene& scene, const Surface& surface) {
  const std::string& material = scene.materials[surface.material].name;
  return fnmatch(glob.c_str(), surface.name.c_str(), 0) == 0 ||
         fnmatch(glob.c_str(), material.c_str(), 0) == 0;
}

int channel_of(EmitterChannels& channels, const std::string& name) {
  const auto at = std::find(channels.names.begin(), channels.names.end(), name);
  if (at == channels.names.end()) {
    channels.names.push_back(name);
    return static_cast<int>(channels.names.size()) - 1;
  }
  return static_cast<int>(at - channels.names.begin());
}

void require_few(const Scene& scene, const EmitterChannels& channels) {
  if (channels.names.size() <= most_channels) return;
  fail(scene, fmt::format("{} channels of light are asked for, and {} are the most there may be; "
                          "put more emitters into one channel by a pattern",
                          channels.names.size(), most_channels));
}

[[noreturn]] void fail_without_match(const Scene& scene, const ChannelPattern& pattern) {
  std::vector<std::string> names;  // of emitters, with those of their materials
  std::string dark;
  for (const Surface& surface : scene.surfaces) {
    if (emits(scene, surface)) {
      for (const std::string& name : {surface.name, scene.materials[surface.material].name}) {
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
      }
    } else if (dark.empty() && matches(pattern.glob, scene, surface)) {
      dark = surface.name;
    }
  }
  if (!dark.empty()) {
    fail(scene, fmt::format("channel '{}': '{}' matches surface '{}', which emits no light, and no "
                            "emitter; the emitters are called {}",
                            pattern.channel, pattern.glob, dark, fmt::join(names, ", ")));
  }
  constexpr std::size_t most_listed = 12;
  const bool is_long = names.size() > most_listed;
  const std::string help = did_you_mean(pattern.glob, names);
  names.resize(std::min(names.size(), most_listed));
  fail(scene, fmt::format("channel '{}': '{}' matches the name of no emitter, and of no emitter's "
                          "material; there are: {}{}.{}",
                          pattern.channel, pattern.glob, fmt::join(names, ", "),
                          is_long ? " and more" : "", help));
}

}  // namespace

EmitterChannels channels_by_pattern(const Scene& scene, std::span<const ChannelPattern> patterns) {
  EmitterChannels channels{.of_surface = std::vector<int>(scene.surfaces.size(), -1)};
  std::vector<const ChannelPattern*> claimed(scene.surfaces.size(), nullptr);
  for (const ChannelPattern& pattern : patterns) {
    const int channel = channel_of(channels, pattern.channel);
    bool any = false;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
      const Surface& surface = scene.surfaces[s];
      if (!emits(scene, surface) || !matches(pattern.glob, scene, surface)) continue;
      any = true;
      int& taken = channels.of_surface[s];
      if (taken >= 0 && taken != channel) {
        fail(scene, fmt::format("emitter '{}' would be in two channels: '{}' puts it into '{}' and "
                                "'{}' into '{}'; change one of the patterns",
                                surface.name, claimed[s]->glob, claimed[s]->channel, pattern.glob,
                                pattern.channel));
      }
      taken = channel;
      claimed[s] = &pattern;
    }
    if (!any) fail_without_match(scene, pattern);
  }
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    if (channels.of_surface[s] < 0 && emits(scene, scene.surfaces[s])) {
      channels.of_surface[s] = channel_of(channels, rest_channel);
    }
  }
  require_few(scene, channels);
  return channels;
}

EmitterChannels channels_per_luminaire(const Scene& scene) {
  EmitterChannels channels{.of_surface = std::vector<int>(scene.surfaces.size(), -1)};
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    if (!emits(scene, scene.surfaces[s])) continue;
    channels.of_surface[s] = channel_of(channels, scene.surfaces[s].name);
  }
  require_few(scene, channels);
  return channels;
}

}  // namespace lightwell
