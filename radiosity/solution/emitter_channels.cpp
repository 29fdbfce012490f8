#include "radiosity/solution/emitter_channels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/errors.h"
#include "scene/io/matches_glob.h"
#include "scene/io/nearest_name.h"

namespace lightwell {
namespace {

[[noreturn]] void fail(const Scene& scene, const std::string& what) {
  throw InputError(scene.file.empty() ? what : fmt::format("{}: {}", scene.file.string(), what));
}

// A surface or, after all surfaces, a free source: a possible member of a channel.
struct Light {
  std::string name{};
  std::string material{};  // empty: a free source
  bool shines = false;
};

std::vector<Light> lights_of(const Scene& scene) {
  std::vector<Light> lights;
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    lights.push_back({surface.name, material.name, material.is_emitter()});
  }
  for (int i = 0; i < free_source_count(scene); ++i) {
    lights.push_back({.name = free_source_name(scene, i), .shines = true});
  }
  return lights;
}

bool matches(const std::string& glob, const Light& light) {
  return matches_glob(glob, light.name) ||
         (!light.material.empty() && matches_glob(glob, light.material));
}

int channel_of(std::vector<std::string>& names, const std::string& name) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) {
    names.push_back(name);
    return static_cast<int>(names.size()) - 1;
  }
  return static_cast<int>(at - names.begin());
}

void require_few(const Scene& scene, const EmitterChannels& channels) {
  if (channels.names.size() <= most_channels) return;
  fail(scene, fmt::format("{} channels of light are requested, and at most {} are possible; "
                          "put more emitters into one channel by a pattern",
                          channels.names.size(), most_channels));
}

[[noreturn]] void fail_without_match(const Scene& scene, const ChannelPattern& pattern) {
  std::vector<std::string> names;  // of emitters and their materials
  std::string dark;
  for (const Light& light : lights_of(scene)) {
    if (light.shines) {
      for (const std::string& name : {light.name, light.material}) {
        if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) continue;
        names.push_back(name);
      }
    } else if (dark.empty() && matches(pattern.glob, light)) {
      dark = light.name;
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

// `of_light`: channel per light in the order of lights_of(), surfaces first.
EmitterChannels as_channels(const Scene& scene, std::vector<std::string> names,
                            const std::vector<int>& of_light) {
  const auto surfaces = static_cast<std::ptrdiff_t>(scene.surfaces.size());
  EmitterChannels channels{.names = std::move(names),
                           .of_surface = {of_light.begin(), of_light.begin() + surfaces},
                           .of_source = {of_light.begin() + surfaces, of_light.end()}};
  require_few(scene, channels);
  return channels;
}

}  // namespace

EmitterChannels channels_by_pattern(const Scene& scene, std::span<const ChannelPattern> patterns) {
  const std::vector<Light> lights = lights_of(scene);
  std::vector<std::string> names;
  std::vector<int> of_light(lights.size(), -1);
  std::vector<const ChannelPattern*> claimed(lights.size(), nullptr);
  for (const ChannelPattern& pattern : patterns) {
    const int channel = channel_of(names, pattern.channel);
    bool any = false;
    for (std::size_t i = 0; i < lights.size(); ++i) {
      if (!lights[i].shines || !matches(pattern.glob, lights[i])) continue;
      any = true;
      int& taken = of_light[i];
      if (taken >= 0 && taken != channel) {
        fail(scene, fmt::format("emitter '{}' would be in two channels: '{}' puts it into '{}' and "
                                "'{}' into '{}'; change one of the patterns",
                                lights[i].name, claimed[i]->glob, claimed[i]->channel, pattern.glob,
                                pattern.channel));
      }
      taken = channel;
      claimed[i] = &pattern;
    }
    if (!any) fail_without_match(scene, pattern);
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (of_light[i] < 0 && lights[i].shines) of_light[i] = channel_of(names, rest_channel);
  }
  return as_channels(scene, std::move(names), of_light);
}

EmitterChannels channels_by_kind(const Scene& scene) {
  const std::vector<Light> lights = lights_of(scene);
  const std::size_t outside = scene.surfaces.size() + scene.lamps.size();
  std::vector<std::string> names;
  std::vector<int> of_light(lights.size(), -1);
  // Lights are taken from the last on: sky and sun follow the lamps.
  for (std::size_t i = lights.size(); i-- > 0;) {
    if (!lights[i].shines) continue;
    of_light[i] = channel_of(names, i < outside ? electric_channel : lights[i].name);
  }
  if (names.size() < 2) return {};
  return as_channels(scene, std::move(names), of_light);
}

EmitterChannels channels_per_luminaire(const Scene& scene) {
  const std::vector<Light> lights = lights_of(scene);
  std::vector<std::string> names;
  std::vector<int> of_light(lights.size(), -1);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].shines) of_light[i] = channel_of(names, lights[i].name);
  }
  return as_channels(scene, std::move(names), of_light);
}

}  // namespace lightwell
