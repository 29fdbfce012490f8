#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/report.h"
#include "radiosity/solution/emitter_channels.h"
#include "radiosity/solution/relight.h"

namespace lightwell {

/// Light channels that a solution keeps apart.
struct ChannelArguments {
  bool is_off = false;   ///< "--channels off" was given
  bool by_kind = false;  ///< "--channels kinds" was given, which is the default
  bool per_luminaire = false;
  std::vector<ChannelPattern> patterns{};

  void add_to(CLI::App& command, const std::string& group);
  /// Channels of the scene's emitters. Throws InputError if a pattern matches no emitter.
  EmitterChannels channels(const Scene& scene) const;
  /// Command-line options that repeat the channels, after a space; "" without channels.
  std::string text() const;

 private:
  void add(const std::string& text);
};

/// Names of channels with their settings.
using ChannelSettings = std::vector<std::pair<std::string, ChannelSetting>>;

/// Adds --channel NAME=VALUE, which may be repeated.
void add_channel_settings(CLI::App& command, ChannelSettings& settings);

/// Scale per channel and band for relight(); a channel without a setting keeps its scale. Throws
/// InputError that names `file`, the solution's, if a setting names an unknown channel.
std::vector<Spectrum> channel_scales(const RadiositySolution& solution,
                                     const ChannelSettings& settings, const std::string& file);

/// Channels for JSON, an object each: name, emitted flux times the scale (watts and lumens; power
/// in a scene of relative units), scale per band, names of its surfaces and lamps.
Json channels_json(const RadiositySolution& solution);

}  // namespace lightwell
