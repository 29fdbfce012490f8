#pragma once

#include <chrono>

#include "radiosity/journal/journal_phase.h"

namespace lightwell {

/// The passes of one solver over the rows, in their order. Most solvers are done in a moment and
/// simply run again; once one has taken as long as the journal's interval, all that its passes find
/// is kept, so that whoever goes on does with them what the solver did, without the rows.
class KeptPasses {
 public:
  KeptPasses(JournalPhase phase, double every) : phase_(phase), every_(every) {}

  template <class Pass, class... Results>
  void next(Pass pass, Results&... results) {
    const int number = number_++;
    if (phase_.recall(number, results...)) return;
    pass();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begun_;
    if (taken.count() >= every_) phase_.keep(number, results...);
  }

 private:
  JournalPhase phase_;
  double every_ = 0.0;
  int number_ = 0;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

}  // namespace lightwell
