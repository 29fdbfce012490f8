#pragma once

#include <string>

#include "scene/scene.h"

namespace lightwell {

/// The name of a scene at the beginning of messages: its file, or "the scene" for a scene without
/// one.
inline std::string name_in_messages(const Scene& scene) {
  return scene.file.empty() ? "the scene" : scene.file.string();
}

}  // namespace lightwell
