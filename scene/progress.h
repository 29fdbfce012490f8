#pragma once

#include <functional>
#include <string_view>

#include "scene/errors.h"

namespace lightwell {

/// Progress callback: receives the phase ("form factors") and the share done, [0,1]. Returning
/// false stops the work, which then throws Interrupted within a second. Called from one thread at a
/// time. An empty function is silent.
using Progress = std::function<bool(std::string_view phase, double share)>;

/// Calls `progress`, and throws Interrupted if `progress` returns false.
inline void report(const Progress& progress, std::string_view phase, double share) {
  if (progress && !progress(phase, share)) throw Interrupted();
}

}  // namespace lightwell
