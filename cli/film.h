#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/console.h"
#include "radiosity/solution/solution.h"
#include "raytrace/image.h"
#include "raytrace/layers.h"
#include "scene/scene.h"
#include "viewer/export/appearance.h"

namespace lightwell {

/// What pictures hold and how they show it, as asked for on the command line.
struct FilmArguments {
  std::vector<Layer> layers{};  ///< of EXR files
  bool all_layers = false;      ///< all that the scene's light has
  ExrOptions exr{};
  std::string tone_map = "auto";
  std::optional<double> ev100{};
  std::optional<Layer> false_colour{};  ///< what PNG files show instead of the picture
  std::optional<LuxRange> range{};      ///< of that

  /// Adds --layers, --half, --compression, --tone-map and --ev100.
  enum class HelpOn { shown, hidden };  ///< whether --help shows them
  void add_to(CLI::App& command, const std::string& group, HelpOn help_on);
  /// Adds --false-colour and --range.
  void add_false_colour_to(CLI::App& command, const std::string& group);

  /// Throws InputError that says what does not go with the scene's light or with the files: before
  /// the work, not after it.
  void check(const Scene& scene, const std::vector<std::filesystem::path>& files) const;
  /// What must be rendered for all that.
  std::vector<Layer> rendered_layers(const Scene& scene) const;
  ToneMapping tones(double exposure_ev) const;
  /// The command line that repeats what PNG files show.
  std::string tones_text(double exposure_ev) const;
};

/// A picture and how it came about.
struct Picture {
  const Image& image;
  const RadiositySolution& solution;
  const Camera& camera;
  std::string render_options{};
  double exposure_ev = 0.0;
};

/// Writes it as the file's extension says, .exr or .png.
void write_picture(const std::filesystem::path& file, const Picture& picture,
                   const FilmArguments& film);

}  // namespace lightwell
