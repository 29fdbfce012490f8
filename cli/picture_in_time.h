#pragma once

#include "cli/arguments.h"
#include "raytrace/pictures/image.h"
#include "raytrace/scene_renderer.h"

namespace lightwell {

/// A picture that had to be ready in time.
struct PictureInTime {
  Image image{};
  RenderReport rendered{};
  RenderArguments arguments{};  ///< with the pass and the quality that there was time for
  /// Rows from the top that were rendered with `arguments`; those below are of the quickest pass.
  int rows = 0;
};

/// Renders a picture within the time of `options.run`. `options` has the run and the layers; all
/// else is that of `arguments`.
///
/// - If the time is limited, the whole picture is first rendered by four samples for each pixel,
///   with light from the solution. Better rows replace these from the top down until the time is
///   up.
/// - A picture whose rows so far tell that it will take much longer is given up for the draft:
///   with the records of indirect light that are found by then, pixels that are split once, and
///   fewer first samples of gloss. A draft that is too slow is given up for light from the solution
///   alone. Records that take more than half of the time are given up too.
/// - Without a limit of time, four samples for each pixel fill in the rows that an interrupt leaves
///   missing.
///
/// Throws as SceneRenderer::render does.
PictureInTime render_in_time(SceneRenderer& renderer, const Camera& camera,
                             const RenderArguments& arguments, const RenderOptions& options);

}  // namespace lightwell
