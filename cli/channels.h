#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/report.h"
#include "radiosity/solution/channel_settings.h"
#include "radiosity/solution/cues.h"
#include "radiosity/solution/emitter_channels.h"

namespace lightwell {

/// Light channels that a solution keeps apart.
struct ChannelArguments {
  bool is_off = false;   ///< "--channels off" was given
  bool by_kind = false;  ///< "--channels kinds" was given, which is the default
  bool per_luminaire = false;
  std::vector<ChannelPattern> patterns{};
  std::optional<EmitterChannels> fixed{};  ///< chosen by the command, whatever was given

  void add_to(CLI::App& command, const std::string& group);
  /// Channels of the scene's emitters. Throws InputError if a pattern matches no emitter.
  EmitterChannels channels(const Scene& scene) const;
  /// Command-line options that repeat the channels, after a space; "" without channels.
  std::string text() const;

 private:
  void add(const std::string& text);
};

/// Adds --channel NAME=VALUE, which may be repeated.
void add_channel_settings(CLI::App& command, std::vector<NamedSetting>& settings);

/// Scale per channel and band for relight(); a channel without a setting keeps its scale. Throws
/// InputError that names `file`, the solution's, as apply_settings() does.
std::vector<Spectrum> channel_scales(const RadiositySolution& solution,
                                     std::vector<NamedSetting> settings, const std::string& file);

/// Adds --cues FILE.
CLI::Option* add_cues(CLI::App& command, std::string& cues, const std::string& help);

/// Reads the cues of a file, which outputs must not replace.
std::vector<WordedCue> read_cue_file(const std::string& cues);

/// The cues of a file for the channels of a solution. Throws InputError as cues_for() does, and one
/// that names `file`, the solution's, if that has no channels.
std::vector<Cue> cues_of(const RadiositySolution& solution, const std::vector<WordedCue>& worded,
                         const std::string& file);

/// Channels for JSON, an object each: name, emitted flux times the scale (watts and lumens; power
/// in a scene of relative units), scale per band, names of its surfaces and lamps.
Json channels_json(const RadiositySolution& solution);

}  // namespace lightwell
