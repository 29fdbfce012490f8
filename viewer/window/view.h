#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/solve.h"
#include "scene/scene.h"
#include "viewer/export/appearance.h"

namespace lightwell {

class JoinedSurfaces;

/// What keys and the mouse put over the picture in a window, for pictures drawn off screen. Places
/// are pixels from the left and from the top.
struct Annotations {
  bool keys = false;                         ///< the list of keys (H)
  std::optional<Eigen::Vector2d> pointer{};  ///< reads what is under it, beside it (T)
  std::optional<Eigen::Vector2d> click{};    ///< reads there, in full
  /// Instead of a click, two: the distance between what is there (L).
  std::optional<std::array<Eigen::Vector2d, 2>> measured{};
};

struct ViewOptions {
  std::optional<Camera>
      camera{};  ///< start here; else the first of `cameras`, else a view of the whole scene
  std::vector<Camera> cameras{};   ///< bookmarks on the keys 1..9
  int width = 1024, height = 768;  ///< pixels
  double exposure_ev = 0.0;        ///< stops on top of the automatic exposure
  /// The scene's materials, so that mirrors and glass can be told from black surfaces; a solution
  /// alone knows only diffuse light. May be left empty.
  std::vector<Material> materials{};
  /// For the names of what is pointed at. May be left out; must outlive the window.
  const Scene* scene = nullptr;
  const JoinedSurfaces* names = nullptr;  ///< beside it, where several surfaces share polygons
  bool mesh = false;                      ///< begin with the elements' outlines
  bool illuminance = false;               ///< begin in false colours, of `measure`
  Measure measure = Measure::illuminance;
  std::optional<LuxRange> lux_range{};  ///< of those; else what suits the solution
  /// Begin with the error of interpolation that refinement estimated, in the false colours of
  /// error_colors; of a solution that has it.
  bool interpolation_error = false;
  bool relative_units = false;  ///< what the scale calls lux is in no known unit
  /// Where the solution is saved when a key asks for that; empty: beside the pictures, under a name
  /// that is free.
  std::filesystem::path solution_file{};
  std::filesystem::path screenshot_folder{"."};  ///< where keys leave pictures and solutions
  /// Where the keys for bookmarks and paths keep them (JSON); empty: they last as long as the
  /// window.
  std::filesystem::path bookmark_file{};
  /// Isolux lines begin shown at these levels, lx; empty: at 1, 2 and 5 times the powers of
  /// ten on the scale (the steps of an even one), and hidden.
  std::vector<double> isolux{};
  double eye_height = 0.0;    ///< of a person who walks, m; 0: 1.6, less in a model
  bool walk = false;          ///< begin on foot, with weight and stopped by walls
  bool look_through = false;  ///< begin looking through surfaces that get no light
  bool from_outside = false;  ///< begin with all of the scene in the picture
  Annotations annotations{};  ///< off screen
};

/// Opens a window with the smooth-shaded solution and walk controls (the key H lists them); returns
/// when the user closes it. The automatic exposure is that of the second pass's picture from the
/// same camera. Mirrors are drawn as if they were matte, glass as a thin veil: what they show
/// depends on the eye and is the second pass's work. Throws std::runtime_error, saying what to do,
/// where no display can be opened.
void show_window(const SolvedScene& solved, const ViewOptions& options);

/// Which pictures make a film: one of the two.
struct FilmOptions {
  std::filesystem::path path{};  ///< a recorded path (see camera_path.h); empty: a turntable
  int frames = 0;                ///< pictures, > 0: evenly along the path, or around the scene
};

/// Draws as write_snapshot does, all exposed as the first, into files numbered from 0 by a pattern
/// such as "out-%04d.png". Returns their names. Throws as write_snapshot and read_views do, and
/// InputError for a path that is empty or a pattern without a number.
std::vector<std::filesystem::path> write_film(const SolvedScene& solved, const ViewOptions& options,
                                              const FilmOptions& film, const std::string& pattern,
                                              const Progress& progress = {});

struct LiveViewOptions {
  SolveOptions solve{};     ///< mesh, progressive refinement, refining and gathering
  Provenance provenance{};  ///< of the solution that comes of it
  bool ambient = true;      ///< off screen: with the ambient term of unshot light
  /// Scales that the channels begin with, for a solution that has channels but no light yet; empty:
  /// as the scene has them. What it throws is passed on.
  std::function<std::vector<Spectrum>(const RadiositySolution&)> scales{};
};

/// Opens the window at once and shows light arriving, shot by shot, while a thread solves
/// (progressive refinement, see live_solve.h); then the solution. Keys pause, shoot once, show the
/// ambient term, and stop and save; light of channels is dimmed while it arrives. Throws as
/// show_window does, and InputError where nothing emits light.
void show_live_window(const Scene& scene, const LiveViewOptions& live, const ViewOptions& options);

/// What the window shows after so many shots (or once the tolerance is reached, at less), as
/// write_snapshot draws it: for each of `shots`, which rise, one picture beside the other, all
/// exposed as the last. Returns how many shot in the end. The same picture whatever the computer.
int write_live_snapshot(const Scene& scene, const LiveViewOptions& live, std::span<const int> shots,
                        const ViewOptions& options, const std::filesystem::path& png);

/// Draws the same picture off screen, antialiased, and writes it as a PNG (temporary name, then
/// renamed). Needs an X display all the same. Throws std::runtime_error where none can be opened or
/// the file cannot be written, std::invalid_argument for a size outside [1, 8192].
void write_snapshot(const SolvedScene& solved, const ViewOptions& options,
                    const std::filesystem::path& png);

}  // namespace lightwell
