#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/console.h"
#include "radiosity/solution/solution.h"
#include "raytrace/display/light_meter.h"
#include "raytrace/pictures/image.h"
#include "raytrace/pictures/layers.h"
#include "scene/scene.h"
#include "viewer/export/appearance.h"

namespace lightwell {

struct Picture;

/// Options of picture files: layers and pixel format of EXR, tone mapping or false colours of PNG.
struct FilmArguments {
  std::vector<Layer> layers{};  ///< of EXR files
  bool all_layers = false;      ///< every layer that the scene's units allow
  ExrOptions exr{};
  std::string tone_map = "auto";
  std::optional<double> ev100{};
  WhitePoint white{};
  std::optional<Layer> false_colour{};  ///< layer that PNG files show in false colours
  std::optional<LuxRange> range{};      ///< of the false colours; unset: of the picture's values

  enum class HelpOn { shown, hidden };  ///< whether --help shows the options
  /// Adds --layers, --half, --compression, --tone-map, --ev100 and --white-balance.
  void add_to(CLI::App& command, const std::string& group, HelpOn help_on);
  /// Adds --false-colour and --range.
  void add_false_colour_to(CLI::App& command, const std::string& group);

  /// Throws InputError if an option needs
  /// - a PNG or EXR file that is not among `files`,
  /// - photometric units in a scene of relative units, or
  /// - the viewer in a program built without it.
  /// To be called before the work.
  void check(const Scene& scene, const std::vector<std::filesystem::path>& files) const;
  /// Layers to render: `layers`, all layers if `all_layers`, and the one of `false_colour`.
  std::vector<Layer> rendered_layers(const Scene& scene) const;
  ToneMapping tones(const Picture& picture) const;
  /// Command-line options that repeat the tone mapping of PNG files.
  std::string tones_text(double exposure_ev) const;
};

/// A picture with its metadata.
struct Picture {
  const Image& image;
  const RadiositySolution& solution;
  const Camera& camera;
  std::string render_options{};
  double exposure_ev = 0.0;
  std::optional<IncidentLight> incident{};  ///< light on what the camera sees
};

/// Writes the picture in the format of the file's extension, .exr, .hdr or .png.
void write_picture(const std::filesystem::path& file, const Picture& picture,
                   const FilmArguments& film);

}  // namespace lightwell
