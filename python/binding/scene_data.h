#pragma once

#include <memory>
#include <optional>

#include "mesh/cleaning/planar_regions.h"
#include "scene/io/numbered_scene.h"
#include "scene/io/read_scene.h"
#include "scene/io/scene_text.h"
#include "scene/progress.h"
#include "scene/scene.h"

namespace lightwell::python {

/// A scene as Python holds it: never changed once made, so that all threads may share it.
struct SceneData {
  /// The scene as read or given, for people and other programs.
  Scene given{};
  /// The same surfaces after merge_planar_regions(): what is solved and pictured, as by the command
  /// line, with equal facet numbers and hash.
  Scene clean{};
  CleanUpReport clean_up{};
  References references = References::anywhere;
  /// The faces that the scene was made from; empty for a scene that was read from a file.
  std::optional<NumberedScene> faces{};
  /// The tables that the scene was made from; empty for a scene that was read from a file.
  std::optional<SceneText> text{};
};
using SharedScene = std::shared_ptr<const SceneData>;

/// Cleans a scene up. Throws InputError as merge_planar_regions() does.
SharedScene scene_data(Scene given, References references, std::optional<NumberedScene> faces = {},
                       std::optional<SceneText> text = {});

}  // namespace lightwell::python
