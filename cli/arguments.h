#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "cli/channels.h"
#include "cli/film.h"
#include "cli/look_from.h"
#include "cli/numbers.h"
#include "cli/projection.h"
#include "mesh/build_patches.h"
#include "radiosity/solve.h"
#include "raytrace/cameras/choose_camera.h"
#include "raytrace/render.h"
#include "raytrace/shading/picture_quality.h"

namespace lightwell {

/// Options that cut surfaces into patches and elements.
struct MeshArguments {
  double max_patch_size = 0.0;    ///< in the scene file's unit; 0: automatic
  double max_element_size = 0.0;  ///< in the scene file's unit; 0: by elements per patch edge
  MeshOptions mesh{};

  void add_to(CLI::App& command, const std::string& group);
  /// Mesh options with lengths in metres; `progress` is left empty.
  MeshOptions options(const Scene& scene) const;
  /// Command-line options that repeat the mesh, with every default spelled out.
  std::string text(const Scene& scene) const;
};

/// Options of the first pass.
struct SolveArguments {
  MeshArguments mesh{};
  std::string form_factors = "auto";
  std::string solver = "auto";
  ChannelArguments channels{};
  LookFromArguments look_from{};
  std::string start_from{};  ///< file of the solution the solver starts from; empty: none
  std::int64_t memory = 0;   ///< bytes; 0: no limit given
  SolveOptions solve{};

  void add_to(CLI::App& command);
  /// Solve options with lengths in metres; `progress` and `start` are left empty.
  SolveOptions options(const Scene& scene) const;
  /// Command-line options that repeat the solve, with every default spelled out.
  std::string text(const Scene& scene) const;
};

/// Options of the second pass.
struct RenderArguments {
  ProjectionArguments projection{};
  std::string pass = "auto";
  std::string quality = "good";
  std::optional<int> shadow_rays{};  ///< unset, like photons and noise: those of `quality`
  int gather_samples = 256;
  int virtual_lights = RenderOptions{}.virtual_lights;
  std::optional<int> photons{};
  int depth = RenderOptions{}.max_depth;
  int samples = 0;                ///< most per pixel; 0: see SampleOptions
  std::optional<double> noise{};  ///< relative standard error at which sampling of a pixel ends
  double exposure_ev = 0.0;
  FilmArguments film{};

  void add_to(CLI::App& command);
  RenderOptions options() const;
  std::string text() const;
  /// True if pictures need a solution.
  bool needs_solution() const { return pass != "virtual-lights"; }
  /// The quality, with the options in place that are set themselves.
  PictureQuality effective_quality() const;
};

/// Adds the arguments SCENE and SOLUTION, both required.
void add_solved_scene(CLI::App& command, std::string& scene, std::string& solution);

std::vector<std::string> form_factor_method_names();

/// " --hemicube-resolution N" for the hemicube method, "" for every other method.
std::string hemicube_text(const std::string& method, int resolution);

/// Adds --hemicube-resolution N.
CLI::Option* add_hemicube_resolution(CLI::App& command, int& resolution);

/// Adds --size WxH.
void add_size(CLI::App& command, std::optional<std::pair<int, int>>& size);

/// Adds --exposure EV.
void add_exposure(CLI::App& command, double& exposure_ev);

/// Throws CLI::ValidationError if one of the `others` was given beside `option`; called from the
/// callback of `option`, which is defined after the `others`. CLI11's excludes() would add a line
/// of help to every option involved.
void refuse_beside(const CLI::App& command, const char* option,
                   const std::vector<const char*>& others);

/// Accepts the `known` names; `what` ("solver") is their kind in the error message.
CLI::Validator one_of(std::string what, std::vector<std::string> known);

/// The names that a validator of one_of() accepts; empty for any other validator of the option, and
/// for none.
std::vector<std::string> accepted_names(CLI::Option& option);

/// Names of scene files end in one of these.
inline constexpr const char* scene_extensions =
    ".toml, .obj, .ply, .stl, .gltf, .glb, .dae, .fbx, .xml, .rad, .rif, .mgf, .pov, .hbjson, "
    ".stf, .vs3";

/// Adds the positional argument `scene`, which must be given, to a command.
void add_scene(CLI::App& command, std::string& scene);

/// Accepts file names that end in one of `extensions` (".png"), in upper or lower case.
CLI::Validator with_extension(std::vector<std::string> extensions);

}  // namespace lightwell
