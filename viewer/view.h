#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "radiosity/solve.h"
#include "scene/scene.h"

namespace lightwell {

struct ViewOptions {
  std::optional<Camera>
      camera{};  ///< start here; else the first of `cameras`, else a view of the whole scene
  std::vector<Camera> cameras{};   ///< bookmarks on the keys 1..9
  int width = 1024, height = 768;  ///< pixels
  double exposure_ev = 0.0;        ///< stops on top of the automatic exposure
};

/// Opens a window with the smooth-shaded solution and walk controls; returns when the user closes
/// it. Throws std::runtime_error, saying what to do, where no display can be opened.
void show_window(const SolvedScene& solved, const ViewOptions& options);

/// Draws the same picture off screen and writes it as a PNG (temporary name, then renamed).
void write_snapshot(const SolvedScene& solved, const ViewOptions& options,
                    const std::filesystem::path& png);

}  // namespace lightwell
