#include "radiosity/solution/channel_settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/errors.h"
#include "scene/io/matches_glob.h"

namespace lightwell {
namespace {

// Channels that a setting stands for.
std::vector<std::size_t> channels_of(const RadiositySolution& solution,
                                     const NamedSetting& setting) {
  const auto& channels = solution.channels;
  const auto named = std::ranges::find(channels, setting.channels, &LightChannel::name);
  if (named != channels.end()) return {static_cast<std::size_t>(named - channels.begin())};
  std::vector<std::size_t> matching;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (matches_glob(setting.channels, channels[c].name)) matching.push_back(c);
  }
  if (matching.empty()) find_channel(solution, setting.channels);  // throws
  return matching;
}

bool is_name_of(const NamedSetting* setting, const LightChannel& channel) {
  return setting && setting->channels == channel.name;
}

// Calls `work`; an InputError gets the place of the setting.
template <class Work>
auto at_place_of(const NamedSetting& setting, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", setting.place, error.what()));
  }
}

}  // namespace

std::vector<Spectrum> apply_settings(const RadiositySolution& solution,
                                     std::span<const NamedSetting> settings,
                                     std::vector<Spectrum> scales, const NamedSetting* others) {
  std::vector<const NamedSetting*> chosen(solution.channels.size(), nullptr);
  for (const NamedSetting& setting : settings) {
    at_place_of(setting, [&] {
      for (const std::size_t c : channels_of(solution, setting)) {
        const LightChannel& channel = solution.channels[c];
        if (is_name_of(chosen[c], channel)) continue;
        if (chosen[c] && !is_name_of(&setting, channel)) {
          throw InputError(
              fmt::format("channel '{}' would have two settings, by '{}' and by '{}'; change a "
                          "pattern, or give "
                          "the channel a setting by its name",
                          channel.name, chosen[c]->channels, setting.channels));
        }
        chosen[c] = &setting;
      }
    });
  }
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    const NamedSetting* const setting = chosen[c] ? chosen[c] : others;
    if (!setting) continue;
    scales[c] = at_place_of(*setting, [&] {
      return channel_scale(solution.channels[c], solution.bands, setting->setting);
    });
  }
  return scales;
}

}  // namespace lightwell
