#pragma once

#include <memory>
#include <string>

#include "python/binding/scene_data.h"
#include "radiosity/solution/solution.h"

namespace lightwell::python {

/// A solution as Python holds it: never changed once made, so that arrays may be views of it.
struct SolutionData {
  SharedScene scene{};  ///< null: read from a file without its scene
  SolvedScene solved{};
  std::string refinement{};  ///< how refinement ended, a sentence; empty: not solved here
  std::string unkept{};      ///< why a checkpoint is not complete; empty: it is, or there is none

  /// The scene, for what needs one; `what` ("a picture") begins the message. Throws InputError for
  /// a solution without its scene.
  const SceneData& its_scene(const char* what) const;
};
using SharedSolution = std::shared_ptr<const SolutionData>;

}  // namespace lightwell::python
