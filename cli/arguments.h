#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "cli/channels.h"
#include "cli/film.h"
#include "mesh/build_patches.h"
#include "radiosity/solve.h"
#include "raytrace/render.h"

namespace lightwell {

/// How surfaces are cut into patches and elements, as asked for on the command line.
struct MeshArguments {
  double max_patch_size = 0.0;    ///< in the scene file's unit; 0: automatic
  double max_element_size = 0.0;  ///< the same
  MeshOptions mesh{};

  void add_to(CLI::App& command, const std::string& group);
  /// With lengths in metres; `progress` is left empty.
  MeshOptions options(const Scene& scene) const;
  /// The command line that repeats it, with every default spelled out.
  std::string text(const Scene& scene) const;
};

/// How the light is solved, as asked for on the command line.
struct SolveArguments {
  MeshArguments mesh{};
  std::string form_factors = "auto";
  std::string solver = "auto";
  ChannelArguments channels{};
  std::string start_from{};  ///< a solution to start from; empty: none
  std::int64_t memory = 0;   ///< bytes; 0: no limit given
  SolveOptions solve{};

  void add_to(CLI::App& command);
  /// With lengths in metres; `progress` and `start` are left empty.
  SolveOptions options(const Scene& scene) const;
  /// The command line that repeats it, with every default spelled out.
  std::string text(const Scene& scene) const;
};

/// How a picture is made.
struct RenderArguments {
  std::optional<std::pair<int, int>> size{};  ///< pixels; else the camera's own
  std::string pass = "direct";
  int shadow_rays = 64;
  int gather_samples = 256;
  int photons = RenderOptions{}.photons;
  int depth = RenderOptions{}.max_depth;
  int samples = 0;      ///< most per pixel; 0: see SampleOptions
  double noise = 0.02;  ///< share of a pixel that ends its sampling
  double exposure_ev = 0.0;
  FilmArguments film{};

  void add_to(CLI::App& command);
  RenderOptions options() const;
  std::string text() const;
  /// The camera with the size asked for.
  Camera sized(Camera camera) const;
};

/// SCENE and SOLUTION, both required.
void add_solved_scene(CLI::App& command, std::string& scene, std::string& solution);

std::vector<std::string> form_factor_method_names();
std::vector<std::string> solver_names();

/// The option --hemicube-resolution spelled out where it matters, with a space before it.
std::string hemicube_text(const std::string& method, int resolution);

/// Adds --hemicube-resolution N.
CLI::Option* add_hemicube_resolution(CLI::App& command, int& resolution);

/// Adds --size WxH.
void add_size(CLI::App& command, std::optional<std::pair<int, int>>& size);

/// Adds --exposure EV.
void add_exposure(CLI::App& command, double& exposure_ev);

/// For the callback of `option`, which decides what the `others`, defined before it, would decide.
/// CLI11's excludes() takes a line of help on each side.
void refuse_beside(const CLI::App& command, const char* option,
                   const std::vector<const char*>& others);

CLI::Validator whole_number(int least, int most);

/// For numbers that must be above zero (a NaN is not).
CLI::Validator positive();

/// For ray counts: the sample points are stratified in powers of two.
CLI::Validator power_of_two();

/// Only what exists may be asked for; `what` ("solver") names its kind to who asks for another.
CLI::Validator one_of(std::string what, std::vector<std::string> known);

/// A file name that ends in one of `extensions` (".png"), whatever its case.
CLI::Validator with_extension(std::vector<std::string> extensions);

/// The scene's camera of that name, or its first if `name` is empty. Throws InputError that lists
/// the names there are.
const Camera& choose_camera(const Scene& scene, const std::string& name);

}  // namespace lightwell
