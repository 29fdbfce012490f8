#include "radiosity/refine/refine_options.h"

#include <fmt/format.h>

namespace lightwell {

std::string sentence(const RefineReport& report) {
  const auto percent = [](double share) { return fmt::format("{:.3g} %", 100.0 * share); };
  std::string end;
  switch (report.outcome) {
    case RefineOutcome::off:
      return "nothing was refined";
    case RefineOutcome::tolerance_reached:
      end = fmt::format("the tolerance of {} is reached", percent(report.tolerance));
      break;
    case RefineOutcome::max_elements_reached:
      end = fmt::format("stopped at the most elements allowed, before the tolerance of {}",
                        percent(report.tolerance));
      break;
    case RefineOutcome::memory_limit_reached:
      end = fmt::format(
          "stopped at the most elements that '--memory' has room for, before the tolerance of {}",
          percent(report.tolerance));
      break;
    case RefineOutcome::time_limit_reached:
      end = fmt::format("stopped for want of time, before the tolerance of {}",
                        percent(report.tolerance));
      break;
    case RefineOutcome::smallest_size_reached:
      end = fmt::format("stopped at the smallest elements allowed, before the tolerance of {}",
                        percent(report.tolerance));
      break;
  }
  return fmt::format("{} ({} estimated; {} elements became {} in {} rounds)", end,
                     percent(report.estimate), report.elements_at_first, report.elements,
                     report.rounds);
}

}  // namespace lightwell
