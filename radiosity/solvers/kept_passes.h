#pragma once

#include <chrono>

#include "radiosity/journal/journal_phase.h"

namespace lightwell {

/// The passes of a solver over the rows, in order. Most solvers take a moment and simply run again.
/// Once a solver has taken as long as the journal's interval, the results of its passes are kept,
/// and a resumed solver recalls them without reading the rows.
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
