#pragma once

#include "scene/progress.h"

namespace lightwell {

class Journal;

/// How a run is watched, kept and stopped. Decides no bit of its result.
struct RunControl {
  Progress progress{};
  /// Collects finished work, and gives it back to a run that resumes an interrupted one. Of the
  /// same scene. Null: nothing is kept.
  Journal* journal = nullptr;
};

}  // namespace lightwell
