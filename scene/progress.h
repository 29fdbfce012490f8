#pragma once

#include <functional>
#include <string_view>

#include "scene/errors.h"

namespace lightwell {

/// Called with the phase ("form factors") and the share done, [0,1]. Return false to stop: the work
/// then ends with Interrupted within a second. Called from one thread at a time. Empty = silent.
using Progress = std::function<bool(std::string_view phase, double share)>;

/// Reports, and throws Interrupted when asked to stop.
inline void report(const Progress& progress, std::string_view phase, double share) {
  if (progress && !progress(phase, share)) throw Interrupted();
}

}  // namespace lightwell
