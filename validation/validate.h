#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/progress.h"
#include "validation/cases/case.h"

namespace lightwell {

/// All cases with known answers that the program has, by groups.
std::vector<ValidationCase> validation_cases();

/// The cases whose id or group contains `pattern`, without regard to case; `*` stands for any
/// characters. All cases if `pattern` is empty. Throws InputError that names the nearest id if
/// there are none.
std::vector<ValidationCase> select_cases(std::vector<ValidationCase> cases,
                                         std::string_view pattern);

enum class Verdict {
  passed,
  failed,
  not_run,  ///< the program has nothing that the case asks for
  stopped   ///< the run was stopped before
};

/// Result of a case.
struct CaseResult {
  ValidationCase about{};
  Verdict verdict = Verdict::stopped;
  ComparedValues values{};
  std::string failure{};  ///< message of an exception; the case then failed without values
  double seconds = 0.0;

  /// The value with the largest error over tolerance; null without values.
  const ComparedValue* worst() const;
};

/// Results of a run. Cases that were stopped have the verdict `stopped`.
struct ValidationRun {
  std::vector<CaseResult> results{};
  double seconds = 0.0;

  int count(Verdict verdict) const;
  bool has_failed() const { return count(Verdict::failed) > 0; }
  /// The case with the largest error over tolerance; null if none was computed.
  const CaseResult* closest() const;
};

/// Runs the cases one after the other. A case that throws has failed. If `progress` says stop, the
/// case at work and all after it are stopped. `done` is called with each result as it comes.
ValidationRun run_validation(std::vector<ValidationCase> cases, const Progress& progress = {},
                             const std::function<void(const CaseResult&)>& done = {});

/// "120 of 121 cases pass in 60 s; the largest error is 0.8 of its tolerance (case, place)."
std::string verdict_line(const ValidationRun& run);

}  // namespace lightwell
