#include "cli/channels.h"

#include <fmt/format.h>

#include <functional>
#include <stdexcept>

#include "cli/arguments.h"
#include "cli/outputs.h"
#include "cli/quoted.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

// Splits `text` at the '=' at index `at`: the first '=' before a pattern, which may hold another
// '='; the last before a value, which never does. Throws CLI::ValidationError that describes the
// `wanted` form if one side is empty.
std::pair<std::string, std::string> split_words(const char* option, const std::string& text,
                                                std::size_t at, const char* wanted) {
  if (at == std::string::npos || at == 0 || at + 1 == text.size()) {
    throw CLI::ValidationError(option, fmt::format("'{}' is not {}", text, wanted));
  }
  return {text.substr(0, at), text.substr(at + 1)};
}

struct RepeatedOption {
  const char* name;
  const char* help;
  const char* type;
};

// Adds an option whose values are given to `take` one by one.
void add_each(CLI::App& command, const RepeatedOption& option,
              const std::function<void(const std::string&)>& take) {
  command
      .add_option_function<std::vector<std::string>>(
          option.name,
          [take](const std::vector<std::string>& words) {
            for (const std::string& word : words) take(word);
          },
          option.help)
      ->type_name(option.type)
      ->type_size(1)
      ->allow_extra_args(false);
}

}  // namespace

void ChannelArguments::add_to(CLI::App& command, const std::string& group) {
  add_each(
      command,
      {.name = "--channels",
       .help = "light kept apart, for 'relight': kinds (default: sky, sun and electric light), "
               "per-luminaire, off, or NAME=PATTERN of emitters, which may be repeated",
       .type = "WHICH"},
      [this](const std::string& text) { add(text); });
  command.get_option("--channels")->group(group);
}

void ChannelArguments::add(const std::string& text) {
  const char* const option = "--channels";
  if (by_kind || per_luminaire || is_off ||
      (!patterns.empty() && text.find('=') == std::string::npos)) {
    throw CLI::ValidationError(option,
                               "give kinds, per-luminaire, off or patterns, but only one of them");
  }
  is_off = text == "off";
  by_kind = text == "kinds";
  per_luminaire = text == "per-luminaire";
  if (is_off || by_kind || per_luminaire) return;
  const auto [channel, glob] = split_words(
      option, text, text.find('='),
      "kinds, per-luminaire, off or NAME=PATTERN, such as desk='desk lamp*': a channel and a "
      "pattern for the names of its emitters or their materials");
  patterns.push_back({channel, glob});
}

EmitterChannels ChannelArguments::channels(const Scene& scene) const {
  if (fixed) return *fixed;
  if (is_off) return {};
  if (per_luminaire) return channels_per_luminaire(scene);
  return patterns.empty() ? channels_by_kind(scene) : channels_by_pattern(scene, patterns);
}

std::string ChannelArguments::text() const {
  std::string text = is_off ? " --channels off" : per_luminaire ? " --channels per-luminaire" : "";
  for (const ChannelPattern& pattern : patterns) {
    text += " --channels " + quoted(pattern.channel + "=" + pattern.glob);
  }
  return text;
}

void add_channel_settings(CLI::App& command, std::vector<NamedSetting>& settings) {
  add_each(
      command,
      {.name = "--channel",
       .help = "factor (0.3, off, on), colour (#ffd9b0) or both (0.3,#ffd9b0) of a channel, or of "
               "those that a pattern matches; may be repeated",
       .type = "NAME=VALUE"},
      [&settings](const std::string& text) {
        const auto [name, value] =
            split_words("--channel", text, text.rfind('='),
                        "NAME=VALUE, such as desk=0.3, ceiling=#ffd9b0 or sun=off");
        for (const NamedSetting& other : settings) {
          if (other.channels != name) continue;
          throw CLI::ValidationError(
              "--channel", fmt::format("'{}' is set twice; give one value for each channel", name));
        }
        try {
          settings.push_back({.channels = name, .setting = channel_setting(value)});
        } catch (const std::invalid_argument& error) {
          throw CLI::ValidationError("--channel", error.what());
        }
      });
}

std::vector<Spectrum> channel_scales(const RadiositySolution& solution,
                                     std::vector<NamedSetting> settings, const std::string& file) {
  for (NamedSetting& setting : settings) setting.place = file;
  return apply_settings(solution, settings, effective_scales(solution));
}

CLI::Option* add_cues(CLI::App& command, std::string& cues, const std::string& help) {
  return command.add_option("--cues", cues, help)
      ->type_name("FILE")
      ->check(with_extension({".toml"}));
}

std::vector<WordedCue> read_cue_file(const std::string& cues) {
  note_input(cues);
  return read_cues(cues);
}

std::vector<Cue> cues_of(const RadiositySolution& solution, const std::vector<WordedCue>& worded,
                         const std::string& file) {
  try {
    require_channels(solution);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
  return cues_for(solution, worded);
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
      json["watts_radiated"] = watts;
      json["lumens"] = luminous(solution.bands, flux);
    }
    json["scale"] = std::vector<float>(channel.scale.begin(), channel.scale.end());
    json["surfaces"] = channel.surfaces;
    channels.push_back(std::move(json));
  }
  return channels;
}

}  // namespace lightwell
