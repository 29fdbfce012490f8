#include "cli/channels.h"

#include <fmt/format.h>

#include <functional>
#include <stdexcept>

#include "cli/arguments.h"

namespace lightwell {
namespace {

// At the first '=' or the last: patterns may hold one, values never do.
std::pair<std::string, std::string> split(const char* option, const std::string& text,
                                          std::size_t at, const char* wanted) {
  if (at == std::string::npos || at == 0 || at + 1 == text.size()) {
    throw CLI::ValidationError(option, fmt::format("'{}' is not {}", text, wanted));
  }
  return {text.substr(0, at), text.substr(at + 1)};
}

// For a shell, whatever is in it.
std::string quoted(const std::string& word) {
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

void add_each(CLI::App& command, const std::string& name, const std::string& help,
              const std::function<void(const std::string&)>& take, const std::string& type) {
  command
      .add_option_function<std::vector<std::string>>(
          name,
          [take](const std::vector<std::string>& words) {
            for (const std::string& word : words) take(word);
          },
          help)
      ->type_name(type)
      ->type_size(1)
      ->allow_extra_args(false);
}

}  // namespace

void ChannelArguments::add_to(CLI::App& command, const std::string& group) {
  auto* const channels =
      command
          .add_option_function<std::string>(
              "--channels",
              [this](const std::string& text) { per_luminaire = text == "per-luminaire"; },
              "keep light apart, to be dimmed by 'relight': off (default), per-luminaire")
          ->type_name("WHICH")
          ->check(one_of("choice of channels", {"off", "per-luminaire"}))
          ->group(group);
  add_each(
      command, "--channel-by",
      "keep the light of emitters with such names apart, as channel NAME; may be repeated",
      [this](const std::string& text) {
        const auto [channel, glob] =
            split("--channel-by", text, text.find('='),
                  "NAME=PATTERN, such as desk='desk lamp*'; write a channel's name and what its "
                  "emitters or their materials are called");
        patterns.push_back({channel, glob});
      },
      "NAME=PATTERN");
  command.get_option("--channel-by")->excludes(channels)->group(group);
}

EmitterChannels ChannelArguments::channels(const Scene& scene) const {
  if (per_luminaire) return channels_per_luminaire(scene);
  return patterns.empty() ? EmitterChannels{} : channels_by_pattern(scene, patterns);
}

std::string ChannelArguments::text() const {
  std::string text = per_luminaire ? " --channels per-luminaire" : "";
  for (const ChannelPattern& pattern : patterns) {
    text += " --channel-by " + quoted(pattern.channel + "=" + pattern.glob);
  }
  return text;
}

void add_channel_settings(CLI::App& command, ChannelSettings& settings) {
  add_each(
      command, "--channel",
      "factor (0.3, off, on), colour (#ffd9b0) or both (0.3,#ffd9b0) of a channel; may be repeated",
      [&settings](const std::string& text) {
        const auto [name, value] =
            split("--channel", text, text.rfind('='),
                  "NAME=VALUE, such as desk=0.3, ceiling=#ffd9b0 or sun=off");
        for (const auto& [other, setting] : settings) {
          if (other != name) continue;
          throw CLI::ValidationError(
              "--channel", fmt::format("'{}' is set twice; give one value for each channel", name));
        }
        try {
          settings.emplace_back(name, channel_setting(value));
        } catch (const std::invalid_argument& error) {
          throw CLI::ValidationError("--channel", error.what());
        }
      },
      "NAME=VALUE");
}

Json channels_json(const RadiositySolution& solution) {
  Json channels = Json::array();
  for (const LightChannel& channel : solution.channels) {
    const Spectrum flux = emitted_flux(channel);
    Json json = {{"name", channel.name}};
    const double watts = flux.cast<double>().sum();
    if (solution.relative_units) {
      json["power"] = watts;
    } else {
      json["watts"] = watts;
      json["lumens"] = luminous(solution.bands, flux);
    }
    json["scale"] = std::vector<float>(channel.scale.begin(), channel.scale.end());
    json["surfaces"] = channel.surfaces;
    channels.push_back(std::move(json));
  }
  return channels;
}

}  // namespace lightwell
