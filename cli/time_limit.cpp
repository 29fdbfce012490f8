#include "cli/time_limit.h"

#include <fmt/format.h>

#include <limits>

#include "cli/arguments.h"
#include "cli/checkpoint.h"
#include "cli/interrupt.h"

namespace lightwell {
namespace {

// The time decides over rays and refinement, unless refinement is off.
void refuse_efforts(const CLI::App& command) {
  if (!command.get_option_no_throw("--gather-rays")) return;  // a command that does not solve
  refuse_beside(command, "--time", {"--gather-rays"});
  const CLI::Option& refine = *command.get_option("--refine");
  if (refine.count() > 0 && refine.as<std::string>() != "off") {
    refuse_beside(command, "--time", {"--refine"});
  }
}

}  // namespace

void add_time_limit(CLI::App& command, double& seconds, const std::string& group) {
  command
      .add_option_function<std::string>(
          "--time",
          [&seconds, &command](const std::string& text) {
            refuse_beside(command, "--time", {"--checkpoint"});
            refuse_efforts(command);
            const auto time = parse_seconds(text);
            if (!time) {
              throw CLI::ValidationError("--time",
                                         fmt::format("'{}' is no time from 0.1 s to 24 h; write a "
                                                     "number and s, min or h, such as 90s or 2min",
                                                     text));
            }
            seconds = *time;
          },
          "the best result within TIME, reading and writing included: 60s, 2min")
      ->type_name("TIME")
      ->group(group);
}

std::string TimeLimit::text() const {
  return seconds_ > 0.0 ? fmt::format(" --time {:g}s", seconds_) : "";
}

std::function<double()> TimeLimit::seconds_left(double share) const {
  return [this, share] {
    if (early_end_requested()) return 0.0;
    if (!(seconds_ > 0.0)) return std::numeric_limits<double>::infinity();
    return share * seconds_ - watch_.seconds();
  };
}

}  // namespace lightwell
