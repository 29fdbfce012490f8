#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "radiosity/solve.h"
#include "scene/scene.h"
#include "viewer/appearance.h"

namespace lightwell {

struct ViewOptions {
  std::optional<Camera>
      camera{};  ///< start here; else the first of `cameras`, else a view of the whole scene
  std::vector<Camera> cameras{};   ///< bookmarks on the keys 1..9
  int width = 1024, height = 768;  ///< pixels
  double exposure_ev = 0.0;        ///< stops on top of the automatic exposure
  /// The scene's materials, so that mirrors and glass can be told from black surfaces; a solution
  /// alone knows only diffuse light. May be left empty.
  std::vector<Material> materials{};
  bool mesh = false;                    ///< begin with the elements' outlines
  bool illuminance = false;             ///< begin in false colours
  std::optional<LuxRange> lux_range{};  ///< of those; else what suits the solution
  /// Begin with the error of interpolation that refinement estimated, in the false colours of
  /// error_colors; of a solution that has it.
  bool interpolation_error = false;
  bool relative_units = false;                   ///< what the scale calls lux is in no known unit
  std::filesystem::path screenshot_folder{"."};  ///< where the screenshot key leaves its PNGs
};

/// Opens a window with the smooth-shaded solution and walk controls (the key H lists them); returns
/// when the user closes it. The automatic exposure is that of the second pass's picture from the
/// same camera. Mirrors are drawn as if they were matte, glass as a thin veil: what they show
/// depends on the eye and is the second pass's work. Throws std::runtime_error, saying what to do,
/// where no display can be opened.
void show_window(const SolvedScene& solved, const ViewOptions& options);

/// Draws the same picture off screen, antialiased, and writes it as a PNG (temporary name, then
/// renamed). Needs an X display all the same. Throws std::runtime_error where none can be opened or
/// the file cannot be written, std::invalid_argument for a size outside [1, 8192].
void write_snapshot(const SolvedScene& solved, const ViewOptions& options,
                    const std::filesystem::path& png);

}  // namespace lightwell
