#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/checkpoint.h"
#include "cli/console.h"
#include "cli/report.h"
#include "cli/time_limit.h"
#include "radiosity/solve.h"
#include "raytrace/pictures/image.h"
#include "raytrace/scene_renderer.h"
#include "scene/io/read_scene.h"
#include "scene/scene.h"

namespace lightwell {

// The steps that several sub-commands share. Each step adds its seconds to the report, prints notes
// on the console, and throws Interrupted after an interrupt.

/// The files that a scene may name, by --inside-folder.
References allowed_references(const CommonOptions& options);

/// Under --strict, throws an InputError that lists all losses of the scene (Scene::losses); without
/// losses or --strict, does nothing.
void refuse_losses(const Scene& scene, const CommonOptions& options);

/// Reads a scene and cleans its polygons by merge_planar_regions(): facet numbers and hash are
/// those of every solution of the scene. `clean_up`, if not null, receives the report of the
/// cleaning.
Scene read_scene_step(const std::filesystem::path& file, Console& console, Report& report,
                      CleanUpReport* clean_up = nullptr);

/// Prints the notes on the mesh, and adds the notes on scene and mesh to the report.
void note_mesh(const Scene& scene, const PatchMesh& mesh, Console& console, Report& report);

/// Provenance of a solution of the scene with these options by this version of the program.
Provenance provenance(const Scene& scene, const SolveArguments& arguments);

/// A solve and the file that its solution will be written to.
struct SolveTask {
  const SolveArguments& arguments;
  const std::filesystem::path& output;
  const TimeLimit& time;
  double share_of_time = 1.0;  ///< that the solve may take
};

/// Solves the scene. Form factors that do not fit into memory go to disk beside the task's
/// `output`. Work that the checkpoint holds is reused; more finished work is added to the
/// checkpoint. An early end before there is a mesh throws Interrupted.
SolvedScene solve_step(const Scene& scene, const SolveTask& task, Checkpoint& checkpoint,
                       const Feedback& feedback);

void write_solution_step(const std::filesystem::path& file, const SolvedScene& solved,
                         Console& console, Report& report);

/// Reads a solution; throws InputError if the solution is of another scene.
SolvedScene read_solution_step(const std::filesystem::path& file, const Scene& scene,
                               Console& console, Report& report);

/// Provenance of pictures of the solution with these options by this version of the program.
Provenance picture_provenance(const Scene& scene, const RadiositySolution& solution,
                              const RenderArguments& arguments);

/// A solved scene with the renderer of its pictures.
struct RenderableScene {
  RenderableScene(const Scene& of, const SolvedScene& by)
      : scene(of), solved(by), renderer(of, by.mesh, by.solution) {}

  const Scene& scene;
  const SolvedScene& solved;
  SceneRenderer renderer;
};

/// A camera's picture and the files (.exr, .hdr or .png) that it will be written to.
struct PictureTask {
  const Camera& camera;
  const RenderArguments& arguments;
  const std::vector<std::filesystem::path>& files;
  std::function<double()> seconds_left{};  ///< RunControl::seconds_left
  std::string label{};  ///< of the picture in report and messages; empty: the camera's name
  /// Light that exposure and white balance of the .png go by, for pictures to be compared; empty:
  /// what falls on what the camera sees.
  std::optional<IncidentLight> incident{};
};

/// Renders a picture and writes its files. Finished tiles that the checkpoint holds are reused;
/// more are added to the checkpoint. Returns whether the whole picture is as asked for; if not, a
/// warning says what is missing.
bool render_step(RenderableScene& renderable, const PictureTask& task, Checkpoint& checkpoint,
                 const Feedback& feedback);

/// exit_done if the solver converged, otherwise exit_not_accurate.
int exit_code(const RadiositySolution& solution);

}  // namespace lightwell
