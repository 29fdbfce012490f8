#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/checkpoint.h"
#include "cli/console.h"
#include "cli/report.h"
#include "radiosity/solve.h"
#include "raytrace/image.h"
#include "raytrace/scene_renderer.h"
#include "scene/scene.h"

namespace lightwell {

// The steps that several sub-commands share. Each notes its seconds in the report, says on the
// console what people should know, and throws Interrupted when asked to stop.

/// The scene as every command that needs light sees it: cleaned by merge_planar_regions(), so that
/// facet numbers and hash are those of any solution made from it.
Scene read_scene_step(const std::filesystem::path& file, Console& console, Report& report,
                      CleanUpReport* clean_up = nullptr);

/// Notes on the mesh go to the console, those on the scene and the mesh into the report.
void note_mesh(const Scene& scene, const PatchMesh& mesh, Console& console, Report& report);

/// What a solution of the scene with these options, by this program, says of itself.
Provenance provenance(const Scene& scene, const SolveArguments& arguments);

/// Form factors that do not fit into memory go beside `output`. What was finished of an earlier run
/// is taken from the checkpoint, if that holds any, and more is kept there.
SolvedScene solve_step(const Scene& scene, const SolveArguments& arguments,
                       const std::filesystem::path& output, Checkpoint& checkpoint,
                       Console& console, Report& report);

void write_solution_step(const std::filesystem::path& file, const SolvedScene& solved,
                         Console& console, Report& report);

/// Reads a solution and makes sure that it belongs to the scene.
SolvedScene read_solution_step(const std::filesystem::path& file, const Scene& scene,
                               Console& console, Report& report);

/// What pictures of the solution with these options, by this program, are made of.
Provenance picture_provenance(const Scene& scene, const RadiositySolution& solution,
                              const RenderArguments& arguments);

/// Renders one camera's picture into every file given (.exr or .png). Its finished tiles are taken
/// from the checkpoint, and more are kept there. `renderer` is of the solved scene.
void render_step(const Scene& scene, const SolvedScene& solved, SceneRenderer& renderer,
                 const Camera& camera, const RenderArguments& arguments,
                 const std::vector<std::filesystem::path>& files, Checkpoint& checkpoint,
                 Console& console, Report& report);

/// 0, or 4 where the solver stopped early.
int exit_code(const RadiositySolution& solution);

}  // namespace lightwell
