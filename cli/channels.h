#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/report.h"
#include "radiosity/solution/emitter_channels.h"
#include "radiosity/solution/relight.h"

namespace lightwell {

/// Which light a solution keeps apart, as asked for on the command line.
struct ChannelArguments {
  bool is_off = false;  ///< said so
  bool per_luminaire = false;
  std::vector<ChannelPattern> patterns{};

  void add_to(CLI::App& command, const std::string& group);
  /// Throws InputError where the scene has no such emitters.
  EmitterChannels channels(const Scene& scene) const;
  /// The command line that repeats it, with a space before it; nothing by default.
  std::string text() const;

 private:
  void add(const std::string& text);
};

/// Channels by name with their settings: --channel NAME=VALUE, which may be repeated.
using ChannelSettings = std::vector<std::pair<std::string, ChannelSetting>>;
void add_channel_settings(CLI::App& command, ChannelSettings& settings);

/// For relight(): what is not named stays as it is. Throws InputError that names the `file` of the
/// solution where it has no such channel.
std::vector<Spectrum> channel_scales(const RadiositySolution& solution,
                                     const ChannelSettings& settings, const std::string& file);

/// For JSON: of each channel its name, flux with its scale in force (watts and lumens, or power
/// where light is relative), scale per band and surfaces.
Json channels_json(const RadiositySolution& solution);

}  // namespace lightwell
