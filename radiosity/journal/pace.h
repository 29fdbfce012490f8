#pragma once

#include "scene/stopwatch.h"

namespace lightwell {

/// Says when work is to be given up for quicker work: when its share so far tells that it will take
/// much more than the time allowed.
class Pace {
 public:
  /// `allowed` seconds from the first call of is_too_slow() on; infinity: any.
  explicit Pace(double allowed) : allowed_(allowed) {}

  /// `share` of the work is done, [0,1].
  bool is_too_slow(double share) {
    if (!has_begun_) watch_.lap();
    has_begun_ = true;
    // A tenth of the time shows some of any work. What comes first may be cheaper or dearer than
    // the rest, so a fifth too much is no reason yet.
    constexpr double enough_to_judge = 0.1, too_much = 1.2;
    const double spent = watch_.seconds();
    return spent > enough_to_judge * allowed_ && spent > too_much * share * allowed_;
  }

 private:
  double allowed_;
  bool has_begun_ = false;
  Stopwatch watch_{};
};

}  // namespace lightwell
