#pragma once

#include "scene/progress.h"

namespace lightwell {

class Journal;

/// Progress, interruption and journal of a run. The result does not depend on any of them.
struct RunControl {
  Progress progress{};
  /// Journal of the same scene, which keeps finished work and recalls it in a resumed run. Null:
  /// nothing is kept.
  Journal* journal = nullptr;
};

}  // namespace lightwell
