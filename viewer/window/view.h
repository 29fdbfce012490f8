#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/solution/cues.h"
#include "radiosity/solve.h"
#include "raytrace/display/light_meter.h"
#include "scene/scene.h"
#include "viewer/export/false_color.h"

namespace lightwell {

class JoinedSurfaces;

/// Annotations of pictures drawn off screen, as keys and the mouse make them in a window. Positions
/// are pixels from the left and from the top.
struct Annotations {
  bool keys = false;                         ///< the list of keys (H)
  std::optional<Eigen::Vector2d> pointer{};  ///< short reading beside the pointer (T)
  std::optional<Eigen::Vector2d> click{};    ///< full reading at this point
  /// Two clicks that measure the distance between two points (L), instead of a reading.
  std::optional<std::array<Eigen::Vector2d, 2>> measured{};
};

struct ViewOptions {
  /// First view; empty: the first of `cameras`, or without cameras a view that is chosen for the
  /// scene.
  std::optional<Camera> camera{};
  std::vector<Camera> cameras{};   ///< bookmarks on the keys 1..9
  int width = 1024, height = 768;  ///< pixels
  double exposure_ev = 0.0;        ///< stops on top of the automatic exposure
  WhitePoint white{};              ///< light that shows as grey
  /// Size of text, as a multiple of 13 pixels; 0: by the resolution of the screen, and in pictures
  /// off screen by their height.
  double text_scale = 0.0;
  /// The scene's materials, which distinguish mirrors and glass from black surfaces; a solution
  /// alone has only diffuse light. May be empty.
  std::vector<Material> materials{};
  /// Gives the names of surfaces and materials, the sky and textures; the ray-traced picture needs
  /// the scene. May be null; must outlive the window.
  const Scene* scene = nullptr;
  const JoinedSurfaces* names = nullptr;  ///< surfaces of polygons that several surfaces share
  bool mesh = false;                      ///< begin with outlines of elements
  bool illuminance = false;               ///< begin in false colours of `measure`
  Measure measure = Measure::illuminance;
  bool lux_classes =
      false;  ///< false colours of illuminance show the classes of lighting standards
  std::optional<LuxRange> lux_range{};  ///< range of `measure`; empty: of what the first view shows
  /// Begin with the interpolation error estimated by refinement, in false colours from 0.1 % of the
  /// mean irradiance to 10 %. The solution must have the error.
  bool interpolation_error = false;
  bool relative_units = false;  ///< the numbers of the scale have no known unit
  /// File to which a key saves the solution; empty: a free name in screenshot_folder.
  std::filesystem::path solution_file{};
  std::filesystem::path screenshot_folder{"."};  ///< for pictures and solutions that keys save
  /// File in which keys save bookmarks and paths (JSON); empty: both last as long as the window.
  std::filesystem::path bookmark_file{};
  /// Levels of isolux lines, lx, which are then shown from the beginning. Empty: hidden at first,
  /// at 1, 2 and 5 times the powers of ten of the scale (on a linear scale, at the scale's steps).
  std::vector<double> isolux{};
  double eye_height = 0.0;    ///< of a walking person, m; 0: 1.6, less in a model
  bool walk = false;          ///< begin on foot, with gravity and collisions
  bool look_through = false;  ///< begin without surfaces that receive no light
  bool from_outside = false;  ///< begin outside, looking through, with all of the scene in view
  std::vector<Cue> cues{};    ///< of the solution, which keys step through and films show
  Annotations annotations{};  ///< for pictures off screen
};

/// ViewOptions::text_scale where it is known, else 1.
inline double text_scale_of(const ViewOptions& options) {
  return options.text_scale > 0.0 ? options.text_scale : 1.0;
}

/// Opens a window with the smooth-shaded solution and walk controls (the key H lists the controls);
/// returns when the user closes the window. The automatic exposure is that of the second pass's
/// picture from the same camera. Mirrors are drawn as if matte, glass as a thin veil: reflections
/// and refractions depend on the eye, and belong to the second pass. Throws std::runtime_error,
/// with advice, if no display can be opened.
void show_window(const SolvedScene& solved, const ViewOptions& options);

/// Pictures of a film: along a recorded path, around the scene (a turntable), or of a camera that
/// stands still; with ViewOptions::cues the light goes through all cues meanwhile.
struct FilmOptions {
  std::filesystem::path path{};  ///< file with a path that a window saved; empty: none
  int frames = 0;                ///< number of pictures, > 0, at even steps
  bool turntable = false;
};

/// Draws the pictures of a film as write_snapshot() does, all with the first one's exposure, and
/// with cues with that of the first one's view in the brightest cue. Files are numbered from 0 by a
/// pattern such as "out-%04d.png". Returns the names of the files. Throws as write_snapshot() does,
/// and InputError for a file of paths or a pattern that cannot be used, for an empty path, and for
/// cues without duration.
std::vector<std::filesystem::path> write_film(const SolvedScene& solved, const ViewOptions& options,
                                              const FilmOptions& film, const std::string& pattern,
                                              const Progress& progress = {});

struct LiveViewOptions {
  SolveOptions solve{};     ///< mesh, progressive refinement, refining and gathering
  Provenance provenance{};  ///< of the resulting solution
  bool ambient = true;      ///< off screen: show the ambient term of unshot light
  /// Returns the scales that channels begin with. The argument is a solution that has channels but
  /// no light yet. Empty: the channels begin as in the scene. Exceptions of the function are passed
  /// on.
  std::function<std::vector<Spectrum>(const RadiositySolution&)> scales{};
};

/// Opens the window at once and shows a sketch of the light within seconds, then the light shot by
/// shot, while a thread solves (progressive refinement), and then the solution. There is no sketch
/// where channels begin dimmed. Keys pause, shoot once, switch the ambient term, and stop and save.
/// Channels can be dimmed meanwhile. Throws as show_window() does, and InputError if nothing emits
/// light.
void show_live_window(const Scene& scene, const LiveViewOptions& live, const ViewOptions& options);

/// Writes a strip of pictures of the light after each of `shots` (rising numbers of shots), from
/// left to right, drawn as write_snapshot() does, all with the last one's exposure. If the
/// tolerance is reached at fewer shots, the light at that point is shown. Returns the number of
/// shots in the end. Number and pictures do not depend on the computer. Throws as
/// write_snapshot() does, for the size of the strip too, and InputError if nothing emits light.
int write_live_snapshot(const Scene& scene, const LiveViewOptions& live, std::span<const int> shots,
                        const ViewOptions& options, const std::filesystem::path& png);

/// Draws the first picture of show_window() off screen, antialiased, with the options' annotations,
/// and writes a PNG (temporary name, then renamed). Needs an X display all the same. Throws
/// - std::runtime_error if no display can be opened or the file cannot be written;
/// - std::invalid_argument for a size outside [1, 8192];
/// - InputError for an annotation outside of the picture.
void write_snapshot(const SolvedScene& solved, const ViewOptions& options,
                    const std::filesystem::path& png);

}  // namespace lightwell
