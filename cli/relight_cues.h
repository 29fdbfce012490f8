#pragma once

#include <string>
#include <vector>

#include "cli/channels.h"
#include "cli/report.h"
#include "cli/steps.h"

namespace lightwell {

/// Relighting by the cues of a file.
struct RelightByCues {
  const std::string& solution;
  const std::string& cues;
  const std::string& folder;                  ///< for the results
  const std::vector<NamedSetting>& settings;  ///< before the first cue
  const std::string& scene;                   ///< empty: no pictures
  const std::string& camera;                  ///< empty: the first of the scene
  const RenderArguments& render;
  int frames = 0;  ///< of the film of all fades; 0: no film
};

/// Writes the solution of each cue, CUE.vtp, into the folder, and with a scene its pictures from
/// the camera, CUE.exr and CUE.png. All .png files have the exposure of the cue with the most light
/// on what the camera sees, as have the frames of the film, frame-0000.png and so on, evenly from
/// the light before the first cue to the end of the last.
void relight_by_cues(const RelightByCues& task, const Feedback& feedback);

}  // namespace lightwell
